//! Decoding and encoding of image files.
//!
//! Formats that need dependencies are features: `png`, `jpeg`, `webp`, `basisu`, `exr`. Every decoder checks a size
//! limit before it allocates. It returns an image or an error for any input and never panics.

#![cfg_attr(
    not(feature = "gltf"),
    allow(dead_code, unused_imports, reason = "only the importer reads texture headers separately")
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

/// Reads the header of a file that [`decode_8`] accepts.
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

/// Returns the error for a kind of file that is not decoded.
fn unread(kind: Option<FileKind>, bytes: &[u8]) -> CodecError {
    match kind {
        Some(kind) => CodecError::Kind(kind),
        None if bytes.is_empty() => CodecError::NoBytes,
        None => CodecError::Unknown,
    }
}

/// Decodes PNG, JPEG or WebP, as enabled in this build; the format is detected from the content.
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

/// Reads the header of a file that [`decode_texture`] accepts. The bytes may be a prefix of a longer file.
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

/// Decodes a file that [`decode_8`] accepts, or a KTX2 texture. The texture is transcoded to one of `formats` if
/// possible, otherwise to RGBA.
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

/// Returns the width and height of a file that [`decode_f32`] accepts.
pub(crate) fn header_f32(bytes: &[u8], max_texels: [u32; 2]) -> Result<[u32; 2], CodecError> {
    catch_panic(|| match FileKind::of(bytes) {
        Some(FileKind::Hdr) => hdr::header(bytes, max_texels),
        #[cfg(feature = "exr")]
        Some(FileKind::Exr) => exr::header(bytes, max_texels),
        kind => Err(unread(kind, bytes)),
    })
}

/// Decodes Radiance `.hdr` or, if enabled in this build, OpenEXR; the format is detected from the content.
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
