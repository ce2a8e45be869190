//! Metadata: keys with values, of which irradiance is read.

use super::cube::Harmonics;
use super::error::KtxError;
use super::reader::Reader;

/// The key of irradiance.
const KEY: &[u8] = b"sh";

/// The value under `sh`, if there is one. An entry is its length, then a key that ends with a zero, then the value, padded
/// to four bytes; `what` is all of them.
pub(super) fn harmonics(what: &[u8], big_endian: bool) -> Result<Option<Harmonics>, KtxError> {
    let mut reader = Reader { bytes: what, at: 0, big_endian, what: "metadata" };
    let mut found = None;
    while reader.at < what.len() {
        let length = reader.u32()? as usize;
        let entry = reader.take(length)?;
        let end = entry.iter().position(|byte| *byte == 0).ok_or(KtxError::Entry)?;
        if &entry[..end] == KEY {
            found = Some(numbers(&entry[end + 1..])?);
        }
        // The padding of the last entry may be left out.
        let padding = length.next_multiple_of(4) - length;
        reader.at = (reader.at + padding).min(what.len());
    }
    Ok(found)
}

/// Nine colors as text, a line each.
fn numbers(value: &[u8]) -> Result<Harmonics, KtxError> {
    let text = std::str::from_utf8(value).map_err(|_| KtxError::Harmonics)?;
    let words = text.trim_end_matches('\0').split_ascii_whitespace();
    let mut numbers = words.map(|word| word.parse::<f32>().ok().filter(|number| number.is_finite()));
    let mut harmonics = Harmonics::default();
    for number in harmonics.as_flattened_mut() {
        *number = numbers.next().flatten().ok_or(KtxError::Harmonics)?;
    }
    // Further bands would be of no use to who knows three; a file with other than nine colors is no such file.
    if numbers.next().is_some() { Err(KtxError::Harmonics) } else { Ok(harmonics) }
}
