//! Why a picture file cannot be read or written.

use super::kind::FileKind;
use super::ktx::error::KtxError;

/// Why a picture file cannot be decoded or encoded. The messages name no file: whoever reports one knows it.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum CodecError {
    /// There are no bytes.
    #[error("the file is empty")]
    NoBytes,
    /// The bytes begin like no format that is known.
    #[error("it is no picture of a known format")]
    Unknown,
    /// The format is known, but not read for this purpose, or not by this build of the crate.
    #[error("{0} pictures are not read here")]
    Kind(FileKind),
    /// The picture has no texels.
    #[error("its size is {}×{}", size_texels[0], size_texels[1])]
    Empty {
        /// Width and height.
        size_texels: [u32; 2],
    },
    /// There are more or fewer values than the size of a picture to encode asks for.
    #[error("a picture of {}×{} texels has {expected} values, not {given}", size_texels[0], size_texels[1])]
    Values {
        /// Width and height.
        size_texels: [u32; 2],
        /// Values that there should be.
        expected: usize,
        /// Values that there are.
        given: usize,
    },
    /// A number in the file is larger than what is accepted.
    #[error("{what} is {value}, over the limit of {limit}")]
    TooLarge {
        /// Which number, with its unit.
        what: &'static str,
        /// What it is.
        value: u64,
        /// What it may be.
        limit: u64,
    },
    /// An OpenEXR file has no layer that is a picture.
    #[cfg(feature = "exr")]
    #[error("it has no layer with the channels R, G and B")]
    NoColor,
    /// A Radiance file breaks its format's rules.
    #[error(transparent)]
    Hdr(#[from] HdrError),
    /// A Khronos texture breaks its format's rules, or has another shape or other texels than its use asks for.
    #[error(transparent)]
    Ktx(#[from] KtxError),
    /// An error of the decoder or encoder of another crate, or of the operating system.
    #[error("{0}")]
    Other(Box<dyn std::error::Error + Send + Sync>),
    /// The decoder of another crate panicked, with this message.
    #[error("the decoder failed: {0}")]
    Panicked(String),
}

impl std::fmt::Debug for CodecError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl CodecError {
    /// An error of another crate.
    #[cfg(any(feature = "png", feature = "jpeg", feature = "webp", feature = "exr"))]
    pub(super) fn other(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Other(Box::new(error))
    }
}

/// What a Radiance file gets wrong.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HdrError {
    /// The first line is another.
    #[error("it does not begin with #?RADIANCE")]
    Signature,
    /// The texels are XYZ, or something unknown.
    #[error("its FORMAT is not 32-bit_rle_rgbe")]
    Format,
    /// The line with the size does not parse.
    #[error("the line with its size is not of the form `-Y 256 +X 512`")]
    Size,
    /// The file ends too soon.
    #[error("it ends early")]
    CutShort,
    /// Runs of a row do not add up to the width.
    #[error("a run in row {row} reaches beyond its end")]
    Run {
        /// The row, from the top.
        row: u32,
    },
}

impl std::fmt::Debug for HdrError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
