//! Conversion of the features and limits of a wgpu device to the compiler's [`Caps`].

use crate::device::format::texture_format;
use crate::device::gpu::Gpu;
use framegraph::{Caps, Dimension, Format, FormatCaps, FormatTable};
use wgpu::{
    AdapterInfo, DownlevelFlags, Features, Limits, TextureFormatFeatureFlags as Flags, TextureFormatFeatures,
    TextureUsages as Uses,
};

/// Returns the capabilities of a device: its limits, the uses of every format, and its optional features. Draws two
/// texels if the driver offers multiview, to find out whether it works.
pub(crate) fn query(gpu: &Gpu) -> Caps {
    let features = gpu.device.features();
    let downlevel = gpu.adapter().get_downlevel_capabilities().flags;
    let formats = Format::ALL.into_iter().fold(FormatTable::NONE, |table, format| {
        table.with(format, uses(format, features, gpu.format_features(format)))
    });
    Caps {
        formats,
        // A device that fails here fails in its first frame too.
        max_attached_layers: gpu.max_attached_layers().unwrap_or(1),
        multisampled_arrays: features.contains(Features::MULTISAMPLE_ARRAY),
        srgb_views: gpu.has_view_formats(),
        raster_storage: downlevel.contains(DownlevelFlags::FRAGMENT_WRITABLE_STORAGE),
        clears_to_zero: features.contains(Features::CLEAR_TEXTURE),
        ..caps_of(gpu.info(), &gpu.device.limits())
    }
}

impl Gpu {
    /// Returns the capabilities of the device for the compiler. The first call queries the driver, and draws two texels
    /// if it offers multiview ([`Gpu::max_attached_layers`]).
    pub fn caps(&self) -> Caps {
        self.caps_ref().clone()
    }

    pub(crate) fn caps_ref(&self) -> &Caps {
        self.caps.get_or_init(|| query(self))
    }
}

/// Converts wgpu's uses of a format.
fn uses(format: Format, features: Features, offered: TextureFormatFeatures) -> FormatCaps {
    let TextureFormatFeatures { allowed_usages: allowed, flags } = offered;
    let drawn = allowed.contains(Uses::RENDER_ATTACHMENT);
    let stored = |flag| allowed.contains(Uses::STORAGE_BINDING) && flags.contains(flag);
    let rows = [
        (FormatCaps::SAMPLED, allowed.contains(Uses::TEXTURE_BINDING)),
        (FormatCaps::FILTERABLE, flags.contains(Flags::FILTERABLE)),
        (FormatCaps::RENDERABLE, drawn),
        (FormatCaps::BLENDABLE, drawn && flags.contains(Flags::BLENDABLE)),
        (FormatCaps::STORAGE_READ, stored(Flags::STORAGE_READ_ONLY)),
        (FormatCaps::STORAGE_WRITE, stored(Flags::STORAGE_WRITE_ONLY)),
        (FormatCaps::STORAGE_READ_WRITE, stored(Flags::STORAGE_READ_WRITE)),
        (FormatCaps::RESOLVABLE, flags.contains(Flags::MULTISAMPLE_RESOLVE)),
        (FormatCaps::COPY_SOURCE, allowed.contains(Uses::COPY_SRC)),
        (FormatCaps::COPY_TARGET, allowed.contains(Uses::COPY_DST)),
        (FormatCaps::VOLUME, !allowed.is_empty() && exists_in(Dimension::D3, format, features)),
        // Multisampled textures must be attachments.
        (FormatCaps::SAMPLES_2, drawn && flags.contains(Flags::MULTISAMPLE_X2)),
        (FormatCaps::SAMPLES_4, drawn && flags.contains(Flags::MULTISAMPLE_X4)),
        (FormatCaps::SAMPLES_8, drawn && flags.contains(Flags::MULTISAMPLE_X8)),
        (FormatCaps::SAMPLES_16, drawn && flags.contains(Flags::MULTISAMPLE_X16)),
    ];
    rows.into_iter().filter(|(_, has)| *has).fold(FormatCaps::NONE, |all, (bit, _)| all.union(bit))
}

