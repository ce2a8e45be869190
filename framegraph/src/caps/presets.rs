//! Devices by name: WebGPU's baseline, a desktop GPU, and published limits of tile-based GPUs.

use super::{Caps, FormatCaps, FormatTable};
use crate::format::Format;
use crate::resolve::{ResolveMode, ResolveModes};

impl Caps {
    /// A desktop GPU with an explicit API: no tiles, placed resources, explicit barriers.
    ///
    /// Limits of bindings are those of the Vulkan Roadmap 2022 profile. Uses of formats are those that GPUs of AMD,
    /// Intel and NVIDIA have in common.
    pub fn desktop() -> Self {
        Self {
            name: "desktop".into(),
            max_color_attachments: 8,
            max_color_bytes_per_sample: 64,
            max_attached_layers: 2048,
            max_texture_texels: 16384,
            max_volume_texels: 2048,
            max_texture_layers: 2048,
            max_buffer_bytes: 1 << 31,
            max_samples: 8,
            max_sampled_textures: 200,
            max_samplers: 64,
            max_storage_textures: 16,
            max_storage_buffers: 30,
            max_uniform_buffers: 15,
            max_uniform_bytes: 64 << 10,
            max_storage_bytes: 1 << 31,
            uniform_alignment_bytes: 256,
            storage_alignment_bytes: 64,
            formats: FormatTable::desktop(),
            srgb_views: true,
            memoryless_views: true,
            multisampled_arrays: true,
            multisampled_storage: true,
            partial_blocks: true,
            raster_storage: true,
            empty_raster: true,
            clears_to_zero: true,
            clears_to_value: true,
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
            formats: FormatTable::tiler(),
            multisampled_storage: false,
            memoryless: true,
            memoryless_layers: true,
            memoryless_saves: true,
            same_pixel: true,
            tile_bytes_per_pixel: 128,
            texture_alignment_bytes: 4096,
            copy_queue: false,
            tile_heap_bytes: 0,
            ..Self::desktop()
        }
    }

    /// A Mali GPU of Arm's Valhall generation under Vulkan: 256 bits of color per pixel in the tile buffer.
    ///
    /// Source: Arm GPU Best Practices ("Render passes", "Multisampling"), and limits that Mali-G710 drivers report.
    pub fn mali() -> Self {
        Self {
            name: "mali".into(),
            tile_bytes_per_pixel: 32,
            max_volume_texels: 4096,
            max_attached_layers: 8,
            max_uniform_buffers: 36,
            max_storage_buffers: 35,
            max_uniform_bytes: 64 << 10,
            max_storage_bytes: 1 << 28,
            uniform_alignment_bytes: 16,
            storage_alignment_bytes: 64,
            ..Self::tiler()
        }
    }

    /// An Adreno GPU of the 6xx series under Vulkan: bins share the GMEM, so attachments have no size limit per pixel.
    ///
    /// Source: Qualcomm's Adreno GPU guide ("Tile-based rendering"), and limits that Adreno 660 drivers report.
    pub fn adreno() -> Self {
        Self {
            name: "adreno".into(),
            max_color_bytes_per_sample: 64,
            tile_bytes_per_pixel: 0,
            max_texture_texels: 16384,
            max_attached_layers: 6,
            max_uniform_buffers: 36,
            max_storage_buffers: 24,
            max_storage_bytes: 1 << 27,
            uniform_alignment_bytes: 64,
            storage_alignment_bytes: 64,
            ..Self::tiler()
        }
    }

    /// An Apple GPU of family 4 or later under Metal: 512 bits of color per pixel in tile memory.
    ///
    /// Source: Metal Feature Set Tables (families Apple4 to Apple8).
    pub fn apple() -> Self {
        Self {
            name: "apple".into(),
            max_color_bytes_per_sample: 64,
            tile_bytes_per_pixel: 64,
            max_texture_texels: 16384,
            max_attached_layers: 2048,
            max_buffer_bytes: 1 << 30,
            max_sampled_textures: 96,
            max_samplers: 16,
            max_storage_textures: 8,
            max_storage_buffers: 16,
            max_uniform_buffers: 14,
            max_storage_bytes: 1 << 30,
            uniform_alignment_bytes: 4,
            storage_alignment_bytes: 4,
            separate_planes: false,
            depth_resolves: ResolveModes::of(&[ResolveMode::Sample0, ResolveMode::Min, ResolveMode::Max]),
            ..Self::tiler()
        }
    }

