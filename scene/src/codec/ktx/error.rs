//! What a Khronos texture gets wrong.

use super::texel::TexelFormat;

/// Errors of a Khronos texture as a cube of light, or as a texture of a material.
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
    #[error("it has {levels} levels, more than a side of {size_texels} texels has")]
    Levels {
        /// Levels that it has.
        levels: u32,
        /// Its longer side.
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
    /// A texture of a material is a cube, deep, or an array.
    #[error("it has {faces} faces, depth {depth} and {layers} layers; write it as one flat picture")]
    NotFlat {
        /// Faces that it has.
        faces: u32,
        /// Its depth in texels.
        depth: u32,
        /// Elements of an array.
        layers: u32,
    },
    /// Texels of a texture are of a format that is not read.
    #[error(
        "its texels are of Vulkan format {format} and color model {model}; write Basis Universal (ETC1S or UASTC), or RGB or RGBA of 8 bits"
    )]
    Texels {
        /// Number of Vulkan's format, 0 for Basis Universal.
        format: u32,
        /// Color model of the data format descriptor.
        model: u8,
    },
    /// Levels of a texture are compressed in a way that is not read, or that does not go with its texels.
    #[error("its supercompression scheme is {scheme}; write BasisLZ for ETC1S, and none, Zstandard or zlib for others")]
    Scheme {
        /// The number of the scheme.
        scheme: u32,
    },
    /// A level does not decompress.
    #[error("level {level} does not decompress to {expected} bytes")]
    Inflate {
        /// The level, 0 the finest.
        level: u32,
        /// Bytes that there should be.
        expected: u64,
    },
    /// The texels of a level do not transcode.
    #[error("level {level} holds no valid texels of Basis Universal")]
    Transcode {
        /// The level, 0 the finest.
        level: u32,
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
