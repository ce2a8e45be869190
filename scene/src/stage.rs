//! The stages of loading.

use std::fmt;

/// A stage of loading, as progress reports name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Reading files named by the scene.
    Files,
    /// Decompressing geometry: buffer views and Draco meshes.
    Decompression,
    /// Reading the headers of images.
    Headers,
    /// Decoding images.
    Images,
    /// Building vertex streams, normals and tangents.
    Geometry,
    /// Making levels of detail.
    Levels,
    /// Decoding or evaluating an environment.
    Environment,
    /// Filtering an environment on the GPU, and integrating the tables that go with it.
    Lighting,
    /// Packing vertices for the GPU.
    Vertices,
    /// Copying to the GPU, mip levels included.
    Upload,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Files => "reading files",
            Self::Decompression => "decompressing geometry",
            Self::Headers => "reading headers of images",
            Self::Images => "decoding images",
            Self::Geometry => "building geometry",
            Self::Levels => "making levels of detail",
            Self::Environment => "preparing the environment",
            Self::Lighting => "filtering the environment",
            Self::Vertices => "packing vertices",
            Self::Upload => "uploading",
        })
    }
}
