//! What a heap holds, and what that takes.

use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};

/// What is placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Texture(PhysicalTextureDesc),
    Buffer(PhysicalBufferDesc),
}

/// What the driver asks for an image or buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Needs {
    /// Size, padding included.
    pub(crate) bytes: u64,
    /// What its offset must be a multiple of; a power of two.
    pub(crate) alignment: u64,
    /// The kinds of memory that it may lie in, as bits.
    pub(crate) memory_types: u32,
}
