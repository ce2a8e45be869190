//! Errors in Khronos textures.

use super::texel::TexelFormat;

/// Error in a Khronos texture used as a cube map of radiance or as a texture of a material.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum KtxError {
    /// The file is truncated.
    #[error("it ends within its {what}")]
    CutShort {
        /// Truncated part of the file.
        what: &'static str,
    },
    /// The byte-order mark is invalid.
    #[error("its mark of endianness is {mark:#010x}, neither 0x04030201 nor 0x01020304")]
    Endianness {
        /// Byte-order mark, read as little-endian.
        mark: u32,
    },
    /// The texture is not a cube map.
    #[error(
        "it has {faces} faces, depth {depth} and {layers} layers; a cube has six faces, and is neither deep nor an array"
    )]
    NoCube {
        /// Number of faces.
        faces: u32,
        /// Depth in texels.
        depth: u32,
        /// Number of array layers.
        layers: u32,
    },
    /// The faces are not square.
    #[error("its faces are {}×{}, not square", size_texels[0], size_texels[1])]
    NotSquare {
        /// Width and height.
        size_texels: [u32; 2],
    },
    /// The number of levels exceeds the full mip chain.
    #[error("it has {levels} levels, more than a side of {size_texels} texels has")]
    Levels {
        /// Number of levels.
        levels: u32,
        /// Longer side.
        size_texels: u32,
    },
    /// The texel format is not supported.
    #[error("its texels are of {api} format {number:#x}; {} are read", TexelFormat::NAMES)]
    Format {
        /// API whose format number it is: `OpenGL` or `Vulkan`.
        api: &'static str,
        /// Format number.
        number: u32,
    },
    /// The levels are supercompressed.
    #[error(
        "its levels are supercompressed (scheme {scheme}); write it without (`toktx` without `--zcmp` or `--encode`)"
    )]
    Supercompressed {
        /// Number of the supercompression scheme.
        scheme: u32,
    },
    /// The length of a level does not match its size.
    #[error("level {level} has {found} bytes, not {expected}")]
    LevelBytes {
        /// Level number, 0 the finest.
        level: u32,
        /// Bytes according to the file: of a face in version 1, of the level in version 2.
        found: u64,
        /// Expected number of bytes.
        expected: u64,
    },
    /// A texture of a material is a cube map, a 3D texture or an array.
    #[error("it has {faces} faces, depth {depth} and {layers} layers; write it as a single 2D image")]
    NotFlat {
        /// Number of faces.
        faces: u32,
        /// Depth in texels.
        depth: u32,
        /// Number of array layers.
        layers: u32,
    },
    /// The texel format of a texture is not supported.
    #[error(
        "its texels are of Vulkan format {format} and color model {model}; write Basis Universal (ETC1S or UASTC), or RGB or RGBA of 8 bits"
    )]
    Texels {
        /// Vulkan format number, 0 for Basis Universal.
        format: u32,
        /// Color model of the data format descriptor.
        model: u8,
    },
    /// The supercompression scheme is not supported, or does not suit the texel format.
    #[error("its supercompression scheme is {scheme}; write BasisLZ for ETC1S, and none, Zstandard or zlib for others")]
    Scheme {
        /// Number of the supercompression scheme.
        scheme: u32,
    },
    /// A level cannot be decompressed.
    #[error("level {level} does not decompress to {expected} bytes")]
    Inflate {
        /// Level number, 0 the finest.
        level: u32,
        /// Expected number of bytes.
        expected: u64,
    },
    /// The texels of a level cannot be transcoded.
    #[error("level {level} holds no valid texels of Basis Universal")]
    Transcode {
        /// Level number, 0 the finest.
        level: u32,
    },
    /// A metadata entry exceeds the metadata, or has no key.
    #[error("an entry of its metadata is broken")]
    Entry,
    /// The irradiance is invalid.
    #[error("its metadatum `sh` does not hold nine lines of three finite numbers")]
    Harmonics,
}

impl std::fmt::Debug for KtxError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
