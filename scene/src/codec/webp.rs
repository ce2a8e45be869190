//! WebP, decoded by the `image-webp` crate.

use std::io::Cursor;

use image_webp::WebPDecoder;

use super::error::CodecError;
use super::picture::{Header, Picture8, check_size, opaque};

/// Maximum number of bytes per texel that decoding allocates in addition to the image (RFC 9649). A lossy image has
/// three-byte samples and planes of luma, chroma and alpha. A lossless one has four-byte samples and transform images.
const WORKING_BYTES: u64 = 8;

/// Reads the header; rejects animations and sizes over the limit.
fn open(bytes: &[u8], max_side_texels: u32) -> Result<WebPDecoder<Cursor<&[u8]>>, CodecError> {
    let decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(CodecError::other)?;
    let (width, height) = decoder.dimensions();
    check_size([width, height], [max_side_texels; 2])?;
    if decoder.is_animated() {
        return Err(CodecError::Other("it is an animation; use a still image".into()));
    }
    // The decoder allocates memory for the lossy frame before it compares the frame size with the image size.
    match lossy_size(bytes) {
        Some(frame) if frame != [width, height] => {
            let [frame_width, frame_height] = frame;
            let reason = format!("its size is {width}×{height}, but that of its frame is {frame_width}×{frame_height}");
            Err(CodecError::Other(reason.into()))
        }
        _ => Ok(decoder),
    }
}

/// Returns the width and height in the first `VP8 ` chunk (RFC 6386, section 9.1).
fn lossy_size(bytes: &[u8]) -> Option<[u32; 2]> {
    // The chunks follow `RIFF`, a length and `WEBP`.
    let mut at = 12;
    loop {
        let (name, length) = (bytes.get(at..at + 4)?, bytes.get(at + 4..at + 8)?);
        if name == b"VP8 " {
            let size = bytes.get(at + 14..at + 18)?;
            return Some([0, 2].map(|i| u32::from(u16::from_le_bytes([size[i], size[i + 1]]) & 0x3fff)));
        }
        let length = u32::from_le_bytes(length.try_into().ok()?) as usize;
        at = at.checked_add(8)?.checked_add(length)?.checked_next_multiple_of(2)?;
        at.checked_add(8)?;
    }
}

/// Returns the size, and the maximum number of bytes that decoding allocates.
pub(super) fn header(bytes: &[u8], max_side_texels: u32) -> Result<Header, CodecError> {
    let (width, height) = open(bytes, max_side_texels)?.dimensions();
    let header = Header { size_texels: [width, height], working_bytes: 0 };
    Ok(Header { working_bytes: header.texels() * WORKING_BYTES, ..header })
}

/// Decodes a lossy or lossless image to four bytes a texel, straight alpha. Embedded profiles are ignored.
pub(super) fn decode(bytes: &[u8], max_side_texels: u32) -> Result<Picture8, CodecError> {
    let mut decoder = open(bytes, max_side_texels)?;
    let (width, height) = decoder.dimensions();
    let channels = if decoder.has_alpha() { 4 } else { 3 };
    let mut samples = vec![0; width as usize * height as usize * channels];
    decoder.read_image(&mut samples).map_err(CodecError::other)?;
    let rgba8 = if channels == 4 { samples } else { opaque(&samples) };
    Ok(Picture8 { size_texels: [width, height], rgba8 })
}
