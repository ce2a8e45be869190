//! Pipeline descriptions of recorders: shader, blending, depth test. Formats and sample counts come from the current
//! step, so that one recorder works with all of them.

use crate::pipelines::shader::Shader;
use std::hash::{Hash, Hasher};
use wgpu::{
    BindGroupLayout, BlendState, ColorWrites, CompareFunction, DepthBiasState, PrimitiveState, StencilFaceState,
    StencilState, VertexAttribute, VertexStepMode,
};

/// Description of a render pipeline, without its targets.
#[derive(Clone, Debug, Hash)]
pub struct Raster<'a> {
    /// Module with the entry points.
    pub shader: Shader<'a>,
    /// Entry point of the vertex stage.
    pub vertex: &'a str,
    /// Entry point of the fragment stage; `None` for depth-only passes.
    pub fragment: Option<&'a str>,
    /// Values of `override` constants.
    pub constants: Constants<'a>,
    /// Layouts of the bind groups. If empty, they are derived from the shader
    /// ([`Pipeline::group`](crate::Pipeline::group)).
    pub groups: &'a [BindGroupLayout],
    /// Layouts of the vertex buffers.
    pub buffers: &'a [VertexBuffer<'a>],
    /// Topology, culling and front face.
    pub primitive: PrimitiveState,
    /// Depth and stencil state; off by default.
    pub depth: Depth,
    /// Blending and write masks by color slot. Missing slots are written without blending.
    pub colors: &'a [Output],
    /// Converts alpha to a coverage mask, if the targets are multisampled.
    pub alpha_to_coverage: bool,
}

impl<'a> Raster<'a> {
    /// Creates a description with the entry points `vs_main` and `fs_main`, without vertex buffers, depth test and
    /// blending.
    pub const fn new(shader: Shader<'a>) -> Self {
        Self {
            shader,
            vertex: "vs_main",
            fragment: Some("fs_main"),
            constants: Constants(&[]),
            groups: &[],
            buffers: &[],
            primitive: PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleList,
                strip_index_format: None,
                front_face: wgpu::FrontFace::Ccw,
                cull_mode: None,
                unclipped_depth: false,
                polygon_mode: wgpu::PolygonMode::Fill,
                conservative: false,
            },
            depth: Depth::NONE,
            colors: &[],
            alpha_to_coverage: false,
        }
    }
}

/// Values of `override` constants, compared bit for bit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Constants<'a>(pub &'a [(&'a str, f64)]);

impl Hash for Constants<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.iter().for_each(|(name, value)| (name, value.to_bits()).hash(state));
    }
}

/// Layout of a vertex buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VertexBuffer<'a> {
    /// Distance between two vertices or instances, in bytes.
    pub stride_bytes: u64,
    /// Step mode: per vertex or per instance.
    pub step: VertexStepMode,
    /// Formats, offsets and shader locations.
    pub attributes: &'a [VertexAttribute],
}

/// Depth and stencil state.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Depth {
    /// Depth comparison with the stored value. `GreaterEqual` passes nearer fragments with reversed depth.
    pub compare: CompareFunction,
    /// True if passing fragments write their depth.
    pub write: bool,
    /// Constant and slope-scaled bias.
    pub bias: DepthBiasState,
    /// Stencil state, for targets with stencil.
    pub stencil: StencilState,
}

impl Depth {
    /// No depth test and no depth writes.
    pub const NONE: Self = Self {
        compare: CompareFunction::Always,
        write: false,
        bias: DepthBiasState { constant: 0, slope_scale: 0.0, clamp: 0.0 },
        stencil: StencilState {
            front: StencilFaceState::IGNORE,
            back: StencilFaceState::IGNORE,
            read_mask: 0,
            write_mask: 0,
        },
    };
    /// Depth test and depth writes for reversed depth: nearer or equal fragments pass.
    pub const NEARER: Self = Self { compare: CompareFunction::GreaterEqual, write: true, ..Self::NONE };
    /// Depth test for equality after a depth prepass, without depth writes.
    pub const EQUAL: Self = Self { compare: CompareFunction::Equal, write: false, ..Self::NONE };
}

/// Blending and write mask of one color slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Output {
    /// Blend state; `None` replaces the color.
    pub blend: Option<BlendState>,
    /// Channels to write.
    pub write: ColorWrites,
}

impl Output {
    /// Writes all channels without blending.
    pub const REPLACE: Self = Self { blend: None, write: ColorWrites::ALL };
}

/// Description of a compute pipeline.
#[derive(Clone, Copy, Debug, Hash)]
pub struct Compute<'a> {
    /// Module with the entry point.
    pub shader: Shader<'a>,
    /// Entry point of the compute stage.
    pub entry: &'a str,
    /// Values of `override` constants.
    pub constants: Constants<'a>,
    /// Layouts of the bind groups. If empty, they are derived from the shader.
    pub groups: &'a [BindGroupLayout],
}

impl<'a> Compute<'a> {
    /// Creates a description with the entry point `main`.
    pub const fn new(shader: Shader<'a>) -> Self {
        Self { shader, entry: "main", constants: Constants(&[]), groups: &[] }
    }
}
