//! Payloads of cache entries: little-endian, with checked lengths.
//!
//! The module [`cache`](super::cache) checks the file around a payload (magic, version, key, checksum). A payload of
//! another shape is an error, not a panic.

use framegraph::Format;
use framegraph_scene::environment::{Sh, ShBands};
use glam::DVec3;

use super::texture::CubeShape;

/// Kind of entries with prefiltered light.
pub(super) const LIGHT: u32 = 1;
/// Kind of entries with a DFG table.
pub(super) const DFG: u32 = 2;

/// Cached light of an environment.
pub(super) struct LightEntry {
    /// Radiance of the map as spherical harmonics; in nits for a map in nits.
    pub sh: Sh,
    /// Mean radiance over all directions, linear Rec.709, in nits.
    pub average: DVec3,
    /// Radiance in nits of a cube texel with value 1.
    pub texel_nits: f32,
    /// Bytes of each level of the cube: consecutive faces, rows without padding.
    pub levels: Vec<Vec<u8>>,
}

/// Reason why a cache entry is unusable. The caller computes it again.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(super) enum EntryError {
    /// The file or its payload is too short.
    #[error("it is cut short")]
    CutShort,
    /// The payload is too long.
    #[error("it goes on after its end")]
    TrailingBytes,
    /// The file does not start with the magic bytes.
    #[error("it is no entry of this cache")]
    Magic,
    /// The file has another version.
    #[error("it is of another version")]
    Version,
    /// The checksum does not match.
    #[error("it is damaged: its checksum is wrong")]
    Checksum,
    /// The key or the kind is that of another entry, as after renaming a file.
    #[error("it is another entry under a wrong name")]
    Name,
    /// The payload has another size or format than requested.
    #[error("it holds a cube or table of another size or format")]
    Shape,
    /// The number of bands of spherical harmonics is unsupported.
    #[error("it holds {0} bands of spherical harmonics, which must be 2, 3 or 5")]
    Bands(u32),
    /// A number is infinite or NaN.
    #[error("it holds numbers that are not finite")]
    NotFinite,
}

impl std::fmt::Debug for EntryError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Returns the payload of prefiltered light.
pub(super) fn encode_light(light: &LightEntry, shape: &CubeShape) -> Vec<u8> {
    let mut out = Vec::with_capacity(1024 + shape.bytes() as usize);
    for number in [shape.texels, shape.levels, format_number(shape.format), light.sh.bands().count() as u32] {
        out.extend(number.to_le_bytes());
    }
    out.extend(light.texel_nits.to_le_bytes());
    for color in std::iter::once(&light.average).chain(light.sh.radiance_coefficients()) {
        color.to_array().into_iter().for_each(|c| out.extend(c.to_le_bytes()));
    }
    light.levels.iter().for_each(|level| out.extend(level));
    out
}

/// Decodes prefiltered light of this shape.
pub(super) fn decode_light(payload: &[u8], shape: &CubeShape) -> Result<LightEntry, EntryError> {
    let mut read = Reader(payload);
    let header = [read.u32()?, read.u32()?, read.u32()?];
    if header != [shape.texels, shape.levels, format_number(shape.format)] {
        return Err(EntryError::Shape);
    }
    let bands = match read.u32()? {
        2 => ShBands::Two,
        3 => ShBands::Three,
        5 => ShBands::Five,
        bands => return Err(EntryError::Bands(bands)),
    };
    let texel_nits = f32::from_le_bytes(read.array()?);
    let average = read.color()?;
    let coefficients = (0..bands.coefficients()).map(|_| read.color()).collect::<Result<Vec<_>, _>>()?;
    let finite = texel_nits.is_finite() && average.is_finite() && coefficients.iter().all(|c| c.is_finite());
    if !finite {
        return Err(EntryError::NotFinite);
    }
    let level = |level: u32| 6 * shape.face_bytes(level);
    let levels = (0..shape.levels).map(|i| read.take(level(i)).map(<[u8]>::to_vec)).collect::<Result<_, _>>()?;
    read.end()?;
    Ok(LightEntry { sh: Sh::from_coefficients(bands, coefficients), average, texel_nits, levels })
}

/// Returns the payload of a DFG table.
pub(super) fn encode_dfg(bytes: &[u8], texels: u32) -> Vec<u8> {
    [&texels.to_le_bytes(), bytes].concat()
}

/// Returns the texels of a DFG table of this size.
pub(super) fn decode_dfg(payload: &[u8], texels: u32) -> Result<Vec<u8>, EntryError> {
    let mut read = Reader(payload);
    if read.u32()? != texels {
        return Err(EntryError::Shape);
    }
    let bytes = read.take((texels * texels * 8) as usize)?.to_vec();
    read.end()?;
    Ok(bytes)
}

fn format_number(format: Format) -> u32 {
    if format == Format::Rg11b10Ufloat { 1 } else { 2 }
}

/// Unread rest of a payload.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], EntryError> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(EntryError::CutShort)?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], EntryError> {
        self.take(N)?.try_into().map_err(|_| EntryError::CutShort)
    }

    fn u32(&mut self) -> Result<u32, EntryError> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    fn color(&mut self) -> Result<DVec3, EntryError> {
        let mut channel = || Ok::<_, EntryError>(f64::from_le_bytes(self.array()?));
        Ok(DVec3::new(channel()?, channel()?, channel()?))
    }

    fn end(self) -> Result<(), EntryError> {
        if self.0.is_empty() { Ok(()) } else { Err(EntryError::TrailingBytes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> (LightEntry, CubeShape) {
        let shape = CubeShape { texels: 64, levels: 5, format: Format::Rg11b10Ufloat };
        let sh = Sh::from_coefficients(ShBands::Two, (0..4).map(|i| DVec3::splat(f64::from(i))).collect());
        let levels = (0..5).map(|i| vec![i as u8; 6 * shape.face_bytes(i)]).collect();
        (LightEntry { sh, average: DVec3::new(1.0, 2.0, 3.0), texel_nits: 0.25, levels }, shape)
    }

    #[test]
    fn what_was_written_is_read() {
        let (light, shape) = sample();
        let read = decode_light(&encode_light(&light, &shape), &shape).expect("our own bytes");
        assert_eq!((read.sh, read.average, read.texel_nits), (light.sh, light.average, light.texel_nits));
        assert_eq!(read.levels, light.levels);
        let table = vec![7; 16 * 16 * 8];
        assert_eq!(decode_dfg(&encode_dfg(&table, 16), 16), Ok(table));
    }

    #[test]
    fn other_shapes_and_lengths_are_refused() {
        let (light, shape) = sample();
        let bytes = encode_light(&light, &shape);
        for cut in [0, 3, 17, 100, bytes.len() - 1] {
            assert!(decode_light(&bytes[..cut], &shape).is_err(), "{cut}");
        }
        assert!(decode_light(&[bytes.clone(), vec![0]].concat(), &shape).is_err());
        assert!(decode_light(&bytes, &CubeShape { levels: 6, ..shape }).is_err());
        assert!(decode_light(&bytes, &CubeShape { format: Format::Rgba16Float, ..shape }).is_err());
        let mut nan = bytes;
        nan[16..20].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(decode_light(&nan, &shape).is_err());
        assert!(decode_dfg(&encode_dfg(&[0; 100], 16), 16).is_err());
    }
}
