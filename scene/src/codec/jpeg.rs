//! JPEG, decoded by the `zune-jpeg` crate.

use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;

use super::error::CodecError;
use super::picture::{Header, Picture8, check_size, gray, opaque};

/// Returns a decoder that has read the header, and the header.
fn open(bytes: &[u8], max_side_texels: u32) -> Result<(JpegDecoder<ZCursor<&[u8]>>, Header, bool), CodecError> {
    let options = DecoderOptions::default().set_strict_mode(false).set_max_width(usize::MAX).set_max_height(usize::MAX);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(CodecError::other)?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let header = Header { size_texels: [width as u32, height as u32], working_bytes: 0 };
    check_size(header.size_texels, [max_side_texels; 2])?;
    let is_gray = decoder.input_colorspace() == Some(ColorSpace::Luma);
    let space = if is_gray { ColorSpace::Luma } else { ColorSpace::RGB };
    decoder.set_options(options.jpeg_set_out_colorspace(space));
    let channels = if is_gray { 1 } else { 3 };
    // One byte per sample and two per coefficient; a progressive file needs all coefficients at once.
    let working_bytes = header.texels() * channels * 3;
    Ok((decoder, Header { working_bytes, ..header }, is_gray))
}

/// Reads the size and the memory for samples and coefficients.
pub(crate) fn header(bytes: &[u8], max_side_texels: u32) -> Result<Header, CodecError> {
    open(bytes, max_side_texels).map(|(_, header, _)| header)
}

/// Decodes to four bytes a texel, alpha 255. Embedded profiles and orientations are ignored.
pub(crate) fn decode(bytes: &[u8], max_side_texels: u32) -> Result<Picture8, CodecError> {
    let (mut decoder, Header { size_texels, .. }, is_gray) = open(bytes, max_side_texels)?;
    let samples = decoder.decode().map_err(CodecError::other)?;
    Ok(Picture8 { size_texels, rgba8: if is_gray { gray(&samples) } else { opaque(&samples) } })
}
