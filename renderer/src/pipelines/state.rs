//! What a recorder says of a pipeline: shader, blending, depth test. Formats and samples of the targets come from the step
//! that is open, so one recorder serves every format and sample count.

use crate::pipelines::shader::Shader;
use std::hash::{Hash, Hasher};
use wgpu::{
    BindGroupLayout, BlendState, ColorWrites, CompareFunction, DepthBiasState, PrimitiveState, StencilFaceState,
    StencilState, VertexAttribute, VertexStepMode,
};

/// What a raster pipeline needs beside its targets.
#[derive(Clone, Debug, Hash)]
pub struct Raster<'a> {
    /// The module with the entry points.
    pub shader: Shader<'a>,
    /// Entry point of the vertex stage.
    pub vertex: &'a str,
    /// Entry point of the fragment stage; `None` draws depth alone.
    pub fragment: Option<&'a str>,
    /// Values of `override` constants by name.
    pub constants: Constants<'a>,
    /// Layouts of the bind groups; empty leaves them to the shader ([`Pipeline::group`](crate::Pipeline::group) returns them either way).
    pub groups: &'a [BindGroupLayout],
    /// Layouts of the vertex buffers.
    pub buffers: &'a [VertexBuffer<'a>],
    /// Topology, culling, front face.
    pub primitive: PrimitiveState,
    /// How depth and stencil are tested and written; by default neither.
    pub depth: Depth,
    /// Blending and masks by color slot; slots beyond the end are written without blending.
    pub colors: &'a [Output],
    /// Alpha chooses samples, where the targets are multisampled.
    pub alpha_to_coverage: bool,
}

impl<'a> Raster<'a> {
    /// Entry points `vs_main` and `fs_main`, no vertex buffers, no depth test, no blending.
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

/// Values of `override` constants, equal when they are so bit for bit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Constants<'a>(pub &'a [(&'a str, f64)]);

impl Hash for Constants<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.iter().for_each(|(name, value)| (name, value.to_bits()).hash(state));
    }
}

/// The layout of one vertex buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VertexBuffer<'a> {
    /// Bytes from one vertex or instance to the next.
    pub stride_bytes: u64,
    /// Whether the buffer advances per vertex or per instance.
    pub step: VertexStepMode,
    /// Formats, offsets and locations.
    pub attributes: &'a [VertexAttribute],
}

/// How depth and stencil are used.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Depth {
    /// A fragment passes when its depth compares so with what is stored; `GreaterEqual` for reversed depth.
    pub compare: CompareFunction,
    /// Passing fragments write their depth.
    pub write: bool,
    /// Constant and slope-scaled bias.
    pub bias: DepthBiasState,
    /// How stencil is tested and written, where the target has it.
    pub stencil: StencilState,
}

impl Depth {
    /// Neither tested nor written.
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
    /// Reversed depth: nearer or equal passes and is written.
    pub const NEARER: Self = Self { compare: CompareFunction::GreaterEqual, write: true, ..Self::NONE };
    /// Tested for equality against a prepass, not written.
    pub const EQUAL: Self = Self { compare: CompareFunction::Equal, write: false, ..Self::NONE };
}

/// How one color slot is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Output {
    /// Blending with what is there.
    pub blend: Option<BlendState>,
    /// The channels that are written.
    pub write: ColorWrites,
}

impl Output {
    /// All channels, replacing.
    pub const REPLACE: Self = Self { blend: None, write: ColorWrites::ALL };
}

/// What a compute pipeline needs.
#[derive(Clone, Copy, Debug, Hash)]
pub struct Compute<'a> {
    /// The module with the entry point.
    pub shader: Shader<'a>,
    /// The entry point.
    pub entry: &'a str,
    /// Values of `override` constants by name.
    pub constants: Constants<'a>,
    /// Layouts of the bind groups; empty leaves them to the shader.
    pub groups: &'a [BindGroupLayout],
}

impl<'a> Compute<'a> {
    /// Entry point `main`.
    pub const fn new(shader: Shader<'a>) -> Self {
        Self { shader, entry: "main", constants: Constants(&[]), groups: &[] }
    }
}
