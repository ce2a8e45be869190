//! What a Khronos texture gets wrong.

use super::texel::TexelFormat;

/// What a Khronos texture gets wrong as a cube of light.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum KtxError {
    /// The file ends too soon.
    #[error("it ends within its {what}")]
    CutShort {
        /// What is not there whole.
        what: &'static str,
    },
    /// The mark of the order of bytes is none.
    #[error("its mark of endianness is {mark:#010x}, neither 0x04030201 nor 0x01020304")]
    Endianness {
        /// The mark as little-endian bytes.
        mark: u32,
    },
    /// It is another texture than a cube.
    #[error(
        "it has {faces} faces, depth {depth} and {layers} layers; a cube has six faces, and is neither deep nor an array"
    )]
    NoCube {
        /// Faces that it has.
        faces: u32,
        /// Its depth in texels.
        depth: u32,
        /// Elements of an array.
        layers: u32,
    },
    /// Faces are not square.
    #[error("its faces are {}×{}, not square", size_texels[0], size_texels[1])]
    NotSquare {
        /// Width and height.
        size_texels: [u32; 2],
    },
    /// There are more levels than the size has.
    #[error("it has {levels} levels, more than faces of {size_texels} texels have")]
    Levels {
        /// Levels that it has.
        levels: u32,
        /// Width of its faces.
        size_texels: u32,
    },
    /// Texels are of a format that is not read.
    #[error("its texels are of {api} format {number:#x}; {} are read", TexelFormat::NAMES)]
    Format {
        /// Whose number it is: `OpenGL` or `Vulkan`.
        api: &'static str,
        /// The format.
        number: u32,
    },
    /// Levels are compressed.
    #[error(
        "its levels are supercompressed (scheme {scheme}); write it without (`toktx` without `--zcmp` or `--encode`)"
    )]
    Supercompressed {
        /// The number of the scheme.
        scheme: u32,
    },
    /// A level has another length than its size asks for.
    #[error("level {level} has {found} bytes, not {expected}")]
    LevelBytes {
        /// The level, 0 the finest.
        level: u32,
        /// Bytes that the file states: of a face in version 1, of the level in version 2.
        found: u64,
        /// Bytes that there should be.
        expected: u64,
    },
    /// A metadatum reaches beyond the metadata, or has no key.
    #[error("an entry of its metadata is broken")]
    Entry,
    /// Irradiance is unreadable.
    #[error("its metadatum `sh` does not hold nine lines of three finite numbers")]
    Harmonics,
}

impl std::fmt::Debug for KtxError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
