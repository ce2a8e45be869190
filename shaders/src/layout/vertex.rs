//! Vertex formats: two vertex streams, one instance stream in either of two forms, and positions in the previous frame.
//!
//! Positions have their own stream, and a second stream holds all other attributes. Shadow maps and the depth prepass
//! of opaque geometry read only positions: 12 bytes per vertex instead of 64. Tilers that bin by position save the same
//! bandwidth in the color pass. The remaining attributes are interleaved, because stages that read one of them usually
//! read most of them.

use super::ObjectAttributes;
use bytemuck::{Pod, Zeroable};
use half::f16;

/// Index of the vertex buffer with [`VertexPosition`].
pub const STREAM_POSITION: u32 = 0;
/// Index of the vertex buffer with [`VertexAttributes`].
pub const STREAM_ATTRIBUTES: u32 = 1;
/// Index of the vertex buffer with one `u32` per instance, the object's number, or with [`ObjectAttributes`].
pub const STREAM_INSTANCE: u32 = 2;
/// Index of the vertex buffer with each [`VertexPosition`] in the previous frame. The velocity pass reads it for
/// skinned and morphed meshes.
pub const STREAM_EARLIER: u32 = 3;

/// Element of the position stream.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct VertexPosition {
    /// Position in model space, in m.
    pub position: [f32; 3],
}

/// Element of the attribute stream.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct VertexAttributes {
    /// Unit normal in model space; zero if absent, and the shader uses the geometric normal.
    pub normal: [f32; 3],
    /// Unit tangent in model space, and the sign of the bitangent in w; zero if absent, and the shader derives one.
    pub tangent: [f32; 4],
    /// First set of texture coordinates, with v pointing down.
    pub uv0: [f32; 2],
    /// Second set of texture coordinates.
    pub uv1: [f32; 2],
    /// Linear color and alpha as half floats. Colors may exceed 1; below 1 the precision is one eighth of an 8-bit step
    /// or better.
    pub color: [f16; 4],
}

impl Default for VertexAttributes {
    /// Returns white with all other attributes absent. The derived tangent frame is right-handed.
    fn default() -> Self {
        Self { normal: [0.0; 3], tangent: [0.0, 0.0, 0.0, 1.0], uv0: [0.0; 2], uv1: [0.0; 2], color: [f16::ONE; 4] }
    }
}

/// Format of a vertex attribute in memory, by its name in WebGPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are WebGPU's")]
pub enum VertexFormat {
    Float32x2,
    Float32x3,
    Float32x4,
    Float16x4,
    Uint32,
}

/// Memory location of a shader input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexAttribute {
    /// Number in `@location` of the vertex stage.
    pub location: u32,
    /// Vertex buffer: [`STREAM_POSITION`], [`STREAM_ATTRIBUTES`], [`STREAM_INSTANCE`] or [`STREAM_EARLIER`].
    pub stream: u32,
    /// Offset from the start of the element, in bytes.
    pub offset_bytes: u64,
    /// Format in memory.
    pub format: VertexFormat,
}

const fn attribute(location: u32, stream: u32, offset_bytes: usize, format: VertexFormat) -> VertexAttribute {
    VertexAttribute { location, stream, offset_bytes: offset_bytes as u64, format }
}

/// Attributes by location: position, normal, tangent, uv0, uv1, color, object number, position in the previous frame.
pub const VERTEX_ATTRIBUTES: [VertexAttribute; 8] = {
    use VertexAttributes as A;
    use std::mem::offset_of;
    const REST: u32 = STREAM_ATTRIBUTES;
    [
        attribute(0, STREAM_POSITION, 0, VertexFormat::Float32x3),
        attribute(1, REST, offset_of!(A, normal), VertexFormat::Float32x3),
        attribute(2, REST, offset_of!(A, tangent), VertexFormat::Float32x4),
        attribute(3, REST, offset_of!(A, uv0), VertexFormat::Float32x2),
        attribute(4, REST, offset_of!(A, uv1), VertexFormat::Float32x2),
        attribute(5, REST, offset_of!(A, color), VertexFormat::Float16x4),
        attribute(6, STREAM_INSTANCE, 0, VertexFormat::Uint32),
        attribute(7, STREAM_EARLIER, 0, VertexFormat::Float32x3),
    ]
};