    /// The capabilities of wgpu 30 on any adapter with WebGPU's default limits and no optional feature.
    ///
    /// Supports merged attachments, transient attachments, shader epilogues and automatic barriers. Does not support
    /// input attachments, depth resolves and placed resources.
    pub fn wgpu() -> Self {
        Self {
            name: "wgpu".into(),
            max_color_bytes_per_sample: 32,
            max_attached_layers: 1,
            max_texture_texels: 8192,
            max_texture_layers: 256,
            max_buffer_bytes: 256 << 20,
            max_samples: 4,
            max_sampled_textures: 16,
            max_samplers: 16,
            max_storage_textures: 4,
            max_storage_buffers: 8,
            max_uniform_buffers: 12,
            max_storage_bytes: 128 << 20,
            storage_alignment_bytes: 256,
            formats: FormatTable::webgpu(),
            memoryless_views: false,
            multisampled_arrays: false,
            multisampled_storage: false,
            partial_blocks: false,
            empty_raster: false,
            clears_to_zero: false,
            clears_to_value: false,
            memoryless: true,
            slot_mapping: false,
            inline: true,
            separate_planes: false,
            depth_resolves: ResolveModes::NONE,
            placed: false,
            explicit_barriers: false,
            compute_queue: false,
            copy_queue: false,
            tile_heap_bytes: 0,
            ..Self::desktop()
        }
    }

    /// The capabilities of wgpu 30 on a desktop GPU with all its optional features: formats of the adapter, several
    /// attached layers, clears outside of render passes, and larger limits.
    ///
    /// A back end reports the capabilities of a real adapter; this preset is for plans without one.
    pub fn wgpu_native() -> Self {
        let desktop = Self::desktop();
        Self {
            name: "wgpu-native".into(),
            max_attached_layers: 6,
            max_texture_texels: desktop.max_texture_texels,
            max_texture_layers: desktop.max_texture_layers,
            max_samples: desktop.max_samples,
            max_sampled_textures: desktop.max_sampled_textures,
            max_samplers: desktop.max_samplers,
            max_storage_textures: desktop.max_storage_textures,
            max_storage_buffers: desktop.max_storage_buffers,
            max_uniform_buffers: desktop.max_uniform_buffers,
            storage_alignment_bytes: desktop.storage_alignment_bytes,
            formats: desktop.formats,
            clears_to_zero: true,
            ..Self::wgpu()
        }
    }

    /// Returns the preset with this name, one of [`Caps::PRESETS`].
    pub fn preset(name: &str) -> Option<Self> {
        match name {
            "desktop" => Some(Self::desktop()),
            "tiler" => Some(Self::tiler()),
            "mali" => Some(Self::mali()),
            "adreno" => Some(Self::adreno()),
            "apple" => Some(Self::apple()),
            "wgpu" => Some(Self::wgpu()),
            "wgpu-native" => Some(Self::wgpu_native()),
            _ => None,
        }
    }

    /// Names accepted by [`Caps::preset`].
    pub const PRESETS: [&'static str; 7] = ["desktop", "tiler", "mali", "adreno", "apple", "wgpu", "wgpu-native"];
}

impl FormatTable {
    /// WebGPU's table of guaranteed formats, with the storage access of wgpu 30 and without optional features.
    pub fn webgpu() -> Self {
        Self::of(webgpu)
    }

    /// Formats of desktop GPUs: BC compression, 2 to 8 samples, storage of all color formats without sRGB.
    pub fn desktop() -> Self {
        Self::of(desktop)
    }

    /// Formats of mobile GPUs: ETC2 and ASTC compression, 2 or 4 samples.
    pub fn tiler() -> Self {
        Self::of(|format| match format.is_compressed() {
            true if is_bc(format) => FormatCaps::NONE,
            true => BASIC.union(FormatCaps::FILTERABLE),
            false => desktop(format).without(FormatCaps::SAMPLES_8),
        })
    }

