//! Descriptions of placed resources and their memory requirements.

use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};

/// Description of a placed texture or buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Texture(PhysicalTextureDesc),
    Buffer(PhysicalBufferDesc),
}

/// Memory requirements of an image or buffer, as reported by the driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MemoryRequirements {
    /// Size in bytes, including padding.
    pub(crate) bytes: u64,
    /// Alignment of the offset in bytes; a power of two.
    pub(crate) alignment: u64,
    /// Bit mask of the allowed memory types.
    pub(crate) memory_types: u32,
}
