//! Parsing of option values.

use framegraph_passes::{Precision, Quality, Shading};
use std::ops::RangeInclusive;

/// Parses a number within a range.
///
/// # Errors
/// One line that names the option and the range.
pub fn number(option: &str, text: &str, range: RangeInclusive<f32>) -> Result<f32, String> {
    let value: f32 = text.parse().map_err(|_| format!("{option} {text}: expected a number"))?;
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(format!("{option} {text}: out of range; expected {} to {}", range.start(), range.end()))
    }
}

/// Splits `KEY=X,KEY=X` into keys and values, in order.
///
/// # Errors
/// One line that names the option if a key has no value.
pub fn pairs<'a>(option: &str, text: &'a str) -> Result<Vec<(&'a str, &'a str)>, String> {
    let pair = |pair: &'a str| pair.split_once('=').ok_or_else(|| format!("{option} {pair}: expected KEY=X"));
    text.split(',').filter(|text| !text.is_empty()).map(pair).collect()
}

/// Parses `on` or `off`.
///
/// # Errors
/// One line that names the option.
pub fn switch(option: &str, text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err(format!("{option} {text}: expected `on` or `off`")),
    }
}

/// Parses a shading quality.
///
/// # Errors
/// One line that lists the qualities.
pub fn quality(text: &str) -> Result<Quality, String> {
    let names = || Quality::ALL.map(Quality::name).join(", ");
    Quality::from_name(text).ok_or_else(|| format!("--quality {text}: unknown quality; expected one of {}", names()))
}

/// Parses a shading precision.
///
/// # Errors
/// One line that lists the precisions.
pub fn precision(text: &str) -> Result<Precision, String> {
    let names = || Precision::ALL.map(Precision::name).join(", ");
    Precision::from_name(text)
        .ok_or_else(|| format!("--precision {text}: unknown precision; expected one of {}", names()))
}

/// Applies options such as `aa=on,bands=5` to `shading`.
///
/// # Errors
/// One line that names the key.
pub fn shading(mut shading: Shading, text: &str) -> Result<Shading, String> {
    for (key, value) in pairs("--shade", text)? {
        shading.set(key, value).map_err(|error| format!("--shade {error}"))?;
    }
    Ok(shading)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shading_is_the_quality_with_changes() {
        let changed = Shading { roughness_floor: 0.1, specular_aa: None, ..Quality::Low.shading() };
        assert_eq!(shading(Quality::Low.shading(), "aa=on,aa=off,floor=0.1"), Ok(changed));
        assert_eq!(quality("low"), Ok(Quality::Low));
        assert!(quality("best").is_err_and(|error| error.contains("low, high, ultra")));
        assert!(shading(Quality::High.shading(), "aa").is_err_and(|error| error.contains("--shade aa")));
    }

    #[test]
    fn switches_and_numbers_are_checked() {
        assert_eq!((switch("--inline", "on"), switch("--inline", "off")), (Ok(true), Ok(false)));
        assert!(switch("--inline", "yes").is_err_and(|error| error.contains("--inline yes")));
        assert_eq!(number("--dither", "0.5", 0.0..=1.0), Ok(0.5));
        assert!(number("--dither", "1.5", 0.0..=1.0).is_err_and(|error| error.contains("0 to 1")));
    }
}
