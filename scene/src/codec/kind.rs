//! Kinds of image files, detected from their first bytes.

use std::fmt;

/// Kind of an image file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileKind {
    /// Portable Network Graphics.
    Png,
    /// JPEG.
    Jpeg,
    /// Radiance, with shared exponents.
    Hdr,
    /// OpenEXR.
    Exr,
    /// WebP.
    WebP,
    /// GIF; not supported.
    Gif,
    /// Windows bitmap; not supported.
    Bmp,
    /// TIFF; not supported.
    Tiff,
    /// DirectDraw surface; not supported.
    Dds,
    /// Khronos texture, version 1; environments only.
    Ktx1,
    /// Khronos texture, version 2; environments and textures.
    Ktx2,
}

impl FileKind {
    /// Detects the kind from the first bytes of a file.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        Some(match bytes {
            [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n', ..] => Self::Png,
            [0xff, 0xd8, 0xff, ..] => Self::Jpeg,
            [b'#', b'?', ..] => Self::Hdr,
            [0x76, 0x2f, 0x31, 0x01, ..] => Self::Exr,
            [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Self::WebP,
            [b'G', b'I', b'F', b'8', ..] => Self::Gif,
            [b'B', b'M', ..] => Self::Bmp,
            [b'I', b'I', b'*', 0, ..] | [b'M', b'M', 0, b'*', ..] => Self::Tiff,
            [b'D', b'D', b'S', b' ', ..] => Self::Dds,
            [0xab, b'K', b'T', b'X', b' ', b'1', b'1', 0xbb, b'\r', b'\n', 0x1a, b'\n', ..] => Self::Ktx1,
            [0xab, b'K', b'T', b'X', b' ', b'2', b'0', 0xbb, b'\r', b'\n', 0x1a, b'\n', ..] => Self::Ktx2,
            _ => return None,
        })
    }

    /// Returns the feature of this crate that enables this kind, if it is off in this build.
    pub(crate) fn feature(self) -> Option<&'static str> {
        match self {
            Self::Png => (!cfg!(feature = "png")).then_some("png"),
            Self::Jpeg => (!cfg!(feature = "jpeg")).then_some("jpeg"),
            Self::WebP => (!cfg!(feature = "webp")).then_some("webp"),
            Self::Ktx2 => (!cfg!(feature = "basisu")).then_some("basisu"),
            Self::Exr => (!cfg!(feature = "exr")).then_some("exr"),
            _ => None,
        }
    }
}

impl fmt::Display for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Hdr => "Radiance HDR",
            Self::Exr => "OpenEXR",
            Self::WebP => "WebP",
            Self::Gif => "GIF",
            Self::Bmp => "BMP",
            Self::Tiff => "TIFF",
            Self::Dds => "DDS",
            Self::Ktx1 => "KTX1",
            Self::Ktx2 => "KTX2",
        })
    }
}
