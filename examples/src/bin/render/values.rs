//! Parsing of single option values.

use framegraph::Alias;
use framegraph_check::budget::bytes;
use framegraph_scene::CameraChoice;
use program::cli::Item;
use std::str::FromStr;

/// Parses width and height of a picture, both at least 1.
///
/// # Errors
/// One line that names the option.
pub fn size(item: &Item) -> Result<[u32; 2], String> {
    let size = item.parse("two whole numbers, such as 1280x720", |text| {
        let (width, height) = text.split_once(['x', 'X'])?;
        Some([width.parse().ok()?, height.parse().ok()?])
    })?;
    match size.contains(&0) {
        true => Err(format!("--size {}x{}: both sides must be at least 1", size[0], size[1])),
        false => Ok(size),
    }
}

/// Parses the mode of memory aliasing.
///
/// # Errors
/// One line that names the option.
pub fn alias(item: &Item) -> Result<Alias, String> {
    item.parse("`heap`, `pool` or `off`", |text| match text {
        "heap" => Some(Alias::Heap),
        "pool" => Some(Alias::Pool),
        // `none` was the name of `off`.
        "off" | "none" => Some(Alias::Off),
        _ => None,
    })
}

/// Parses a positive number of bytes.
///
/// # Errors
/// One line that names the option.
pub fn memory(item: &Item) -> Result<u64, String> {
    item.parse("bytes, such as 512MiB", |text| bytes(text).filter(|bytes| *bytes > 0))
}

/// Parses a camera name or position.
///
/// # Errors
/// One line that names the option.
pub fn camera(text: &str) -> Result<CameraChoice, String> {
    CameraChoice::from_str(text).map_err(|error| format!("--camera: {error}"))
}

/// Parses the number of recording threads; 0 for the number of cores.
///
/// # Errors
/// One line that names the option.
pub fn threads(item: &Item) -> Result<usize, String> {
    item.parse("`auto` or a number from 1 to 256", |text| match text.parse() {
        _ if text == "auto" => Some(0),
        Ok(threads @ 1..=256) => Some(threads),
        _ => None,
    })
}

/// Parses the number of measured frames.
///
/// # Errors
/// One line that names the option.
pub fn frames(item: &Item) -> Result<u32, String> {
    item.parse("a number from 1 to 10000", |text| text.parse().ok().filter(|frames| (1..=10_000).contains(frames)))
}
