//! What a heap holds.

use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};

/// What is placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Texture(PhysicalTextureDesc),
    Buffer(PhysicalBufferDesc),
}
