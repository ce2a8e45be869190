//! Decoded pictures.

use super::error::CodecError;

/// A picture of eight bits a channel.
pub(crate) struct Picture8 {
    /// Width and height.
    pub size_texels: [u32; 2],
    /// Four bytes a texel, rows from the top, straight alpha, in the file's transfer function.
    pub rgba8: Vec<u8>,
}

/// A picture of floats.
pub(crate) struct PictureF32 {
    /// Width and height.
    pub size_texels: [u32; 2],
    /// Four numbers a texel, rows from the top, linear light.
    pub rgba: Vec<[f32; 4]>,
}

/// Refuses sizes of zero or over a limit.
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

/// Three bytes a texel with alpha 255.
#[cfg(any(feature = "png", feature = "jpeg"))]
pub(super) fn opaque(rgb: &[u8]) -> Vec<u8> {
    rgb.chunks_exact(3).flat_map(|t| [t[0], t[1], t[2], 255]).collect()
}

/// One byte a texel as all three colors, with alpha 255.
#[cfg(any(feature = "png", feature = "jpeg"))]
pub(super) fn gray(luma: &[u8]) -> Vec<u8> {
    luma.iter().flat_map(|l| [*l, *l, *l, 255]).collect()
}
