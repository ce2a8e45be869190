//! Device capabilities as plain data: a graph can be compiled for any device without having it.

mod format_caps;
mod presets;

use crate::access::{Access, AccessKind};
use crate::format::Format;
use crate::resolve::{ResolveMode, ResolveModes};
use crate::resource::{Desc, Extent, TextureDesc};
pub use format_caps::{FormatCaps, FormatTable};

/// Capabilities and limits of a device: a plan for a device contains nothing that the device refuses.
///
/// Limits have the meanings of WebGPU. Uses of formats are those of `formats`, limits start with `max_`, and the other
/// fields are rules.
///
/// ```
/// use framegraph::Caps;
///
/// let caps = Caps { tile_bytes_per_pixel: 64, ..Caps::tiler() };
/// assert!(caps.memoryless && caps.same_pixel);
/// assert_eq!(Caps::preset("wgpu"), Some(Caps::wgpu()));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "files", serde(deny_unknown_fields))]
pub struct Caps {
    /// Name of the device in reports.
    pub name: String,
    /// Maximum number of color attachments of a step.
    pub max_color_attachments: u8,
    /// Maximum size of the color attachments of a step, in bytes per sample: the sum of
    /// [`Format::tile_bytes`](crate::Format::tile_bytes) in the order of the slots, each aligned to its component.
    pub max_color_bytes_per_sample: u32,
    /// Maximum number of layers that a pass attaches at once. 1 without multiview.
    pub max_attached_layers: u32,
    /// Maximum width and height of a two-dimensional texture, in texels.
    pub max_texture_texels: u32,
    /// Maximum width, height and depth of a three-dimensional texture, in texels.
    pub max_volume_texels: u32,
    /// Maximum number of array layers of a texture.
    pub max_texture_layers: u32,
    /// Maximum size of a buffer, in bytes.
    pub max_buffer_bytes: u64,
    /// Maximum number of samples per texel: 1, 2, 4, 8 or 16. Each format also has its own set in `formats`.
    pub max_samples: u8,
    /// Maximum number of textures that a shader stage samples. A raster pass has two stages: vertex and fragment.
    pub max_sampled_textures: u32,
    /// Maximum number of samplers of a shader stage. Not checked, because graphs declare no samplers.
    pub max_samplers: u32,
    /// Maximum number of storage textures of a shader stage. A raster pass writes them in one stage.
    pub max_storage_textures: u32,
    /// Maximum number of storage buffers of a shader stage. A raster pass writes them in one stage.
    pub max_storage_buffers: u32,
    /// Maximum number of uniform buffers of a shader stage.
    pub max_uniform_buffers: u32,
    /// Maximum size of a uniform binding, in bytes.
    pub max_uniform_bytes: u64,
    /// Maximum size of a storage binding, in bytes.
    pub max_storage_bytes: u64,
    /// Alignment of the offset of a uniform binding, in bytes; a power of two.
    pub uniform_alignment_bytes: u64,
    /// Alignment of the offset of a storage binding, in bytes; a power of two.
    pub storage_alignment_bytes: u64,
    /// Uses and sample counts of each format.
    pub formats: FormatTable,
    /// A texture can be viewed in the sRGB twin of its format.
    pub srgb_views: bool,
    /// A memoryless texture can be viewed in the sRGB twin of its format.
    pub memoryless_views: bool,
    /// Multisampled textures can have several layers.
    pub multisampled_arrays: bool,
    /// Multisampled textures can be used as storage.
    pub multisampled_storage: bool,
    /// Width and height of a block-compressed texture need not be multiples of the block.
    pub partial_blocks: bool,
    /// Raster passes can write storage textures and buffers.
    pub raster_storage: bool,
    /// A raster pass needs no attachment.
    pub empty_raster: bool,
    /// Textures can be cleared to zero outside of a render pass. Otherwise their format must be renderable.
    pub clears_to_zero: bool,
    /// Textures can be cleared to any value outside of a render pass. Otherwise their format must be renderable.
    pub clears_to_value: bool,
    /// Attachments that never leave the tile can be memoryless.
    pub memoryless: bool,
    /// Attachments with several layers can be memoryless too.
    pub memoryless_layers: bool,
    /// Memoryless attachments really save memory. `false` on devices without tiles that accept the flag and allocate
    /// anyway; attachments are then placed in the heap with [`Alias::Heap`](crate::Alias::Heap).
    pub memoryless_saves: bool,
    /// Consecutive raster passes with the same attachments can be merged into one step.
    pub merge_attachments: bool,
    /// Same-pixel reads can stay in the tile (input attachments, framebuffer fetch).
    pub same_pixel: bool,
    /// Each pass of a step can map its color slots to other attachments of the step: subpasses, or Vulkan's attachment
    /// locations.
    pub slot_mapping: bool,
    /// A point-wise pass can become an epilogue of its producer's shader. Requires a back end that assembles shaders.
    pub inline: bool,
    /// Tile memory for the color attachments of a step, in bytes per pixel including all samples; 0 for a device
    /// without tiles.
    pub tile_bytes_per_pixel: u32,
    /// A read-only depth attachment can be sampled in the same step.
    pub sample_read_only_depth: bool,
    /// One plane of a depth-stencil texture can be written while the other is sampled. Requires
    /// `sample_read_only_depth`, because the sampled plane is attached too.
    pub separate_planes: bool,
    /// Modes of color resolves that the device performs while it stores a step. Other modes need a full-screen pass.
    pub color_resolves: ResolveModes,
    /// Modes of depth resolves that the device performs while it stores a step. Other modes need a full-screen pass.
    pub depth_resolves: ResolveModes,
    /// Textures and buffers can be placed at offsets of one allocation.
    pub placed: bool,
    /// History images can be placed too. `false` for a back end that keeps them in separate allocations from frame to
    /// frame.
    pub placed_histories: bool,
    /// Allocation size in bytes of textures that the driver pads, by descriptor with an absolute extent. Not
    /// serialized.
    #[cfg_attr(feature = "files", serde(skip))]
    pub padded: Vec<(TextureDesc, u64)>,
    /// Textures and buffers need separate heaps.
    pub separate_heaps: bool,
    /// Alignment of a placed texture, in bytes; a power of two.
    pub texture_alignment_bytes: u64,
    /// Alignment of a placed buffer, in bytes; a power of two.
    pub buffer_alignment_bytes: u64,
    /// The back end needs explicit layout transitions and aliasing barriers.
    pub explicit_barriers: bool,
    /// The device has a separate queue for compute and copies.
    pub compute_queue: bool,
    /// The device has a separate queue for copies.
    pub copy_queue: bool,
    /// Size in bytes of on-chip memory that keeps its contents from step to step (`VK_QCOM_tile_memory_heap`); 0 for
    /// none. [`Plan::tile_heap`](crate::Plan::tile_heap) chooses the textures to keep there.
    #[cfg_attr(feature = "files", serde(default))]
    pub tile_heap_bytes: u64,
}

