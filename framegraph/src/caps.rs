//! Device capabilities as plain data: a graph can be compiled for any device without having it.

use crate::access::{Access, AccessKind};
use crate::format::Format;
use crate::resolve::{ResolveMode, ResolveModes};
use crate::resource::{Desc, Extent, TextureDesc};

/// Capabilities and limits of a device. Limits have the names and meanings of WebGPU.
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
    /// Maximum sum of [`Format::tile_bytes`](crate::Format::tile_bytes) over the color attachments of a step, in bytes
    /// per sample.
    pub max_color_bytes_per_sample: u32,
    /// Maximum width and height of a two-dimensional texture, in texels.
    pub max_texture_texels: u32,
    /// Maximum number of array layers of a texture.
    pub max_texture_layers: u32,
    /// Maximum size of a buffer, in bytes.
    pub max_buffer_bytes: u64,
    /// Maximum number of samples per texel that every renderable format supports: 1, 4 (WebGPU), 8 or 16.
    pub max_samples: u8,
    /// Attachments that never leave the tile can be memoryless.
    pub memoryless: bool,
    /// Attachments with several layers can be memoryless too.
    pub memoryless_layers: bool,
    /// Memoryless attachments really save memory. `false` on devices without tiles that accept the flag and allocate
    /// anyway.
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
    /// Formats that cannot be averaged while storing, in spite of `color_resolves`. Not serialized.
    #[cfg_attr(feature = "files", serde(skip))]
    pub not_averaged: Vec<Format>,
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
    /// A desktop GPU with an explicit API: no tiles, placed resources, explicit barriers.
    pub fn desktop() -> Self {
        Self {
            name: "desktop".into(),
            max_color_attachments: 8,
            max_color_bytes_per_sample: 64,
            max_texture_texels: 16384,
            max_texture_layers: 2048,
            max_buffer_bytes: 1 << 31,
            max_samples: 8,
            memoryless: false,
            memoryless_layers: false,
            memoryless_saves: false,
            merge_attachments: true,
            same_pixel: false,
            slot_mapping: true,
            inline: false,
            tile_bytes_per_pixel: 0,
            sample_read_only_depth: true,
            separate_planes: true,
            color_resolves: ResolveModes::of(&[ResolveMode::Average]),
            not_averaged: Vec::new(),
            // Supported by every Vulkan 1.2 device; the other modes are optional.
            depth_resolves: ResolveModes::of(&[ResolveMode::Sample0]),
            placed: true,
            placed_histories: true,
            padded: Vec::new(),
            separate_heaps: false,
            texture_alignment_bytes: 65536,
            buffer_alignment_bytes: 256,
            explicit_barriers: true,
            compute_queue: true,
            copy_queue: true,
            tile_heap_bytes: 0,
        }
    }

    /// A tile-based GPU with an explicit API: input attachments, memoryless attachments, placed resources.
    pub fn tiler() -> Self {
        Self {
            name: "tiler".into(),
            max_color_bytes_per_sample: 32,
            max_texture_texels: 8192,
            max_samples: 4,
            memoryless: true,
            memoryless_layers: true,
            memoryless_saves: true,
            same_pixel: true,
            tile_bytes_per_pixel: 128,
            texture_alignment_bytes: 4096,
            copy_queue: false,
            ..Self::desktop()
        }
    }

    /// The capabilities of wgpu 30 on any adapter with WebGPU's default limits.
    ///
    /// Supports merged attachments, transient attachments, shader epilogues and automatic barriers. Does not support
    /// input attachments, depth resolves and placed resources.
    pub fn wgpu() -> Self {
        Self {
            name: "wgpu".into(),
            max_color_bytes_per_sample: 32,
            max_texture_texels: 8192,
            max_texture_layers: 256,
            max_buffer_bytes: 256 << 20,
            max_samples: 4,
            memoryless: true,
            slot_mapping: false,
            inline: true,
            separate_planes: false,
            depth_resolves: ResolveModes::NONE,
            placed: false,
            explicit_barriers: false,
            compute_queue: false,
            copy_queue: false,
            ..Self::desktop()
        }
    }

    /// Returns the preset with this name: `desktop`, `tiler` or `wgpu`.
    pub fn preset(name: &str) -> Option<Self> {
        match name {
            "desktop" => Some(Self::desktop()),
            "tiler" => Some(Self::tiler()),
            "wgpu" => Some(Self::wgpu()),
            _ => None,
        }
    }

    /// Names accepted by [`Caps::preset`].
    pub const PRESETS: [&'static str; 3] = ["desktop", "tiler", "wgpu"];

    /// Returns `true` if the device performs a resolve into a texture of this format while it stores the step.
    pub fn resolves_in_store(&self, access: &Access, format: Option<Format>) -> bool {
        debug_assert_eq!(access.kind, AccessKind::Resolve);
        let modes = if access.slot == Access::DEPTH { self.depth_resolves } else { self.color_resolves };
        let apart = |format| access.resolve == ResolveMode::Average && self.not_averaged.contains(&format);
        modes.has(access.resolve) && !format.is_some_and(apart)
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
