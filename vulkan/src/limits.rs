//! Comparison of the capabilities that a plan is compiled for with those of a device.

use crate::error::Error;
use crate::gpu::Gpu;
use framegraph::{Caps, Plan, ResolveMode, ResolveModes};

/// Fails if a plan is compiled for more than the device has.
pub(crate) fn check_caps(plan: &Caps, device: &Caps) -> Result<(), Error> {
    let maxima = |caps: &Caps| {
        [
            ("max_color_attachments", u64::from(caps.max_color_attachments)),
            ("max_attached_layers", caps.max_attached_layers.into()),
            ("max_texture_texels", caps.max_texture_texels.into()),
            ("max_volume_texels", caps.max_volume_texels.into()),
            ("max_texture_layers", caps.max_texture_layers.into()),
            ("max_buffer_bytes", caps.max_buffer_bytes),
            ("max_samples", caps.max_samples.into()),
            ("tile_heap_bytes", caps.tile_heap_bytes),
            ("separate_planes", caps.separate_planes.into()),
            ("sample_read_only_depth", caps.sample_read_only_depth.into()),
            ("placed_histories", caps.placed_histories.into()),
        ]
    };
    let refuse = |capability, wanted, given| Err(Error::Caps { capability, wanted, given });
    for ((capability, wanted), (_, given)) in maxima(plan).into_iter().zip(maxima(device)) {
        if wanted > given {
            return refuse(capability, wanted.to_string(), given.to_string());
        }
    }
    let resolves = |caps: &Caps| [("color_resolves", caps.color_resolves), ("depth_resolves", caps.depth_resolves)];
    for ((capability, wanted), (_, given)) in resolves(plan).into_iter().zip(resolves(device)) {
        if ResolveMode::ALL.into_iter().any(|mode| wanted.has(mode) && !given.has(mode)) {
            return refuse(capability, modes(wanted), modes(given));
        }
    }
    // A device whose images and buffers share memory types still accepts two heaps.
    if device.separate_heaps && !plan.separate_heaps {
        return refuse("separate_heaps", "0".to_owned(), "1".to_owned());
    }
    Ok(())
}

fn modes(modes: ResolveModes) -> String {
    let names: Vec<_> = ResolveMode::ALL.into_iter().filter(|mode| modes.has(*mode)).map(ResolveMode::word).collect();
    names.join(" | ")
}

/// Fails if a step draws more layers than the device has views.
pub(crate) fn check_views(gpu: &Gpu, plan: &Plan) -> Result<(), Error> {
    let limit = gpu.shared.max_views;
    match plan.step_ids().find(|step| plan.steps()[step.index()].layers > limit) {
        None => Ok(()),
        Some(step) => {
            let pass = plan.graph().pass_name(plan.passes_of(step)[0].pass).to_owned();
            Err(Error::Views { pass, wanted: plan.steps()[step.index()].layers, limit })
        }
    }
}