    fn of(uses: impl Fn(Format) -> FormatCaps) -> Self {
        Format::ALL.into_iter().fold(Self::NONE, |table, format| table.with(format, uses(format)))
    }
}

/// Sampling and copies.
const BASIC: FormatCaps = FormatCaps::SAMPLED.union(FormatCaps::COPY_SOURCE).union(FormatCaps::COPY_TARGET);
/// A color format that is sampled, copied and three-dimensional.
const COLOR: FormatCaps = BASIC.union(FormatCaps::VOLUME);
/// Attachments with 1 or 4 samples.
const MSAA: FormatCaps = FormatCaps::RENDERABLE.union(FormatCaps::SAMPLES_4);
const STORAGE: FormatCaps = FormatCaps::STORAGE_READ.union(FormatCaps::STORAGE_WRITE);

/// Returns the guaranteed uses of WebGPU, as wgpu 30 lists them in `TextureFormat::guaranteed_format_features`.
fn webgpu(format: Format) -> FormatCaps {
    use Format::*;
    let smooth = FormatCaps::FILTERABLE.union(FormatCaps::BLENDABLE);
    let averaged = MSAA.union(FormatCaps::RESOLVABLE);
    match format {
        R8Unorm | Rg8Unorm | R16Float | Rg16Float | Rgba8UnormSrgb | Bgra8Unorm | Bgra8UnormSrgb | Rgb10a2Unorm => {
            COLOR.union(averaged).union(smooth)
        }
        Rgba8Unorm | Rgba16Float => COLOR.union(averaged).union(smooth).union(STORAGE),
        // Drawing into Rg11b10Ufloat is optional.
        R8Snorm | Rg8Snorm | Rg11b10Ufloat | Rgb9e5Ufloat => COLOR.union(FormatCaps::FILTERABLE),
        Rgba8Snorm => COLOR.union(FormatCaps::FILTERABLE).union(STORAGE),
        R8Uint | R8Sint | R16Uint | R16Sint | Rg8Uint | Rg8Sint | Rg16Uint | Rg16Sint | Rgb10a2Uint => {
            COLOR.union(MSAA)
        }
        R32Float => COLOR.union(MSAA).union(STORAGE).union(FormatCaps::STORAGE_READ_WRITE),
        R32Uint | R32Sint => COLOR.union(FormatCaps::RENDERABLE).union(STORAGE).union(FormatCaps::STORAGE_READ_WRITE),
        Rgba8Uint | Rgba8Sint | Rgba16Uint | Rgba16Sint => COLOR.union(MSAA).union(STORAGE),
        Rg32Uint | Rg32Sint | Rg32Float | Rgba32Uint | Rgba32Sint | Rgba32Float => {
            COLOR.union(FormatCaps::RENDERABLE).union(STORAGE)
        }
        Stencil8 | Depth16Unorm | Depth24Plus | Depth24PlusStencil8 | Depth32Float => BASIC.union(MSAA),
        // The optional features `depth32float-stencil8` and texture compression.
        _ => FormatCaps::NONE,
    }
}

/// Returns the uses that desktop GPUs have in common.
fn desktop(format: Format) -> FormatCaps {
    let float = format.is_resolvable();
    let counts = FormatCaps::SAMPLES_2.union(MSAA).union(FormatCaps::SAMPLES_8);
    let given = |so: bool, uses: FormatCaps| if so { uses } else { FormatCaps::NONE };
    if format.is_compressed() {
        return given(is_bc(format), COLOR.union(FormatCaps::FILTERABLE));
    }
    if format.is_depth_stencil() {
        return BASIC.union(counts);
    }
    if format == Format::Rgb9e5Ufloat {
        return COLOR.union(FormatCaps::FILTERABLE);
    }
    let smooth = FormatCaps::FILTERABLE.union(FormatCaps::BLENDABLE).union(FormatCaps::RESOLVABLE);
    let storage = STORAGE.union(FormatCaps::STORAGE_READ_WRITE);
    COLOR.union(counts).union(given(float, smooth)).union(given(!format.is_srgb(), storage))
}

const fn is_bc(format: Format) -> bool {
    use Format::*;
    matches!(
        format,
        Bc1RgbaUnorm
            | Bc1RgbaUnormSrgb
            | Bc3RgbaUnorm
            | Bc3RgbaUnormSrgb
            | Bc4RUnorm
            | Bc5RgUnorm
            | Bc6hRgbUfloat
            | Bc7RgbaUnorm
            | Bc7RgbaUnormSrgb
    )
}
