//! Decoded images.

use super::error::CodecError;
use crate::texture::ImageFormat;

/// Image with eight bits a channel.
pub(crate) struct Picture8 {
    /// Width and height.
    pub size_texels: [u32; 2],
    /// Four bytes a texel, rows from the top, straight alpha, in the file's transfer function.
    pub rgba8: Vec<u8>,
}

/// Header of an image with eight bits a channel.
#[derive(Clone, Copy, Default)]
pub(crate) struct Header {
    /// Width and height.
    pub size_texels: [u32; 2],
    /// Bytes that decoding allocates in addition to the image.
    pub working_bytes: u64,
}

impl Header {
    /// Returns the bytes of the decoded image.
    pub fn rgba8_bytes(&self) -> u64 {
        self.texels() * 4
    }

    pub(super) fn texels(&self) -> u64 {
        u64::from(self.size_texels[0]) * u64::from(self.size_texels[1])
    }
}

/// Decoded texture: an image or compressed blocks, with the mip levels of the file.
pub(crate) struct TextureLevels {
    /// Width and height of the first level.
    pub size_texels: [u32; 2],
    /// Format of the texels.
    pub format: ImageFormat,
    /// The first level alone, or every level down to 1 × 1.
    pub levels: Vec<Vec<u8>>,
}

impl From<Picture8> for TextureLevels {
    fn from(picture: Picture8) -> Self {
        Self { size_texels: picture.size_texels, format: ImageFormat::Rgba8, levels: vec![picture.rgba8] }
    }
}

/// Size and memory needs of a texture according to its header.
#[derive(Clone, Copy, Default)]
pub(crate) struct TextureHeader {
    /// Width and height of the first level.
    pub size_texels: [u32; 2],
    /// Bytes of all decoded levels.
    pub image_bytes: u64,
    /// Bytes that decoding allocates in addition to the levels.
    pub working_bytes: u64,
}

impl From<Header> for TextureHeader {
    fn from(header: Header) -> Self {
        let Header { size_texels, working_bytes } = header;
        Self { size_texels, image_bytes: header.rgba8_bytes(), working_bytes }
    }
}

/// Image of floats.
pub(crate) struct PictureF32 {
    /// Width and height.
    pub size_texels: [u32; 2],
    /// Four numbers a texel, rows from the top, linear light.
    pub rgba: Vec<[f32; 4]>,
}

/// Rejects sizes of zero or over a limit.
pub(super) fn check_size(size_texels: [u32; 2], limits: [u32; 2]) -> Result<(), CodecError> {
    if size_texels.contains(&0) {
        return Err(CodecError::Empty { size_texels });
    }
    for ((what, value), limit) in ["width in texels", "height in texels"].into_iter().zip(size_texels).zip(limits) {
        if value > limit {
            return Err(CodecError::TooLarge { what, value: value.into(), limit: limit.into() });
        }
    }
    Ok(())
}

/// Converts three bytes a texel to RGBA with alpha 255.
#[cfg(any(feature = "png", feature = "jpeg", feature = "webp", feature = "basisu"))]
pub(super) fn opaque(rgb: &[u8]) -> Vec<u8> {
    widened(rgb, |[r, g, b]| [r, g, b, 255])
}

/// Converts one byte a texel to gray RGBA with alpha 255.
#[cfg(any(feature = "png", feature = "jpeg"))]
pub(super) fn gray(luma: &[u8]) -> Vec<u8> {
    widened(luma, |[l]| [l, l, l, 255])
}

/// Converts samples of `N` bytes to RGBA in a buffer of exactly the needed capacity.
#[cfg(any(feature = "png", feature = "jpeg", feature = "webp", feature = "basisu"))]
pub(super) fn widened<const N: usize>(samples: &[u8], rgba: impl Fn([u8; N]) -> [u8; 4]) -> Vec<u8> {
    let (texels, _) = samples.as_chunks::<N>();
    let mut wide = Vec::with_capacity(texels.len() * 4);
    texels.iter().for_each(|texel| wide.extend(rgba(*texel)));
    wide
}
