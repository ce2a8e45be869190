//! Vertex streams of pipelines, and both forms of the instance stream.

use framegraph_shaders::layout::{
    OBJECT_ATTRIBUTES, ObjectAttributes, STREAM_ATTRIBUTES, STREAM_EARLIER, STREAM_INSTANCE, STREAM_POSITION,
    VERTEX_ATTRIBUTES, VertexFormat, stream_stride_bytes,
};
use framegraph_wgpu::VertexBuffer;
use wgpu::{Buffer, VertexAttribute, VertexStepMode};

/// Instance stream; batches are ranges of it.
#[derive(Clone, Copy, Debug)]
pub enum Instances<'a> {
    /// Vertex buffer of `layout::ObjectAttributes`; shaders need no other data of instances.
    Stream(&'a Buffer),
    /// Instance numbers, which index other buffers.
    Numbers {
        /// Vertex buffer of instance numbers.
        numbers: &'a Buffer,
        /// `layout::ObjectUniforms` by instance number.
        objects: &'a Buffer,
        /// Reference points of objects relative to the eye.
        origins: &'a Buffer,
    },
}

impl<'a> Instances<'a> {
    /// Returns the vertex buffer.
    pub(crate) const fn buffer(self) -> &'a Buffer {
        match self {
            Self::Stream(buffer) | Self::Numbers { numbers: buffer, .. } => buffer,
        }
    }
}

/// Returns the attributes of each stream. `streamed` is true if the instance stream contains the objects.
pub(crate) fn stream_attributes(streamed: bool) -> [Vec<VertexAttribute>; 4] {
    [STREAM_POSITION, STREAM_ATTRIBUTES, STREAM_INSTANCE, STREAM_EARLIER].map(|stream| {
        let all: &[_] = if streamed && stream == STREAM_INSTANCE { &OBJECT_ATTRIBUTES } else { &VERTEX_ATTRIBUTES };
        let own = all.iter().filter(|a| a.stream == stream);
        own.map(|a| VertexAttribute {
            format: vertex_format(a.format),
            offset: a.offset_bytes,
            shader_location: a.location,
        })
        .collect()
    })
}

/// Returns the streams with these attributes.
pub(crate) fn vertex_buffers(attributes: &[Vec<VertexAttribute>; 4], streamed: bool) -> Vec<VertexBuffer<'_>> {
    let buffer = |(stream, attributes)| VertexBuffer {
        stride_bytes: match stream {
            STREAM_INSTANCE if streamed => size_of::<ObjectAttributes>() as u64,
            stream => stream_stride_bytes(stream),
        },
        step: if stream == STREAM_INSTANCE { VertexStepMode::Instance } else { VertexStepMode::Vertex },
        attributes,
    };
    (0..).zip(attributes.iter().map(Vec::as_slice)).map(buffer).collect()
}

const fn vertex_format(format: VertexFormat) -> wgpu::VertexFormat {
    match format {
        VertexFormat::Float32x2 => wgpu::VertexFormat::Float32x2,
        VertexFormat::Float32x3 => wgpu::VertexFormat::Float32x3,
        VertexFormat::Float32x4 => wgpu::VertexFormat::Float32x4,
        VertexFormat::Float16x4 => wgpu::VertexFormat::Float16x4,
        VertexFormat::Uint32 => wgpu::VertexFormat::Uint32,
    }
}
