//! Why textures cannot share one block of memory here.

use wgpu::Backend;

/// Why frames that ask for [`Alias::Heap`](framegraph::Alias::Heap) get textures of the pool instead.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotPlaced {
    /// The device is not of Vulkan.
    #[error("{0} places no textures; only Vulkan does (WGPU_BACKEND=vulkan)")]
    Backend(Backend),
    /// The program was built without Vulkan.
    #[error("the program was built without Vulkan; build `framegraph-wgpu` with the feature `vulkan`")]
    NotBuilt,
    /// No kind of memory holds all of a frame's textures, or all of its buffers.
    #[error("no memory type of the driver holds all of them (types {types:#b} of bits, device-local)")]
    MemoryType {
        /// The types that all of them allow, as bits.
        types: u32,
    },
    /// The driver refused a call.
    #[error("the driver refused `{call}`: {why}")]
    Driver {
        /// The function of Vulkan.
        call: &'static str,
        /// Its result.
        why: String,
    },
    /// The sizes that the driver states did not come to rest.
    #[error("the driver states other sizes for the same textures each time it is asked")]
    Restless,
}

impl std::fmt::Debug for NotPlaced {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
