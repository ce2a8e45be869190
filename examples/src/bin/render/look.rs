//! Options that say how surfaces are shaded and how the picture is to look.

use framegraph_passes::{Precision, Quality, Shading};
use std::ops::RangeInclusive;

/// A number within a range.
///
/// # Errors
/// One line that names the option and the range.
pub fn number(option: &str, text: &str, range: RangeInclusive<f32>) -> Result<f32, String> {
    let value: f32 = text.parse().map_err(|_| format!("{option} {text}: a number is needed"))?;
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(format!("{option} {text}: numbers go from {} to {}", range.start(), range.end()))
    }
}

/// The keys and values of `KEY=X,KEY=X`, in order.
///
/// # Errors
/// One line that names the option, when there is a key alone.
pub fn pairs<'a>(option: &str, text: &'a str) -> Result<Vec<(&'a str, &'a str)>, String> {
    let pair = |pair: &'a str| pair.split_once('=').ok_or_else(|| format!("{option} {pair}: KEY=X is needed"));
    text.split(',').filter(|text| !text.is_empty()).map(pair).collect()
}

/// `on` or `off`.
///
/// # Errors
/// One line that names the option.
pub fn switch(option: &str, text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err(format!("{option} {text}: `on` or `off` is needed")),
    }
}

/// A quality of shading by name.
///
/// # Errors
/// One line that lists them.
pub fn quality(text: &str) -> Result<Quality, String> {
    let names = || Quality::ALL.map(Quality::name).join(", ");
    Quality::from_name(text).ok_or_else(|| format!("--quality {text}: unknown quality; there are {}", names()))
}

/// The numbers of shading by name.
///
/// # Errors
/// One line with the names that there are.
pub fn precision(text: &str) -> Result<Precision, String> {
    let names = || Precision::ALL.map(Precision::name).join(", ");
    Precision::from_name(text).ok_or_else(|| format!("--precision {text}: unknown numbers; there are {}", names()))
}

/// How surfaces are shaded, changed by `aa=on,bands=5`.
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
        assert!(quality("best").is_err_and(|told| told.contains("low, high, ultra")));
        assert!(shading(Quality::High.shading(), "aa").is_err_and(|told| told.contains("--shade aa")));
    }

    #[test]
    fn switches_and_numbers_are_checked() {
        assert_eq!((switch("--inline", "on"), switch("--inline", "off")), (Ok(true), Ok(false)));
        assert!(switch("--inline", "yes").is_err_and(|told| told.contains("--inline yes")));
        assert_eq!(number("--dither", "0.5", 0.0..=1.0), Ok(0.5));
        assert!(number("--dither", "1.5", 0.0..=1.0).is_err_and(|told| told.contains("0 to 1")));
    }
}
