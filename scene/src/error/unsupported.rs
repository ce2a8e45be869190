//! What files may ask for and do not get.

use std::fmt;

use crate::codec::FileKind;

/// Something that a valid file asks for and that is not read. `Display` says what to do instead, where something can be
/// done.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unsupported {
    /// Another version of glTF than 2.
    GltfVersion(String),
    /// Extensions of glTF that the file requires, by name.
    Extensions(Vec<String>),
    /// A URI that is neither data nor a relative path.
    UriScheme {
        /// What has the URI: `buffer 0`.
        at: String,
        /// Its scheme: `https`.
        scheme: String,
    },
    /// A texture that is neither PNG, JPEG, WebP nor KTX2, or of a format that this build does not read.
    Image {
        /// Which one: `image 3`.
        at: String,
        /// What it is.
        kind: FileKind,
    },
    /// An environment that is neither Radiance, OpenEXR nor a Khronos texture, or of a format that this build does not
    /// read.
    Environment {
        /// What it is, if that is known.
        kind: Option<FileKind>,
    },
    /// A scene from a file, in a build without import.
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
