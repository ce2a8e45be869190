//! Errors of reading and writing image files.

use super::kind::FileKind;
use super::ktx::error::KtxError;

/// Error of decoding or encoding an image file. The message does not name the file; the caller adds its name.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum CodecError {
    /// The input is empty.
    #[error("the file is empty")]
    NoBytes,
    /// The format is unknown.
    #[error("its image format is unknown")]
    Unknown,
    /// The format is known but not supported for this purpose or in this build.
    #[error("{0} images are not supported here")]
    Kind(FileKind),
    /// The image has no texels.
    #[error("its size is {}×{}", size_texels[0], size_texels[1])]
    Empty {
        /// Width and height.
        size_texels: [u32; 2],
    },
    /// The number of values does not match the size of the image to encode.
    #[error("a picture of {}×{} texels has {expected} values, not {given}", size_texels[0], size_texels[1])]
    Values {
        /// Width and height.
        size_texels: [u32; 2],
        /// Expected number of values.
        expected: usize,
        /// Actual number of values.
        given: usize,
    },
    /// A number in the file exceeds its limit.
    #[error("{what} is {value}, over the limit of {limit}")]
    TooLarge {
        /// Name of the number, with its unit.
        what: &'static str,
        /// Actual value.
        value: u64,
        /// Maximum value.
        limit: u64,
    },
    /// No layer of an OpenEXR file has color channels.
    #[cfg(feature = "exr")]
    #[error("it has no layer with the channels R, G and B")]
    NoColor,
    /// A Radiance file is invalid.
    #[error(transparent)]
    Hdr(#[from] HdrError),
    /// A Khronos texture is invalid, or its shape or texel format does not suit its use.
    #[error(transparent)]
    Ktx(#[from] KtxError),
    /// An error of a third-party decoder or encoder, or of the operating system.
    #[error("{0}")]
    Other(Box<dyn std::error::Error + Send + Sync>),
    /// A third-party decoder panicked with this message.
    #[error("the decoder failed: {0}")]
    Panicked(String),
}

impl std::fmt::Debug for CodecError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl CodecError {
    /// Wraps an error of another crate.
    #[cfg(any(feature = "png", feature = "jpeg", feature = "webp", feature = "exr"))]
    pub(super) fn other(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Other(Box::new(error))
    }
}

/// Error in a Radiance file.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HdrError {
    /// The signature in the first line is missing.
    #[error("it does not begin with #?RADIANCE")]
    Signature,
    /// The texel format is XYZ or unknown.
    #[error("its FORMAT is not 32-bit_rle_rgbe")]
    Format,
    /// The line with the size is invalid.
    #[error("the line with its size is not of the form `-Y 256 +X 512`")]
    Size,
    /// The file is truncated.
    #[error("it ends early")]
    CutShort,
    /// The runs of a row do not add up to its width.
    #[error("a run in row {row} reaches beyond its end")]
    Run {
        /// Row number, counted from the top.
        row: u32,
    },
}

impl std::fmt::Debug for HdrError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
