//! Plans of the passes over blended surfaces.

use crate::stage::plan;
use framegraph::{Caps, Counts, Options, Plan};
use framegraph_passes::effects::transparency::MomentTransparency;
use framegraph_passes::{Settings, Transparency};

const DOCUMENT: &str = include_str!("../../../../docs/design/transparency.md");

const TECHNIQUES: [Transparency; 3] =
    [Transparency::Weighted, Transparency::Moments(MomentTransparency::DEFAULT), Transparency::Peeled { layers: 3 }];

fn planned(transparency: Transparency, samples: u8, caps: &Caps) -> Plan {
    let settings = Settings { blended: true, transparency, samples, fxaa: false, shadows: None, ..Settings::DEFAULT };
    plan(&settings, caps, &Options::for_frame(1280, 720))
}

/// On a device without reads of the tile, sums are stored for the pass that composes them, into which post-processing is inlined:
///
/// step                        attachment     load       store
/// prepass + color + weighted  hdr            clear      STORE  (compose samples it)
///                             weighted_color clear      STORE
///                             transmittance  clear      STORE
///                             depth          clear      discard
/// compose (+ post)            output         don't care STORE
///
/// Moments also store depth, for the step that shades and tests against it. A peeled layer clears its own depth,
/// which the next layer samples; color is loaded and stored between layers.
#[test]
fn sums_on_a_device_that_samples_them() {
    for samples in [1, 4] {
        let counts = TECHNIQUES.map(|technique| planned(technique, samples, &Caps::wgpu()).counts());
        for (technique, counts) in TECHNIQUES.iter().zip(counts) {
            assert_eq!(counts.inlined, 1, "{technique:?}: post-processing ends the pass that composes");
        }
        let [weighted, moments, peeled] = counts;
        if samples == 1 {
            let tiler = TECHNIQUES.map(|technique| planned(technique, samples, &Caps::tiler()).counts());
            for ((name, wgpu), tiler) in ["weighted", "moments", "peeled:layers=3"].into_iter().zip(counts).zip(tiler) {
                let of = |c: Counts| format!("{} | {} | {}", c.steps, c.unresolves, c.resolves);
                let row = format!("| `{name}` | {} | {} |", of(wgpu), of(tiler));
                assert!(DOCUMENT.contains(&row), "docs/design/transparency.md lacks {row}");
            }
        }
        assert_eq!((weighted.steps, weighted.unresolves), (2, 0));
        assert_eq!((moments.steps, moments.unresolves), (3, 1));
        assert_eq!(peeled.steps, 5);
    }
}

/// On a tiler everything from the prepass to the picture is one step: sums, depth and radiance never leave the tile. Peeled layers
/// have depths of their own, so each is a step.
#[test]
fn sums_stay_in_the_tile() {
    for samples in [1, 4] {
        let [weighted, moments, _] = TECHNIQUES.map(|technique| planned(technique, samples, &Caps::tiler()).counts());
        if samples == 1 {
            for (counts, sums) in [(weighted, 2), (moments, 3)] {
                let Counts { steps, unresolves, resolves, memoryless, .. } = counts;
                assert_eq!((steps, unresolves, resolves), (1, 0, 1), "{counts:?}");
                // Sums, radiance before and after, and depth.
                assert_eq!(memoryless, sums + 3, "{counts:?}");
            }
        } else {
            // The mean of the samples ends a step: post-processing reads it. Moments are averaged before they are read.
            assert_eq!((weighted.steps, weighted.unresolves, weighted.resolves), (2, 0, 2));
            assert_eq!((moments.steps, moments.unresolves), (3, 1));
        }
    }
}

/// A scene in which nothing blends has none of these passes.
#[test]
fn nothing_blended_costs_nothing() {
    for technique in TECHNIQUES {
        let of = |transparency| {
            let settings = Settings { transparency, ..Settings::DEFAULT };
            plan(&settings, &Caps::wgpu(), &Options::for_frame(1280, 720)).counts()
        };
        assert_eq!(of(technique), of(Transparency::Sorted));
    }
}
