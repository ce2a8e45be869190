//! Khronos textures: cube maps of radiance in versions 1 and 2, and 2D textures in version 2 (`texture.rs`).
//!
//! A cube map has six square faces, +x −x +y −y +z −z, in the row order of cube map lookups. Texels are floating-point.
//! Filament's `cmgen` writes two such files for an environment. `_skybox.ktx` holds radiance. `_ibl.ktx` holds radiance
//! prefiltered by roughness, one roughness per level, and irradiance under the key `sh`.

#[cfg(feature = "basisu")]
mod basis;
mod cube;
mod entries;
pub(super) mod error;
#[cfg(feature = "basisu")]
mod inflate;
mod reader;
mod texel;
#[cfg(feature = "basisu")]
pub(super) mod texture;
mod version_1;
mod version_2;

use super::error::CodecError;
use super::kind::FileKind;

pub(crate) use cube::{CubeF32, CubeHeader};

/// Reads the header of a cube map and checks that the file contains all of its levels.
pub(crate) fn header(kind: FileKind, bytes: &[u8], max_texels: u32) -> Result<CubeHeader, CodecError> {
    match kind {
        FileKind::Ktx1 => version_1::header(bytes, max_texels),
        _ => version_2::header(bytes, max_texels),
    }
}
