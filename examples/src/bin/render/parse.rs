//! Parsing of option values.

use framegraph_passes::{OptionError, Precision, SettingsTable};
use program::cli::Item;
use std::ops::RangeInclusive;

/// Parses a number within a range.
///
/// # Errors
/// One line that names the option and the range.
pub fn number(item: &Item, range: RangeInclusive<f32>) -> Result<f32, String> {
    let expected = format!("a number from {} to {}", range.start(), range.end());
    item.parse(&expected, |text| text.parse().ok().filter(|value| range.contains(value)))
}

/// Sets the field of settings that is named like the option.
///
/// # Errors
/// One line that names the option and the accepted values.
pub fn field(item: &Item, settings: &mut impl SettingsTable) -> Result<(), String> {
    settings.set(item.name(), &item.text()?).map_err(|error| match error {
        OptionError::Value { key, value, takes } => format!("--{key} {value}: expected {takes}"),
        error => format!("--{error}"),
    })
}

/// Changes settings by pairs of `KEY=X`.
///
/// # Errors
/// One line that names the option, the key and the accepted values.
pub fn fields(option: &str, text: &str, settings: &mut impl SettingsTable) -> Result<(), String> {
    settings.set_all(text).map_err(|error| format!("--{option} {error}"))
}

/// Parses a shading precision.
///
/// # Errors
/// One line that lists the precisions.
pub fn precision(item: &Item) -> Result<Precision, String> {
    item.parse(&format!("one of {}", Precision::ALL.map(Precision::name).join(", ")), Precision::from_name)
}

/// Parses `words` with these options only, and passes each on.
#[cfg(test)]
pub fn taken(
    options: Vec<program::clap::Arg>,
    words: &[&str],
    mut take: impl FnMut(&Item) -> Result<bool, String>,
) -> Result<(), String> {
    let command = program::cli::command("render", "", "").args(options);
    let parsed = program::cli::parse(command, words.iter().map(std::ffi::OsString::from))?;
    let program::cli::Parsed::Given(given) = parsed else { return Err("help".into()) };
    for item in given {
        assert!(take(&item)?, "{}", item.name());
    }
    Ok(())
}
