//! Parsing of single option values.

use framegraph::Alias;
use framegraph_scene::CameraChoice;
use program::bytes;
use std::str::FromStr;

/// Parses width and height of a picture, both at least 1.
///
/// # Errors
/// One line that names the option.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("--size {text}: expected two whole numbers, such as 1280x720");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    let size = [width, height].map(|side| side.parse::<u32>());
    let [Ok(width), Ok(height)] = size else { return Err(wrong()) };
    if width == 0 || height == 0 {
        return Err(format!("--size {text}: both sides must be at least 1"));
    }
    Ok([width, height])
}

/// Parses the number of samples per pixel.
///
/// # Errors
/// One line that names the option.
pub fn samples(text: &str) -> Result<u8, String> {
    match text {
        "1" => Ok(1),
        "4" => Ok(4),
        _ => Err(format!("--msaa {text}: expected 1 or 4")),
    }
}

/// Parses the mode of memory aliasing.
///
/// # Errors
/// One line that names the option.
pub fn alias(text: &str) -> Result<Alias, String> {
    match text {
        "heap" => Ok(Alias::Heap),
        "pool" => Ok(Alias::Pool),
        // `none` was the name of `off`.
        "off" | "none" => Ok(Alias::Off),
        _ => Err(format!("--alias {text}: expected `heap`, `pool` or `off`")),
    }
}

/// Parses a positive number of bytes.
///
/// # Errors
/// One line that names the option.
pub fn memory(text: &str) -> Result<u64, String> {
    bytes(text).filter(|bytes| *bytes > 0).ok_or_else(|| format!("--memory {text}: expected bytes, such as 512MiB"))
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
pub fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        _ if text == "auto" => Ok(0),
        Ok(threads @ 1..=256) => Ok(threads),
        _ => Err(format!("--threads {text}: expected `auto` or a number from 1 to 256")),
    }
}

/// Parses the number of measured frames.
///
/// # Errors
/// One line that names the option.
pub fn frames(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(frames @ 1..=10_000) => Ok(frames),
        _ => Err(format!("--frames {text}: expected a number from 1 to 10000")),
    }
}
