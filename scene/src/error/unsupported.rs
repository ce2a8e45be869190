//! Unsupported features of files.

use std::fmt;

use crate::codec::FileKind;

/// A feature of a valid file that is not supported. `Display` suggests an alternative, if there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unsupported {
    /// A glTF version other than 2.
    GltfVersion(String),
    /// Required glTF extensions that are not supported, by name.
    Extensions(Vec<String>),
    /// A URI that is neither a data URI nor a relative path.
    UriScheme {
        /// Object with the URI: `buffer 0`.
        at: String,
        /// Scheme of the URI: `https`.
        scheme: String,
    },
    /// A texture that is not PNG, JPEG, WebP or KTX2, or whose format is disabled in this build.
    Image {
        /// Image in the file: `image 3`.
        at: String,
        /// Kind of the image file.
        kind: FileKind,
    },
    /// An environment that is not Radiance, OpenEXR or a Khronos texture, or whose format is disabled in this build.
    Environment {
        /// Kind of the file, if known.
        kind: Option<FileKind>,
    },
    /// A scene from a file, in a build without the feature `gltf`.
    Gltf,
}

impl fmt::Display for Unsupported {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let feature = |name: &str| format!("; compile framegraph-scene with its feature `{name}`");
        let of_kind = |kind: &FileKind| kind.feature().map(feature);
        match self {
            Self::GltfVersion(version) => write!(f, "glTF version {version:?} is not supported; convert the file to glTF 2.0"),
            Self::Extensions(names) => {
                let names = names.join(", ");
                write!(f, "the required extension {names} is not supported; export the file without it")
            }
            Self::UriScheme { at, scheme } => {
                write!(
                    f,
                    "the URI scheme {scheme:?} of {at} is not supported; only data URIs and relative paths are read"
                )
            }
            Self::Image { at, kind } => {
                let hint = of_kind(kind).unwrap_or_else(|| "; use PNG, JPEG, WebP or KTX2".into());
                write!(f, "{at} in {kind} format is not supported{hint}")
            }
            Self::Environment { kind } => match kind.as_ref().filter(|kind| **kind == FileKind::Exr).and_then(of_kind) {
                Some(hint) => write!(f, "an environment in OpenEXR format is not supported{hint}"),
                None => f.write_str("an environment that is neither Radiance .hdr nor OpenEXR .exr nor a cube in .ktx or .ktx2 is not supported"),
            },
            Self::Gltf => write!(f, "glTF is not supported{}", feature("gltf")),
        }
    }
}
