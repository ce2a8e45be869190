//! Size of the part of a resource that an access names, such as `mip 2 layer 0`.

use super::rows::Resource;
use std::ops::Range;

/// Returns the bytes of a part; of the whole resource without one.
pub(super) fn part_bytes(resource: &Resource, part: Option<&str>) -> u64 {
    let Some(part) = part else { return resource.bytes };
    if let Some(bytes) = range(part, "byte", u64::MAX) {
        return resource.bytes.min(bytes.end.saturating_sub(bytes.start));
    }
    let (mips, layers) = (resource.mips.unwrap_or(1).max(1), resource.layers.unwrap_or(1).max(1));
    let Some([width, height]) = resource.extent else { return resource.bytes };
    let texels_of = |mip: u64| {
        let side = |texels: u32| (u64::from(texels) >> mip.min(31)).max(1);
        side(width) * side(height)
    };
    let texels = |mips: Range<u64>| mips.map(texels_of).fold(0, u64::saturating_add);
    let whole = u128::from(texels(0..mips)) * u128::from(layers);
    let layers = range(part, "layer", layers).map_or(layers, |layers| layers.end.saturating_sub(layers.start));
    let read = u128::from(texels(range(part, "mip", mips).unwrap_or(0..mips))) * u128::from(layers);
    let bytes = u128::from(resource.bytes) * read / whole.max(1);
    resource.bytes.min(u64::try_from(bytes).unwrap_or(u64::MAX))
}

/// Returns the numbers after a word or its plural: `mip 2`, `mips 1..3`, `mips 1..`, all below `end`.
fn range(part: &str, word: &str, end: u64) -> Option<Range<u64>> {
    let mut words = part.split_whitespace();
    words.find(|other| other.strip_suffix('s').unwrap_or(other) == word)?;
    let numbers = words.next()?;
    let number = |text: &str| text.parse::<u64>().ok();
    let (first, last) = match numbers.split_once("..") {
        Some((first, "")) => (number(first)?, end),
        Some((first, last)) => (number(first)?, number(last)?),
        None => (number(numbers)?, number(numbers)?.checked_add(1)?),
    };
    (first <= last).then(|| first..last.min(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_a_layer_and_a_range_of_bytes_are_counted_alone() {
        let texture =
            Resource { bytes: 4 * 85 * 2, extent: Some([8, 8]), mips: Some(4), layers: Some(2), ..Resource::default() };
        let of = |part| part_bytes(&texture, Some(part));
        assert_eq!(part_bytes(&texture, None), 680);
        assert_eq!((of("mip 0"), of("mip 3"), of("mip 9")), (512, 8, 0));
        assert_eq!((of("mips 1..3 layer 1"), of("mips 2.."), of("layer 0 depth")), (80, 40, 340));
        assert_eq!(of("as Rgba8Unorm"), 680);
        let buffer = Resource { bytes: 100, ..Resource::default() };
        assert_eq!(part_bytes(&buffer, Some("bytes 16..48")), 32);
        assert_eq!(part_bytes(&buffer, Some("bytes 90..200")), 100);
    }
}
