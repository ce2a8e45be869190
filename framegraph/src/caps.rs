//! What a device can do, as data: the same graph can be asked what it would cost elsewhere, without that device.

use crate::access::{Access, AccessKind};
use crate::format::Format;
use crate::resolve::{ResolveMode, ResolveModes};
use crate::resource::{Desc, Extent, TextureDesc};

/// A device as the compiler sees it. Limits follow WebGPU's names and meanings.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "files", serde(deny_unknown_fields))]
pub struct Caps {
    /// What to call it in reports.
    pub name: String,
    /// Color attachments of one step.
    pub max_color_attachments: u8,
    /// Sum of [`Format::tile_bytes`](crate::Format::tile_bytes) over the color attachments of one step, in bytes per sample.
    pub max_color_bytes_per_sample: u32,
    /// Width and height of a two-dimensional texture, in texels.
    pub max_texture_texels: u32,
    /// Array layers of a texture.
    pub max_texture_layers: u32,
    /// Size of a buffer, in bytes.
    pub max_buffer_bytes: u64,
    /// Samples per texel that every renderable format offers: the largest of 1, 4 (WebGPU), 8, 16.
    pub max_samples: u8,
    /// Attachments that never leave the tile can go without memory.
    pub memoryless: bool,
    /// So can attachments of several layers.
    pub memoryless_layers: bool,
    /// Memory that `memoryless` really saves: on a device without tiles the flag is accepted and saves nothing.
    pub memoryless_saves: bool,
    /// Consecutive raster passes with the same attachments can be one step.
    pub merge_attachments: bool,
    /// Same-pixel reads can stay in the tile (input attachments, framebuffer fetch).
    pub same_pixel: bool,
    /// A pass of a step can find the step's color attachments in slots of its own: attachment locations or subpasses map
    /// what its shader writes to other slots.
    pub slot_mapping: bool,
    /// Point-wise consumers can become an epilogue of the producer's shader: needs a back end that assembles shaders.
    pub inline: bool,
    /// Tile memory for the color attachments of one step, in bytes per pixel, samples included; 0 where there is no tile.
    pub tile_bytes_per_pixel: u32,
    /// A depth attachment that is only tested can be sampled in the same step.
    pub sample_read_only_depth: bool,
    /// The planes of a depth-stencil texture can be used apart in one step: one drawn, the other sampled. Counts only
    /// together with `sample_read_only_depth`, since the plane that is sampled is attached too.
    pub separate_planes: bool,
    /// How samples of colors are resolved while a step is stored; by other modes a full-screen pass resolves them.
    pub color_resolves: ResolveModes,
    /// Formats whose samples are averaged in no store all the same: no part of a file.
    #[cfg_attr(feature = "files", serde(skip))]
    pub not_averaged: Vec<Format>,
    /// How samples of depth are.
    pub depth_resolves: ResolveModes,
    /// Textures and buffers can be placed at offsets of one allocation.
    pub placed: bool,
    /// So are the images of histories; a back end that keeps them from plan to plan has them apart.
    pub placed_histories: bool,
    /// Bytes of placed textures that their driver pads, each by its shape with an absolute extent: no part of a file.
    #[cfg_attr(feature = "files", serde(skip))]
    pub padded: Vec<(TextureDesc, u64)>,
    /// Textures and buffers cannot share one heap.
    pub separate_heaps: bool,
    /// Alignment of a placed texture, in bytes; a power of two.
    pub texture_alignment_bytes: u64,
    /// Alignment of a placed buffer, in bytes; a power of two.
    pub buffer_alignment_bytes: u64,
    /// The back end needs to be told about layout transitions and hand-overs.
    pub explicit_barriers: bool,
    /// A queue for compute and copies runs beside the first.
    pub compute_queue: bool,
    /// So does one for copies.
    pub copy_queue: bool,
}

impl Caps {
    /// A desktop GPU behind an explicit API: no tiles, placed resources, explicit barriers.
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
            // What every device with Vulkan 1.2 does; the other modes are optional.
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
        }
    }

    /// A tile-based GPU behind an explicit API: input attachments, memoryless attachments, placed resources.
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

    /// What wgpu 30 offers on any adapter with WebGPU's default limits: merged attachments, transient attachments, shader
    /// epilogues, automatic barriers; no input attachments, no resolves of depth, and no placed resources.
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

    /// The preset of that name: `desktop`, `tiler` or `wgpu`.
    pub fn preset(name: &str) -> Option<Self> {
        match name {
            "desktop" => Some(Self::desktop()),
            "tiler" => Some(Self::tiler()),
            "wgpu" => Some(Self::wgpu()),
            _ => None,
        }
    }

    /// The names that [`Caps::preset`] knows.
    pub const PRESETS: [&'static str; 3] = ["desktop", "tiler", "wgpu"];

    /// Whether the device makes a resolve into a texture of that format while it stores the step.
    pub fn resolves_in_store(&self, access: &Access, format: Option<Format>) -> bool {
        debug_assert_eq!(access.kind, AccessKind::Resolve);
        let modes = if access.slot == Access::DEPTH { self.depth_resolves } else { self.color_resolves };
        let apart = |format| access.resolve == ResolveMode::Average && self.not_averaged.contains(&format);
        modes.has(access.resolve) && !format.is_some_and(apart)
    }

    /// The bytes that `desc` takes in a heap, in a frame of `frame` texels, if its texels take `bytes`.
    pub(crate) fn padded_bytes(&self, desc: &Desc, format: Option<Format>, frame: [u32; 2], bytes: u64) -> u64 {
        let Some(mut shape) = desc.texture().copied().filter(|_| !self.padded.is_empty()) else { return bytes };
        let [width, height] = shape.extent.texels(frame);
        (shape.extent, shape.format) = (Extent::Absolute { width, height }, format.unwrap_or(shape.format));
        self.padded.iter().find(|(known, _)| *known == shape).map_or(bytes, |(_, padded)| bytes.max(*padded))
    }

    /// Becomes a copy of `source`, reusing the name's memory.
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