/// Returns whether wgpu creates textures of this dimension and format: volumes have color, and compressed ones need a
/// feature.
fn exists_in(dimension: Dimension, format: Format, features: Features) -> bool {
    let theirs = texture_format(format);
    match dimension {
        Dimension::D2 => true,
        Dimension::D3 if theirs.is_bcn() => features.contains(Features::TEXTURE_COMPRESSION_BC_SLICED_3D),
        Dimension::D3 if theirs.is_astc() => features.contains(Features::TEXTURE_COMPRESSION_ASTC_SLICED_3D),
        Dimension::D3 => !format.is_compressed() && !format.is_depth_stencil(),
    }
}

/// Returns the capabilities of a device with these limits on this adapter, with WebGPU's formats and rules.
///
/// Memoryless attachments are always accepted; [`AdapterInfo::transient_saves_memory`] says whether they save memory.
/// Input attachments, placed resources and explicit barriers are off, since wgpu tracks resources itself.
fn caps_of(info: &AdapterInfo, limits: &Limits) -> Caps {
    Caps {
        name: format!("{} ({})", info.name, info.backend),
        max_color_attachments: limits.max_color_attachments.min(u32::from(framegraph::MAX_COLORS)) as u8,
        max_color_bytes_per_sample: limits.max_color_attachment_bytes_per_sample,
        max_texture_texels: limits.max_texture_dimension_2d,
        max_volume_texels: limits.max_texture_dimension_3d,
        max_texture_layers: limits.max_texture_array_layers,
        max_buffer_bytes: limits.max_buffer_size,
        max_samples: 16,
        max_sampled_textures: limits.max_sampled_textures_per_shader_stage,
        max_samplers: limits.max_samplers_per_shader_stage,
        max_storage_textures: limits.max_storage_textures_per_shader_stage,
        max_storage_buffers: limits.max_storage_buffers_per_shader_stage,
        max_uniform_buffers: limits.max_uniform_buffers_per_shader_stage,
        max_uniform_bytes: limits.max_uniform_buffer_binding_size,
        max_storage_bytes: limits.max_storage_buffer_binding_size,
        uniform_alignment_bytes: limits.min_uniform_buffer_offset_alignment.into(),
        storage_alignment_bytes: limits.min_storage_buffer_offset_alignment.into(),
        memoryless_saves: info.transient_saves_memory == Some(true),
        ..Caps::wgpu()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wgpu::{Backend, DeviceType};

    #[test]
    fn limits_become_caps() {
        let mut info = AdapterInfo::new(DeviceType::DiscreteGpu, Backend::Metal);
        info.name = "card".into();
        info.transient_saves_memory = Some(true);
        let limits = Limits { max_texture_dimension_2d: 4096, max_color_attachments: 4, ..Limits::default() };
        let caps = caps_of(&info, &limits);
        assert_eq!((caps.max_texture_texels, caps.max_color_attachments, caps.memoryless_saves), (4096, 4, true));
        assert!(caps.name.contains("card") && !caps.same_pixel && !caps.placed && !caps.explicit_barriers);
    }

    #[test]
    fn a_device_without_optional_features_is_the_preset() -> Result<(), Box<dyn std::error::Error>> {
        let full = Gpu::noop()?;
        let (adapter, wanted) = (full.adapter(), wgpu::DeviceDescriptor::default());
        let (device, queue) = pollster::block_on(adapter.request_device(&wanted))?;
        let bare = Gpu::wrap(adapter, &device, &queue).caps();
        for format in Format::ALL {
            let (found, preset) = (bare.formats.get(format), Caps::wgpu().formats.get(format));
            let names = |caps: FormatCaps| caps.names().collect::<Vec<_>>();
            assert_eq!(names(found), names(preset), "{format:?}");
        }
        let same = Caps { name: "wgpu".into(), max_samples: 4, memoryless_saves: false, ..bare };
        assert_eq!(same, Caps::wgpu());
        Ok(())
    }
}
