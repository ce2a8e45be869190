//! Blur of the background behind rough bodies, compared with Walter's microfacet BTDF.

use framegraph_shader_mirrors::refraction::{seen_transmission_spread, transmission_spread};
use std::f64::consts::TAU;
use truth::slab::Slab;

/// Distance from the eye to the pane in meters.
const EYE_M: f64 = 1.0;
/// Number of positions across the edge.
const PLACES: i32 = 80;

/// Returns the cumulative standard normal distribution.
fn below(x: f64) -> f64 {
    let (steps, from) = (400, -8.0_f64);
    let x = x.clamp(from, 8.0);
    let width = (x - from) / f64::from(steps);
    let density = |t: f64| (-t * t / 2.0).exp() / TAU.sqrt();
    let inner: f64 = (1..steps).map(|i| density(from + width * f64::from(i)) * f64::from(2 + 2 * (i % 2))).sum();
    (inner + density(from) + density(x)) * width / 3.0
}

/// Returns RMS errors of an edge behind the slab, relative to its step, over a quarter of the view on each side.
/// Blurs: distance inside and behind the body, distance behind it alone, Filament's angle, none.
fn off(slab: &Slab) -> [f64; 4] {
    let Slab { roughness, ior, thickness_m, behind_m } = *slab;
    let whole_m = EYE_M + thickness_m + behind_m;
    let xs: Vec<f64> = (-PLACES / 2..=PLACES / 2).map(|i| 0.5 * whole_m * f64::from(i) / f64::from(PLACES)).collect();
    let truth = slab.edge(&xs);
    let spread = transmission_spread(roughness * roughness, ior);
    let sigmas = [
        spread * (thickness_m / ior + behind_m),
        spread * behind_m,
        seen_transmission_spread(roughness, ior) * whole_m,
        0.0,
    ];
    sigmas.map(|sigma_m| {
        let squares = xs.iter().zip(&truth).map(|(x, truth)| (below(x / sigma_m.max(1e-9)) - truth).powi(2));
        (squares.sum::<f64>() / xs.len() as f64).sqrt()
    })
}

/// The figures of `docs/design/optics.md`: over roughness 0.2 to 0.7 and indices 1.33 to 1.8, the default is nearest to the
/// truth at every thickness and distance.
#[test]
fn the_default_blur_of_rough_bodies_is_nearest_to_the_truth() {
    let document = include_str!("../../../../docs/design/optics.md");
    let (mut all, mut rows) = ([0.0; 4], 0.0);
    let show = |name: &str, figures: [f64; 4]| {
        let [a, b, c, d] = figures.map(|rms| format!("{rms:.4}"));
        format!("| {name} | {a} | {b} | {c} | {d} |")
    };
    let check = |line: String| {
        println!("{line}");
        assert!(document.contains(&line), "docs/design/optics.md lacks the line\n{line}");
    };
    for thickness_m in [0.0, 0.1, 0.3] {
        for behind_m in [0.02, 0.3, 1.0] {
            let grid = (2..=7).flat_map(|r| [1.33, 1.5, 1.8].map(|ior| (0.1 * f64::from(r), ior)));
            let found: Vec<[f64; 4]> =
                grid.map(|(roughness, ior)| off(&Slab { roughness, ior, thickness_m, behind_m })).collect();
            let mean: [f64; 4] =
                std::array::from_fn(|i| found.iter().map(|rms| rms[i] * rms[i]).sum::<f64>() / found.len() as f64);
            check(show(&format!("{thickness_m} m, {behind_m} m"), mean.map(f64::sqrt)));
            assert!(mean[0] <= mean[1] && mean[0] < mean[2] && mean[0] < mean[3], "{thickness_m} {behind_m}: {mean:?}");
            all = std::array::from_fn(|i| all[i] + mean[i]);
            rows += 1.0;
        }
    }
    check(show("all", all.map(|sum| (sum / rows).sqrt())));
}
