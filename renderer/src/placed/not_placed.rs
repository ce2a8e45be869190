//! Reasons why textures cannot share a block of memory.

use wgpu::Backend;

/// Reason why [`Alias::Heap`](framegraph::Alias::Heap) is not available, so that pooled textures are used instead.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotPlaced {
    /// The device does not use Vulkan.
    #[error("{0} does not support placed textures; use Vulkan (WGPU_BACKEND=vulkan)")]
    Backend(Backend),
    /// The program was built without Vulkan.
    #[error("the program was built without Vulkan; build `framegraph-wgpu` with the feature `vulkan`")]
    NotBuilt,
    /// No memory type can hold all textures, or all buffers, of a frame.
    #[error("no device-local memory type of the driver can hold all of them (allowed types: {types:#b})")]
    MemoryType {
        /// Bit mask of the memory types that all of them allow.
        types: u32,
    },
    /// The driver rejected a call.
    #[error("the driver rejected `{call}`: {why}")]
    Driver {
        /// Vulkan function.
        call: &'static str,
        /// Vulkan result.
        why: String,
    },
    /// The driver reported different sizes for the same textures.
    #[error("the driver reports different sizes for the same textures")]
    UnstableSizes,
}

impl std::fmt::Debug for NotPlaced {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
