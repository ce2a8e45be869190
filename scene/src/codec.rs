//! Picture files, decoded and encoded.
//!
//! Formats that cost crates are features: `png`, `jpeg`, `webp`, `basisu`, `exr`. Every decoder takes the largest size that is accepted,
//! which it checks before it allocates, and answers any bytes with a picture or an error.

#![cfg_attr(
    not(feature = "gltf"),
    allow(dead_code, unused_imports, reason = "import alone reads headers of textures apart")
)]

mod catch;
mod error;
#[cfg(feature = "exr")]
pub(crate) mod exr;
mod hdr;
#[cfg(feature = "jpeg")]
mod jpeg;
mod kind;
mod ktx;
mod picture;
#[cfg(feature = "png")]
pub(crate) mod png;
#[cfg(feature = "webp")]
mod webp;

pub(crate) use catch::catch_panic;
pub use error::{CodecError, HdrError};
pub use kind::FileKind;
pub use ktx::error::KtxError;
pub(crate) use ktx::{CubeF32, header as cube_header};
pub(crate) use picture::{Header, Picture8, PictureF32, TextureHeader, TextureLevels};

use crate::texture::BlockFormats;

/// Reads the header of what [`decode_8`] decodes.
#[cfg_attr(
    not(any(feature = "png", feature = "jpeg", feature = "webp")),
    allow(unused_variables, reason = "then every kind is refused")
)]
pub(crate) fn header_8(bytes: &[u8], max_side_texels: u32) -> Result<Header, CodecError> {
    catch_panic(|| match FileKind::of(bytes) {
        #[cfg(feature = "png")]
        Some(FileKind::Png) => png::header(bytes, max_side_texels),
        #[cfg(feature = "jpeg")]
        Some(FileKind::Jpeg) => jpeg::header(bytes, max_side_texels),
        #[cfg(feature = "webp")]
        Some(FileKind::WebP) => webp::header(bytes, max_side_texels),
        kind => Err(unread(kind, bytes)),
    })
}

/// Why bytes of this kind are not decoded.
fn unread(kind: Option<FileKind>, bytes: &[u8]) -> CodecError {
    match kind {
        Some(kind) => CodecError::Kind(kind),
        None if bytes.is_empty() => CodecError::NoBytes,
        None => CodecError::Unknown,
    }
}

/// Decodes PNG, JPEG or WebP, as far as this build reads them; the content decides which.
#[cfg_attr(
    not(any(feature = "png", feature = "jpeg", feature = "webp")),
    allow(unused_variables, reason = "then every kind is refused")
)]
pub(crate) fn decode_8(bytes: &[u8], max_side_texels: u32) -> Result<Picture8, CodecError> {
    catch_panic(|| match FileKind::of(bytes) {
        #[cfg(feature = "png")]
        Some(FileKind::Png) => png::decode(bytes, max_side_texels),
        #[cfg(feature = "jpeg")]
        Some(FileKind::Jpeg) => jpeg::decode(bytes, max_side_texels),
        #[cfg(feature = "webp")]
        Some(FileKind::WebP) => webp::decode(bytes, max_side_texels),
        kind => Err(unread(kind, bytes)),
    })
}

/// Reads the header of what [`decode_texture`] decodes. The bytes may be the first of a longer file.
#[cfg_attr(not(feature = "basisu"), allow(unused_variables, reason = "then no format of blocks is made"))]
pub(crate) fn texture_header(
    bytes: &[u8],
    max_side_texels: u32,
    formats: BlockFormats,
) -> Result<TextureHeader, CodecError> {
    #[cfg(feature = "basisu")]
    if FileKind::of(bytes) == Some(FileKind::Ktx2) {
        return ktx::texture::header(bytes, max_side_texels, formats).map(|header| header.summary());
    }
    header_8(bytes, max_side_texels).map(TextureHeader::from)
}

/// Decodes what [`decode_8`] decodes, or a KTX2 texture: to one of `formats` where it can be transcoded, to RGBA otherwise.
#[cfg_attr(not(feature = "basisu"), allow(unused_variables, reason = "then no format of blocks is made"))]
pub(crate) fn decode_texture(
    bytes: &[u8],
    max_side_texels: u32,
    formats: BlockFormats,
) -> Result<TextureLevels, CodecError> {
    #[cfg(feature = "basisu")]
    if FileKind::of(bytes) == Some(FileKind::Ktx2) {
        return catch_panic(|| ktx::texture::decode(bytes, max_side_texels, formats));
    }
    decode_8(bytes, max_side_texels).map(TextureLevels::from)
}

/// Width and height of what [`decode_f32`] decodes.
pub(crate) fn header_f32(bytes: &[u8], max_texels: [u32; 2]) -> Result<[u32; 2], CodecError> {
    catch_panic(|| match FileKind::of(bytes) {
        Some(FileKind::Hdr) => hdr::header(bytes, max_texels),
        #[cfg(feature = "exr")]
        Some(FileKind::Exr) => exr::header(bytes, max_texels),
        kind => Err(unread(kind, bytes)),
    })
}

/// Decodes Radiance `.hdr` or, as far as this build reads it, OpenEXR; the content decides which.
pub(crate) fn decode_f32(bytes: &[u8], max_texels: [u32; 2]) -> Result<PictureF32, CodecError> {
    catch_panic(|| match FileKind::of(bytes) {
        Some(FileKind::Hdr) => hdr::decode(bytes, max_texels),
        #[cfg(feature = "exr")]
        Some(FileKind::Exr) => exr::decode(bytes, max_texels),
        kind => Err(unread(kind, bytes)),
    })
}

#[cfg(test)]
mod tests;
