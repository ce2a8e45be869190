//! Bindings of a shader stage: their classes, and the limits of the device.

use crate::access::{Access, AccessKind};
use crate::caps::Caps;
use crate::compile::error::BindingClass;
use crate::graph::Tables;

/// Returns the maximum number of bindings of each class in a shader stage.
pub(super) const fn limits(caps: &Caps) -> [(BindingClass, u32); 4] {
    [
        (BindingClass::SampledTextures, caps.max_sampled_textures),
        (BindingClass::StorageTextures, caps.max_storage_textures),
        (BindingClass::StorageBuffers, caps.max_storage_buffers),
        (BindingClass::UniformBuffers, caps.max_uniform_buffers),
    ]
}

/// Returns the class of an access among the bindings of a shader.
pub(super) fn class(graph: &Tables, caps: &Caps, access: &Access) -> Option<BindingClass> {
    let texture = graph.resources[access.resource.index()].desc.texture().is_some();
    match access.kind {
        AccessKind::Sampled => Some(BindingClass::SampledTextures),
        // Otherwise it is an input attachment.
        AccessKind::SamePixel if !caps.same_pixel => Some(BindingClass::SampledTextures),
        AccessKind::StorageRead | AccessKind::StorageWrite if texture => Some(BindingClass::StorageTextures),
        AccessKind::StorageRead | AccessKind::StorageWrite => Some(BindingClass::StorageBuffers),
        AccessKind::Uniform => Some(BindingClass::UniformBuffers),
        _ => None,
    }
}

/// Returns `true` if a shader stage can bind everything that is used.
pub(super) fn fits_shader<'a>(graph: &Tables, caps: &Caps, uses: impl Iterator<Item = &'a Access> + Clone) -> bool {
    let count = |kind| uses.clone().filter(|a| class(graph, caps, a) == Some(kind)).count();
    limits(caps).into_iter().all(|(kind, max)| count(kind) <= max as usize)
}
