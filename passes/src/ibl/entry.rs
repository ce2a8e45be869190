//! What an entry of the cache says, as bytes: little-endian, lengths checked on the way in.
//!
//! The file around it (magic, version, key, checksum) is [`cache`](super::cache)'s business; here a
//! payload is already known to be what was once written. It may still be of another shape, which is an
//! error and not a panic.

use glam::DVec3;
use wgpu::TextureFormat;

use super::Kept;
use super::texture::CubeShape;
use framegraph_scene::environment::{Sh, ShBands};

/// Kinds of entries.
pub(super) const LIGHT: u32 = 1;
pub(super) const DFG: u32 = 2;

/// The payload of an image light.
pub(super) fn encode_light(kept: &Kept, shape: &CubeShape) -> Vec<u8> {
    let mut out = Vec::with_capacity(1024 + shape.bytes() as usize);
    for number in [shape.texels, shape.levels, format_number(shape.format), kept.sh.bands().count() as u32] {
        out.extend(number.to_le_bytes());
    }
    out.extend(kept.texel_nits.to_le_bytes());
    for color in std::iter::once(&kept.average).chain(kept.sh.radiance_coefficients()) {
        color.to_array().into_iter().for_each(|c| out.extend(c.to_le_bytes()));
    }
    kept.levels.iter().for_each(|level| out.extend(level));
    out
}

/// The light of a payload that must be of this shape.
pub(super) fn decode_light(payload: &[u8], shape: &CubeShape) -> Result<Kept, &'static str> {
    let mut read = Reader(payload);
    let header = [read.u32()?, read.u32()?, read.u32()?];
    if header != [shape.texels, shape.levels, format_number(shape.format)] {
        return Err("it holds a cube of another shape");
    }
    let bands = match read.u32()? {
        2 => ShBands::Two,
        3 => ShBands::Three,
        5 => ShBands::Five,
        _ => return Err("it holds an unknown number of bands"),
    };
    let texel_nits = f32::from_le_bytes(read.array()?);
    let average = read.color()?;
    let coefficients = (0..bands.coefficients()).map(|_| read.color()).collect::<Result<Vec<_>, _>>()?;
    let finite = texel_nits.is_finite() && average.is_finite() && coefficients.iter().all(|c| c.is_finite());
    if !finite {
        return Err("it holds numbers that are not finite");
    }
    let level = |level: u32| 6 * shape.face_bytes(level);
    let levels = (0..shape.levels).map(|i| read.take(level(i)).map(<[u8]>::to_vec)).collect::<Result<_, _>>()?;
    read.end()?;
    Ok(Kept { sh: Sh::from_coefficients(bands, coefficients), average, texel_nits, levels })
}

/// The payload of a DFG table.
pub(super) fn encode_dfg(bytes: &[u8], texels: u32) -> Vec<u8> {
    [&texels.to_le_bytes(), bytes].concat()
}

/// The texels of a DFG table of this size.
pub(super) fn decode_dfg(payload: &[u8], texels: u32) -> Result<Vec<u8>, &'static str> {
    let mut read = Reader(payload);
    if read.u32()? != texels {
        return Err("it holds a table of another size");
    }
    let bytes = read.take((texels * texels * 8) as usize)?.to_vec();
    read.end()?;
    Ok(bytes)
}

fn format_number(format: TextureFormat) -> u32 {
    if format == TextureFormat::Rg11b10Ufloat { 1 } else { 2 }
}

struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], &'static str> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or("it ends early")?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], &'static str> {
        self.take(N)?.try_into().map_err(|_| "it ends early")
    }

    fn u32(&mut self) -> Result<u32, &'static str> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    fn color(&mut self) -> Result<DVec3, &'static str> {
        let mut channel = || Ok::<_, &'static str>(f64::from_le_bytes(self.array()?));
        Ok(DVec3::new(channel()?, channel()?, channel()?))
    }

    fn end(self) -> Result<(), &'static str> {
        if self.0.is_empty() { Ok(()) } else { Err("it goes on after its end") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> (Kept, CubeShape) {
        let shape = CubeShape { texels: 64, levels: 5, format: TextureFormat::Rg11b10Ufloat };
        let sh = Sh::from_coefficients(ShBands::Two, (0..4).map(|i| DVec3::splat(f64::from(i))).collect());
        let levels = (0..5).map(|i| vec![i as u8; 6 * shape.face_bytes(i)]).collect();
        (Kept { sh, average: DVec3::new(1.0, 2.0, 3.0), texel_nits: 0.25, levels }, shape)
    }

    #[test]
    fn what_was_written_is_read() {
        let (kept, shape) = sample();
        let read = decode_light(&encode_light(&kept, &shape), &shape).expect("our own bytes");
        assert_eq!((read.sh, read.average, read.texel_nits), (kept.sh, kept.average, kept.texel_nits));
        assert_eq!(read.levels, kept.levels);
        let table = vec![7; 16 * 16 * 8];
        assert_eq!(decode_dfg(&encode_dfg(&table, 16), 16), Ok(table));
    }

    #[test]
    fn other_shapes_and_lengths_are_refused() {
        let (kept, shape) = sample();
        let bytes = encode_light(&kept, &shape);
        for cut in [0, 3, 17, 100, bytes.len() - 1] {
            assert!(decode_light(&bytes[..cut], &shape).is_err(), "{cut}");
        }
        assert!(decode_light(&[bytes.clone(), vec![0]].concat(), &shape).is_err());
        assert!(decode_light(&bytes, &CubeShape { levels: 6, ..shape }).is_err());
        assert!(decode_light(&bytes, &CubeShape { format: TextureFormat::Rgba16Float, ..shape }).is_err());
        let mut nan = bytes;
        nan[16..20].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(decode_light(&nan, &shape).is_err());
        assert!(decode_dfg(&encode_dfg(&[0; 100], 16), 16).is_err());
    }
}
