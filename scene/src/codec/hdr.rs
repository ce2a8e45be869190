//! Radiance `.hdr` files: three mantissas with a shared exponent, run-length encoded (Ward, "Real Pixels", Graphics
//! Gems II, 1991).

use super::error::{CodecError, HdrError};
use super::picture::{PictureF32, check_size};

/// Returns the size in the header.
pub(crate) fn header(bytes: &[u8], max_texels: [u32; 2]) -> Result<[u32; 2], CodecError> {
    read_header(&mut { bytes }, max_texels)
}

/// Returns the size in the header and advances `rest` to the texels.
fn read_header(rest: &mut &[u8], max_texels: [u32; 2]) -> Result<[u32; 2], CodecError> {
    if !line(rest).is_some_and(|first| first.starts_with(b"#?RADIANCE")) {
        return Err(HdrError::Signature.into());
    }
    loop {
        let line = line(rest).ok_or(HdrError::CutShort)?;
        if line.is_empty() {
            break;
        }
        let text = String::from_utf8_lossy(line);
        let format = text.split_once('=').filter(|(key, _)| key.trim() == "FORMAT").map(|(_, format)| format);
        if format.is_some_and(|format| format.trim() != "32-bit_rle_rgbe") {
            return Err(HdrError::Format.into());
        }
    }
    let size_texels = size(line(rest).ok_or(HdrError::CutShort)?)?;
    check_size(size_texels, max_texels)?;
    Ok(size_texels)
}

/// Decodes to four numbers a texel, alpha 1. `EXPOSURE` and `COLORCORR` are ignored.
pub(crate) fn decode(bytes: &[u8], max_texels: [u32; 2]) -> Result<PictureF32, CodecError> {
    let mut rest = bytes;
    let size_texels = read_header(&mut rest, max_texels)?;
    let [width, height] = size_texels;
    let mut row = vec![[0; 4]; width as usize];
    // Rows are appended as they are read, so that memory use is bounded by the bytes of the file.
    let mut rgba = Vec::new();
    for y in 0..height {
        decode_row(&mut rest, &mut row, y)?;
        rgba.extend(row.iter().map(|texel| radiance(*texel)));
    }
    Ok(PictureF32 { size_texels, rgba })
}

/// Returns the bytes up to the next line break, which is consumed; `None` at the end.
fn line<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    if rest.is_empty() {
        return None;
    }
    let end = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
    let line = &rest[..end];
    *rest = rest.get(end + 1..).unwrap_or_default();
    Some(line)
}

/// Parses width and height. Only rows from top to bottom and left to right are supported, the only order in use.
fn size(line: &[u8]) -> Result<[u32; 2], HdrError> {
    let text = String::from_utf8_lossy(line);
    let words: Vec<&str> = text.split_whitespace().collect();
    let ["-Y", height, "+X", width] = words[..] else { return Err(HdrError::Size) };
    let number = |word: &str| word.parse().map_err(|_| HdrError::Size);
    Ok([number(width)?, number(height)?])
}

/// Converts a texel; mantissas are in units of 2^(exponent − 136), and an exponent of zero is black.
fn radiance([r, g, b, exponent]: [u8; 4]) -> [f32; 4] {
    // 2^(exponent - 128), which is subnormal for 1, and then the eight bits of the mantissas.
    let bits = if exponent > 1 { u32::from(exponent - 1) << 23 } else { u32::from(exponent) << 22 };
    let unit = f32::from_bits(bits) / 256.0;
    [unit * f32::from(r), unit * f32::from(g), unit * f32::from(b), 1.0]
}

/// Consumes the next `N` bytes.
fn take<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], HdrError> {
    let (taken, behind) = rest.split_first_chunk::<N>().ok_or(HdrError::CutShort)?;
    *rest = behind;
    Ok(*taken)
}

fn decode_row(rest: &mut &[u8], row: &mut [[u8; 4]], y: u32) -> Result<(), HdrError> {
    let first = take::<4>(rest)?;
    match first {
        // This texel marks a row in which each channel is run-length encoded separately.
        [2, 2, high, _] if high < 128 => (0..4).try_for_each(|channel| decode_channel(rest, row, channel, y)),
        _ => decode_texels(rest, first, row, y),
    }
}

/// Decodes the runs of one channel. A code up to 128 precedes that many literal bytes; a larger code repeats one byte
/// code − 128 times.
fn decode_channel(rest: &mut &[u8], row: &mut [[u8; 4]], channel: usize, y: u32) -> Result<(), HdrError> {
    let mut at = 0;
    while at < row.len() {
        let [code] = take(rest)?;
        let count = usize::from(if code > 128 { code - 128 } else { code });
        let run = row.get_mut(at..at + count).ok_or(HdrError::Run { row: y })?;
        if code > 128 {
            let [value] = take(rest)?;
            run.iter_mut().for_each(|texel| texel[channel] = value);
        } else {
            let (values, behind) = rest.split_at_checked(count).ok_or(HdrError::CutShort)?;
            run.iter_mut().zip(values).for_each(|(texel, value)| texel[channel] = *value);
            *rest = behind;
        }
        at += count;
    }
    Ok(())
}

/// Decodes the older form: runs of whole texels. The texel (1, 1, 1, n) repeats the previous texel n times, or n · 256
/// times directly after another such marker.
fn decode_texels(rest: &mut &[u8], first: [u8; 4], row: &mut [[u8; 4]], y: u32) -> Result<(), HdrError> {
    let beyond = HdrError::Run { row: y };
    if let [1, 1, 1, _] = first {
        return Err(beyond);
    }
    row[0] = first;
    let (mut at, mut previous, mut unit) = (1, first, 1_usize);
    while at < row.len() {
        let texel = take::<4>(rest)?;
        if let [1, 1, 1, count] = texel {
            let count = usize::from(count).checked_mul(unit).ok_or(beyond)?;
            let end = at.checked_add(count).ok_or(beyond)?;
            row.get_mut(at..end).ok_or(beyond)?.fill(previous);
            (at, unit) = (end, unit.saturating_mul(256));
        } else {
            row[at] = texel;
            (at, previous, unit) = (at + 1, texel, 1);
        }
    }
    Ok(())
}
