//! Conversion of wgpu limits to the compiler's [`Caps`].

use framegraph::Caps;
use wgpu::{AdapterInfo, Limits};

/// Returns the capabilities of a device with these limits on this adapter.
///
/// `max_samples` stays at 4, which WebGPU guarantees for every multisampled format. Memoryless attachments are always
/// accepted; [`AdapterInfo::transient_saves_memory`] says whether they save memory. Input attachments, placed resources
/// and explicit barriers are off, since wgpu tracks resources itself.
pub(crate) fn caps_of(info: &AdapterInfo, limits: &Limits) -> Caps {
    Caps {
        name: format!("{} ({})", info.name, info.backend),
        max_color_attachments: limits.max_color_attachments.min(u32::from(framegraph::MAX_COLORS)) as u8,
        max_color_bytes_per_sample: limits.max_color_attachment_bytes_per_sample,
        max_texture_texels: limits.max_texture_dimension_2d,
        max_texture_layers: limits.max_texture_array_layers,
        max_buffer_bytes: limits.max_buffer_size,
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
}
