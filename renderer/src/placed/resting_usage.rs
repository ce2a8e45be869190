//! Conversion of usages to the states that wgpu tracks, and the resting usage of placed textures.

use wgpu::{BufferUsages, BufferUses, TextureFormat, TextureUsages, TextureUses};

/// Returns all states that a texture with these usages can have.
pub(crate) fn texture_uses(usage: TextureUsages, format: TextureFormat) -> TextureUses {
    let drawn = if format.is_depth_stencil_format() {
        TextureUses::DEPTH_STENCIL_READ | TextureUses::DEPTH_STENCIL_WRITE
    } else {
        TextureUses::COLOR_TARGET
    };
    let stored = TextureUses::STORAGE_READ_ONLY | TextureUses::STORAGE_WRITE_ONLY | TextureUses::STORAGE_READ_WRITE;
    [
        (TextureUsages::COPY_SRC, TextureUses::COPY_SRC),
        (TextureUsages::COPY_DST, TextureUses::COPY_DST),
        (TextureUsages::TEXTURE_BINDING, TextureUses::RESOURCE),
        (TextureUsages::STORAGE_BINDING, stored),
        (TextureUsages::RENDER_ATTACHMENT, drawn),
    ]
    .into_iter()
    .filter(|(asked, _)| usage.contains(*asked))
    .fold(TextureUses::empty(), |all, (_, uses)| all | uses)
}

/// Returns the state of a placed texture between its last step in one frame and its first step in the next. It is one
/// of the texture's usages, and usually that of its first step, which saves a transition.
pub(crate) fn resting_usage(usage: TextureUsages, format: TextureFormat) -> TextureUses {
    if usage.contains(TextureUsages::RENDER_ATTACHMENT) {
        if format.is_depth_stencil_format() { TextureUses::DEPTH_STENCIL_WRITE } else { TextureUses::COLOR_TARGET }
    } else if usage.contains(TextureUsages::STORAGE_BINDING) {
        TextureUses::STORAGE_WRITE_ONLY
    } else if usage.contains(TextureUsages::COPY_DST) {
        TextureUses::COPY_DST
    } else if usage.contains(TextureUsages::TEXTURE_BINDING) {
        TextureUses::RESOURCE
    } else {
        TextureUses::COPY_SRC
    }
}

/// Returns all states that a buffer with these usages can have.
pub(crate) fn buffer_uses(usage: BufferUsages) -> BufferUses {
    [
        (BufferUsages::COPY_SRC, BufferUses::COPY_SRC),
        (BufferUsages::COPY_DST, BufferUses::COPY_DST),
        (BufferUsages::INDEX, BufferUses::INDEX),
        (BufferUsages::VERTEX, BufferUses::VERTEX),
        (BufferUsages::UNIFORM, BufferUses::UNIFORM),
        (BufferUsages::STORAGE, BufferUses::STORAGE_READ_ONLY | BufferUses::STORAGE_READ_WRITE),
        (BufferUsages::INDIRECT, BufferUses::INDIRECT),
    ]
    .into_iter()
    .filter(|(asked, _)| usage.contains(*asked))
    .fold(BufferUses::empty(), |all, (_, uses)| all | uses)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_resting_usage_is_one_of_the_usages() {
        for format in [TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float] {
            for bits in 1..32 {
                let usage = TextureUsages::from_bits_truncate(bits);
                let (uses, resting_usage) = (texture_uses(usage, format), resting_usage(usage, format));
                assert!(uses.contains(resting_usage), "{usage:?} of {format:?}: {resting_usage:?} is none of {uses:?}");
                assert!(resting_usage.bits().is_power_of_two(), "{resting_usage:?}");
            }
        }
    }
}
