//! The stages of loading.

use std::fmt;

/// Stage of loading, for progress reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Reading files that the scene refers to.
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
    /// Decoding or generating an environment.
    Environment,
    /// Prefiltering an environment on the GPU, and integrating lookup tables.
    Lighting,
    /// Packing vertices for the GPU.
    Vertices,
    /// Copying to the GPU, including mip levels.
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
