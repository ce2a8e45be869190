//! Techniques for blended surfaces.

use super::Change::Options;
use super::{Technique, base, nowhere, pictures};
use crate::lab::studio::Truth;
use framegraph_passes::Transparency;
use framegraph_wgpu::Gpu;

/// Upper bound on the layers along any ray through the scene `panes`.
const ALL_LAYERS: u8 = 16;

/// Returns the techniques. Moments in 32 bits are included if the device can blend them.
pub(super) fn techniques(gpu: &Gpu) -> Vec<Technique> {
    let setup = base("panes");
    let mut truth = setup;
    truth.settings.transparency = Transparency::Peeled { layers: ALL_LAYERS };
    let mut own = pictures(
        "transparency",
        "Technique for blended surfaces: crossing panes, and a sphere within a sphere.",
        ("depth peeling with 16 layers, more than any pixel has.", Truth::Frame(truth)),
        setup,
        &[
            ("sorted", Options("transparency=sorted"), |f| f.settings.transparency == Transparency::Sorted),
            ("two passes", Options("transparency=two-passes"), nowhere),
            ("weighted", Options("transparency=weighted"), nowhere),
            ("moments, 16 bits", Options("transparency=moments"), nowhere),
            ("moments, 32 bits", Options("transparency=moments:precision=full"), nowhere),
            ("peeled, 2 layers", Options("transparency=peeled:layers=2"), nowhere),
            ("peeled, 4 layers", Options("transparency=peeled:layers=4"), nowhere),
            ("peeled, 8 layers", Options("transparency=peeled:layers=8"), nowhere),
        ],
    );
    if !gpu.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE) {
        own.choices.retain(|choice| choice.name != "moments, 32 bits");
    }
    vec![own]
}
