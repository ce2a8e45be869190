//! Replacement for the Vulkan driver when the feature `vulkan` is off. No resources are placed.

use crate::device::gpu::Gpu;
use crate::placed::not_placed::NotPlaced;
use crate::placed::shape::{MemoryRequirements, Shape};
use wgpu::{Buffer, CommandBuffer, Texture, TextureUses};

/// Uninhabited type: there is no driver.
#[derive(Debug)]
pub(crate) enum Driver {}

/// Uninhabited type: there are no placed textures.
#[derive(Debug)]
pub(crate) enum PlacedTexture {}

/// A placed texture or buffer.
#[derive(Debug)]
#[expect(dead_code, reason = "nothing is placed")]
pub(crate) enum Object {
    Texture(PlacedTexture),
    Buffer(Buffer),
}

impl PlacedTexture {
    pub(crate) fn texture(&self) -> &Texture {
        match *self {}
    }

    pub(crate) fn resting_usage(&self) -> TextureUses {
        match *self {}
    }
}

impl Driver {
    pub(crate) fn of(_: &Gpu) -> Result<Self, NotPlaced> {
        Err(NotPlaced::NotBuilt)
    }

    pub(crate) fn memory_requirements(&self, _: &Shape) -> Result<MemoryRequirements, NotPlaced> {
        match *self {}
    }

    pub(crate) fn place(
        &self,
        _: &[(Shape, u64, &str)],
        _: &[MemoryRequirements],
    ) -> Result<(Vec<Object>, u64), NotPlaced> {
        match *self {}
    }

    pub(crate) fn alias_barrier(&self, _: &[&PlacedTexture]) -> CommandBuffer {
        match *self {}
    }
}
