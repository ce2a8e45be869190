//! Rust mirrors of the structs and vertices that the shaders read.
//!
//! Each struct is `#[repr(C)]` with explicit padding and can be written to a buffer as bytes.
//! `tests/` compares name, size and every member's offset with naga's layout of the WGSL
//! struct, and fails when either side has a struct or member without a partner. Members are
//! documented here in brief and in the WGSL in full.
//!
//! All of them are [`Zeroable`](bytemuck::Zeroable); constructors that can be got wrong (the
//! normal matrix, spot cones, texture transforms) are functions here, so that renderers do
//! not each do them anew.

mod frame;
mod grading;
mod ibl;
mod light;
mod material;
mod object;
mod post;
mod sky;
mod vertex;

pub use frame::{FrameUniforms, ShadowViewUniforms};
pub use grading::{Grading, GradingUniforms};
pub use ibl::{IBL_KERNEL_ROWS, IblKernelUniforms, IblUniforms};
pub use light::{LightError, LightUniforms, Punctual};
pub use material::{
    AnisotropyUniforms, ClearCoatUniforms, MATERIAL_DOUBLE_SIDED, MATERIAL_UNLIT, MaterialUniforms, SheenUniforms,
    SpecularUniforms, TextureMap, TransmissionUniforms,
};
pub use object::ObjectUniforms;
pub use post::{EncodingUniforms, ExposureUniforms, FxaaUniforms, ToneMap, VignetteUniforms};
pub use sky::SkyUniforms;
pub use vertex::{
    STREAM_ATTRIBUTES, STREAM_POSITION, VERTEX_ATTRIBUTES, VertexAttribute, VertexAttributes, VertexFormat,
    VertexPosition, stream_stride_bytes,
};
