//! Key-value metadata, of which irradiance is read.

use super::cube::Harmonics;
use super::error::KtxError;
use super::reader::Reader;

/// Key of irradiance.
const KEY: &[u8] = b"sh";

/// Returns the value of the key `sh`, if any, from the metadata `what`. An entry is its length, a key that ends with a
/// zero byte, and the value, padded to four bytes.
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
        // The padding of the last entry may be missing.
        let padding = length.next_multiple_of(4) - length;
        reader.at = (reader.at + padding).min(what.len());
    }
    Ok(found)
}

/// Parses nine colors as text, one per line.
fn numbers(value: &[u8]) -> Result<Harmonics, KtxError> {
    let text = std::str::from_utf8(value).map_err(|_| KtxError::Harmonics)?;
    let words = text.trim_end_matches('\0').split_ascii_whitespace();
    let mut numbers = words.map(|word| word.parse::<f32>().ok().filter(|number| number.is_finite()));
    let mut harmonics = Harmonics::default();
    for number in harmonics.as_flattened_mut() {
        *number = numbers.next().flatten().ok_or(KtxError::Harmonics)?;
    }
    // Only files with exactly nine colors (three bands) are valid.
    if numbers.next().is_some() { Err(KtxError::Harmonics) } else { Ok(harmonics) }
}
