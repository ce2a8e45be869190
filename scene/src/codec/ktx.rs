//! Khronos textures: cubes of light in either version of the format, and flat textures in version 2 (`texture.rs`).
//!
//! A cube has six square faces, +x −x +y −y +z −z, each with its rows from the top as seen by who looks a cube up by
//! direction. Its texels are floating-point. Filament's `cmgen` writes two such files of an environment: `_skybox.ktx`, its
//! radiance, and `_ibl.ktx`, radiance filtered for a roughness a level, with irradiance under the key `sh`.

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

/// Reads the header of a cube and checks that the file holds all of its levels.
pub(crate) fn header(kind: FileKind, bytes: &[u8], max_texels: u32) -> Result<CubeHeader, CodecError> {
    match kind {
        FileKind::Ktx1 => version_1::header(bytes, max_texels),
        _ => version_2::header(bytes, max_texels),
    }
}
