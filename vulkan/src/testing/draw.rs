//! Draws, dispatches and their bindings.

use crate::cx::{BoundBuffer, BoundImage};
use ash::vk;

/// Resource of a descriptor.
#[derive(Clone, Copy)]
pub enum Bound {
    /// A texture that is read; an input attachment if it is in the tile.
    Texture(BoundImage),
    /// A storage texture.
    Storage(BoundImage),
    /// A storage buffer.
    Buffer(BoundBuffer),
    /// A uniform buffer.
    Uniform(BoundBuffer),
}

impl Bound {
    pub(super) const fn kind(&self) -> vk::DescriptorType {
        match self {
            Self::Texture(BoundImage { input: Some(_), .. }) => vk::DescriptorType::INPUT_ATTACHMENT,
            Self::Texture(_) => vk::DescriptorType::SAMPLED_IMAGE,
            Self::Storage(_) => vk::DescriptorType::STORAGE_IMAGE,
            Self::Buffer(_) => vk::DescriptorType::STORAGE_BUFFER,
            Self::Uniform(_) => vk::DescriptorType::UNIFORM_BUFFER,
        }
    }
}

/// Depth and stencil state of a draw.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct DepthTest {
    /// Comparison with the attachment's depth.
    pub compare: vk::CompareOp,
    /// Writes depth.
    pub write: bool,
    /// Comparison of the stencil reference with the attachment; `None` disables the test.
    pub stencil: Option<vk::CompareOp>,
    /// Replaces stencil with the reference.
    pub stencil_write: bool,
    /// Stencil reference.
    pub reference: u32,
}

impl DepthTest {
    /// Tests and writes nothing.
    pub const NONE: Self =
        Self { compare: vk::CompareOp::ALWAYS, write: false, stencil: None, stencil_write: false, reference: 0 };
}

/// A draw of the entry points `vs_main` and `fs_main`.
#[derive(Clone)]
pub struct Draw<'a> {
    /// Source.
    pub wgsl: &'a str,
    /// Without a fragment stage, only depth is written.
    pub has_fragment: bool,
    /// Bindings of group 0, by number.
    pub bindings: &'a [Bound],
    /// Color slots that the shader writes, as bits.
    pub slots: u32,
    /// Depth and stencil.
    pub depth: DepthTest,
    /// Number of vertices.
    pub vertices: u32,
    /// Indirect arguments instead of `vertices`.
    pub indirect: Option<BoundBuffer>,
}

impl<'a> Draw<'a> {
    /// Draws one triangle into all color slots.
    #[must_use]
    pub const fn new(wgsl: &'a str, bindings: &'a [Bound]) -> Self {
        let (depth, indirect) = (DepthTest::NONE, None);
        Self { wgsl, has_fragment: true, bindings, slots: u32::MAX, depth, vertices: 3, indirect }
    }
}

/// A dispatch of the entry point `main`.
#[derive(Clone, Copy)]
pub struct Dispatch<'a> {
    /// Source.
    pub wgsl: &'a str,
    /// Bindings of group 0, by number.
    pub bindings: &'a [Bound],
    /// Number of workgroups.
    pub groups: [u32; 3],
    /// Indirect arguments instead of `groups`.
    pub indirect: Option<BoundBuffer>,
}
