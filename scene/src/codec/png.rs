//! PNG, by the `png` crate.

use std::io::{Cursor, Write};

use png::{BitDepth, ColorType, Compression, Decoder, Encoder, Filter, Limits, Reader, Transformations};

use super::error::CodecError;
use super::picture::{Header, Picture8, check_size, gray, opaque, widened};

/// Maximum bytes that the decoder may allocate for itself.
const MAX_DECODER_BYTES: usize = 512 << 20;

/// Reads the header and rejects sizes over the limit.
fn open(bytes: &[u8], max_side_texels: u32) -> Result<Reader<Cursor<&[u8]>>, CodecError> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: MAX_DECODER_BYTES });
    decoder.set_ignore_text_chunk(true);
    decoder.set_transformations(Transformations::EXPAND);
    let reader = decoder.read_info().map_err(CodecError::other)?;
    let (width, height) = reader.info().size();
    check_size([width, height], [max_side_texels; 2])?;
    Ok(reader)
}

/// Reads the size and the memory for samples in the file's own format.
pub(crate) fn header(bytes: &[u8], max_side_texels: u32) -> Result<Header, CodecError> {
    let reader = open(bytes, max_side_texels)?;
    let (width, height) = reader.info().size();
    let (color, depth) = reader.output_color_type();
    let header = Header { size_texels: [width, height], working_bytes: 0 };
    let samples = header.texels() * color.samples() as u64;
    // Sixteen-bit samples exist twice, as stored and rounded; eight-bit RGBA samples are the image itself.
    let working_bytes = match (color, depth) {
        (_, BitDepth::Sixteen) => samples * 3,
        (ColorType::Rgba, _) => 0,
        _ => samples,
    };
    Ok(Header { working_bytes, ..header })
}

/// Decodes to four bytes a texel, straight alpha. Color management chunks are ignored; 16-bit channels are rounded to 8
/// bits.
pub(crate) fn decode(bytes: &[u8], max_side_texels: u32) -> Result<Picture8, CodecError> {
    let mut reader = open(bytes, max_side_texels)?;
    let (width, height) = reader.info().size();
    let texels = width as usize * height as usize;
    let (color, depth) = reader.output_color_type();
    let mut samples = vec![0; texels * color.samples() * if depth == BitDepth::Sixteen { 2 } else { 1 }];
    reader.next_frame(&mut samples).map_err(CodecError::other)?;
    if depth == BitDepth::Sixteen {
        // 65535 = 257 · 255: rounds to the nearest 8-bit step.
        let eight = |two: &[u8]| ((u32::from(two[0]) * 256 + u32::from(two[1]) + 128) / 257) as u8;
        samples = samples.chunks_exact(2).map(eight).collect();
    }
    let rgba8 = match color {
        ColorType::Rgba => samples,
        ColorType::Rgb => opaque(&samples),
        ColorType::GrayscaleAlpha => widened(&samples, |[luma, alpha]| [luma, luma, luma, alpha]),
        // Palettes are expanded to colors.
        ColorType::Grayscale | ColorType::Indexed => gray(&samples),
    };
    Ok(Picture8 { size_texels: [width, height], rgba8 })
}

/// Encodes four bytes a texel, sRGB-encoded, straight alpha. The number of bytes must match the size.
pub(crate) fn encode(to: impl Write, [width, height]: [u32; 2], rgba8: &[u8]) -> Result<(), CodecError> {
    let mut encoder = Encoder::new(to, width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    let mut writer = encoder.write_header().map_err(CodecError::other)?;
    writer.write_image_data(rgba8).and_then(|()| writer.finish()).map_err(CodecError::other)
}