/// Contents of [`STREAM_INSTANCE`] for shaders with the feature `INSTANCE_STREAM`, in the order of
/// [`ObjectAttributes`].
pub const OBJECT_ATTRIBUTES: [VertexAttribute; 9] = {
    use ObjectAttributes as O;
    use std::mem::offset_of;
    const OWN: u32 = STREAM_INSTANCE;
    [
        attribute(8, OWN, offset_of!(O, column_x), VertexFormat::Float32x4),
        attribute(9, OWN, offset_of!(O, column_y), VertexFormat::Float32x4),
        attribute(10, OWN, offset_of!(O, column_z), VertexFormat::Float32x4),
        attribute(11, OWN, offset_of!(O, origin), VertexFormat::Float32x4),
        attribute(12, OWN, offset_of!(O, normal_column_x), VertexFormat::Float32x4),
        attribute(13, OWN, offset_of!(O, normal_column_y), VertexFormat::Float32x3),
        attribute(15, OWN, offset_of!(O, material), VertexFormat::Uint32),
        attribute(14, OWN, offset_of!(O, normal_column_z), VertexFormat::Float32x3),
        attribute(6, OWN, offset_of!(O, number), VertexFormat::Uint32),
    ]
};

/// Returns the stride of a stream in bytes.
pub const fn stream_stride_bytes(stream: u32) -> u64 {
    match stream {
        STREAM_POSITION | STREAM_EARLIER => size_of::<VertexPosition>() as u64,
        STREAM_INSTANCE => size_of::<u32>() as u64,
        _ => size_of::<VertexAttributes>() as u64,
    }
}

impl VertexFormat {
    /// Returns the number of components that a shader reads; floats of any size are read as f32.
    pub const fn components(self) -> u32 {
        match self {
            Self::Uint32 => 1,
            Self::Float32x2 => 2,
            Self::Float32x3 => 3,
            Self::Float32x4 | Self::Float16x4 => 4,
        }
    }

    /// Returns the size in memory, in bytes.
    pub const fn size_bytes(self) -> u64 {
        match self {
            Self::Uint32 => 4,
            Self::Float32x2 | Self::Float16x4 => 8,
            Self::Float32x3 => 12,
            Self::Float32x4 => 16,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_mesh_has_not_is_absent() {
        let absent = VertexAttributes::default();
        assert_eq!((absent.normal, absent.tangent), ([0.0; 3], [0.0, 0.0, 0.0, 1.0]));
        assert_eq!((absent.uv0, absent.uv1, absent.color), ([0.0; 2], [0.0; 2], [f16::ONE; 4]));
    }

    #[test]
    fn attributes_fill_their_streams_without_gap_or_overlap() {
        for stream in [STREAM_POSITION, STREAM_ATTRIBUTES, STREAM_INSTANCE, STREAM_EARLIER] {
            let mut end_bytes = 0;
            for attribute in VERTEX_ATTRIBUTES.iter().filter(|a| a.stream == stream) {
                assert_eq!(attribute.offset_bytes, end_bytes, "location {}", attribute.location);
                end_bytes += attribute.format.size_bytes();
            }
            assert_eq!(stream_stride_bytes(stream), end_bytes);
        }
        let mut end_bytes = 0;
        for attribute in OBJECT_ATTRIBUTES {
            assert_eq!(attribute.offset_bytes, end_bytes, "location {}", attribute.location);
            end_bytes += attribute.format.size_bytes();
        }
        assert_eq!(size_of::<ObjectAttributes>() as u64, end_bytes);
    }
}