impl Caps {
    /// Returns `true` if the device performs a resolve into a texture of this format while it stores the step.
    pub fn resolves_in_store(&self, access: &Access, format: Option<Format>) -> bool {
        debug_assert_eq!(access.kind, AccessKind::Resolve);
        let modes = if access.slot == Access::DEPTH { self.depth_resolves } else { self.color_resolves };
        let apart = |format| access.resolve == ResolveMode::Average && !self.averages(format);
        modes.has(access.resolve) && !format.is_some_and(apart)
    }

    /// Returns a format with the same kind of values that supports `uses`, preferring the smallest of at least the same
    /// size. `None` if there is none.
    pub fn similar_format(&self, format: Format, uses: FormatCaps) -> Option<Format> {
        let fits = |other: &Format| {
            self.formats.get(*other).contains(uses)
                && other.numeric() == format.numeric()
                && other.is_compressed() == format.is_compressed()
                && other.has_stencil() == format.has_stencil()
                && (format.is_depth_stencil() || other.channels() >= format.channels())
                && other.block_bytes() >= format.block_bytes()
        };
        let cost = |other: &Format| {
            let differs = other.is_normalized() != format.is_normalized();
            (differs, other.is_srgb() != format.is_srgb(), other.block_bytes())
        };
        Format::ALL.into_iter().filter(fits).min_by_key(cost)
    }

    /// Returns `true` if the device averages samples of this format while it stores a step, where `color_resolves`
    /// contains [`ResolveMode::Average`].
    pub const fn averages(&self, format: Format) -> bool {
        self.formats.get(format).contains(FormatCaps::RESOLVABLE)
    }

    /// Returns the allocation size of `desc` in a heap, for a resource with `bytes` bytes of texels.
    pub(crate) fn padded_bytes(&self, desc: &Desc, format: Option<Format>, frame: [u32; 2], bytes: u64) -> u64 {
        let Some(mut shape) = desc.texture().copied().filter(|_| !self.padded.is_empty()) else { return bytes };
        let [width, height] = shape.extent.texels(frame);
        (shape.extent, shape.format) = (Extent::Absolute { width, height }, format.unwrap_or(shape.format));
        self.padded.iter().find(|(known, _)| *known == shape).map_or(bytes, |(_, padded)| bytes.max(*padded))
    }

    /// Overwrites `self` with `source` and reuses the memory of the name.
    pub(crate) fn copy_from(&mut self, source: &Self) {
        if self != source {
            self.clone_from(source);
        }
    }
}

impl Default for Caps {
    fn default() -> Self {
        Self::wgpu()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_found_by_name() {
        for name in Caps::PRESETS {
            assert_eq!(Caps::preset(name).map(|c| c.name), Some(name.to_owned()));
        }
        assert_eq!(Caps::preset("toaster"), None);
    }

    #[test]
    fn a_copy_is_equal() {
        let mut copy = Caps::tiler();
        copy.copy_from(&Caps::desktop());
        assert_eq!(copy, Caps::desktop());
    }
}
