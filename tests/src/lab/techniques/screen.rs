//! Screen-space techniques and shadows.

use super::Change::Options;
use super::{Choice, Technique, base, formula, nowhere, number, pictures};
use crate::lab::studio::{Setup, Truth};
use crate::lab::technique::Measured;
use crate::measure::occlusion::{column, corner_columns, corner_error, corner_stage, mean_and_deviation};
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::occlusion::{Gtao, Method, OcclusionSettings};
use framegraph_passes::gpu_scene::shadow_views::{ShadowFilter, ShadowSettings, Splits};
use framegraph_passes::{FrameSettings, LightSearch, Precision};
use framegraph_wgpu::Gpu;
use glam::Vec3;
use truth::occlusion as truth;

/// Radius of ambient occlusion, in m.
const RADIUS_M: f64 = 0.3;

pub(super) fn techniques() -> Vec<Technique> {
    vec![
        taps(),
        method(),
        resolution(),
        bounces(),
        glass_layers(),
        shadow_filter(),
        shadow_cascades(),
        shadow_size(),
        antialiasing(),
        light_search(),
    ]
}

fn taps_of(f: &FrameSettings) -> Option<u32> {
    match f.settings.occlusion?.method {
        Method::Sao { taps, .. } => Some(taps),
        Method::Gtao(_) => None,
    }
}

/// Creates an option that is compared with the visibility of a corner: root mean square, signed mean, and standard
/// deviation along the edge.
fn corner(name: &str, settings: OcclusionSettings) -> Choice {
    let measure = move |gpu: &Gpu| {
        let stage = corner_stage(128)?;
        let seen = stage.visibility(gpu, &settings, Precision::Full)?;
        let columns = corner_columns(&stage, RADIUS_M);
        let of = |x: u32| mean_and_deviation(&column(&stage, &seen, x));
        let count = columns.len() as f64;
        let bias = columns.iter().map(|(x, d)| of(*x)[0] - truth::corner(*d, RADIUS_M)).sum::<f64>() / count;
        let noise = (columns.iter().map(|(x, _)| of(*x)[1].powi(2)).sum::<f64>() / count).sqrt();
        let error = corner_error(&stage, &seen, RADIUS_M);
        Ok(Measured { error, bias: Some(bias), noise: Some(noise), truth_error: 0.0 })
    };
    let mut setup = base("columns");
    setup.settings.occlusion = Some(settings);
    number(name, measure).timed(setup)
}

fn taps() -> Technique {
    let choice = |taps, turns| {
        let settings = OcclusionSettings { method: Method::Sao { taps, turns }, blur: None, ..OcclusionSettings::SAO };
        corner(&format!("{taps} taps, {turns} turns"), settings)
    };
    let choices = vec![
        choice(3, 1),
        choice(5, 2),
        choice(7, 5).found_in(|f| taps_of(f) == Some(7)),
        choice(11, 6).found_in(|f| taps_of(f) == Some(11)),
        choice(16, 7).found_in(|f| taps_of(f) == Some(16)),
        choice(32, 13),
    ];
    let what = "Samples (taps) of scalable ambient obscurance before any blur, in a corner of two walls: root mean square error of visibility. The bias comes from the method, the noise from sampling.";
    formula("ao-taps", what, "the analytic solution of the corner, for rays of 0.3 m.", "visibility, RMS", choices)
}

fn method() -> Technique {
    let gtao = |slices, steps| {
        let gtao = Gtao { slices, steps, ..Gtao::DEFAULT };
        OcclusionSettings { method: Method::Gtao(gtao), ..OcclusionSettings::GTAO }
    };
    let mut off = base("columns");
    off.settings.occlusion = None;
    let none = number("none", |_: &Gpu| {
        let stage = corner_stage(128)?;
        let open = vec![1.0; (stage.size_px[0] * stage.size_px[1]) as usize];
        Ok(Measured::exact(corner_error(&stage, &open, RADIUS_M)))
    });
    let choices = vec![
        none.timed(off).found_in(|f| f.settings.occlusion.is_none()),
        corner("SAO", OcclusionSettings::SAO)
            .found_in(|f| f.settings.occlusion.is_some_and(|o| o.method == OcclusionSettings::SAO.method)),
        corner("GTAO, 2 slices of 6 steps", gtao(2, 6))
            .found_in(|f| f.settings.occlusion.is_some_and(|o| o.method == OcclusionSettings::GTAO.method)),
        corner("GTAO, 4 slices of 8 steps", gtao(4, 8)),
    ];
    let what = "Method of ambient occlusion, each with its blur, in a corner of two walls: root mean square error of visibility.";
    formula("ao-method", what, "the analytic solution of the corner, for rays of 0.3 m.", "visibility, RMS", choices)
}

fn resolution() -> Technique {
    let mut full = base("columns");
    full.settings.occlusion = Some(OcclusionSettings::SAO);
    pictures(
        "ao-resolution",
        "Resolution of ambient occlusion relative to the picture.",
        ("ambient occlusion at full resolution.", Truth::Frame(full)),
        full,
        &[
            ("full", Options(""), |f| f.settings.occlusion.is_some_and(|o| o.resolution == Resolution::Full)),
            ("half", Options("ao.resolution=half"), |f| {
                f.settings.occlusion.is_some_and(|o| o.resolution == Resolution::Half)
            }),
        ],
    )
}

fn bounces() -> Technique {
    use framegraph_shader_mirrors::occlusion::gtao_multi_bounce;
    let choice = |name: &str, shown: fn(f64, f64) -> f64| {
        number(name, move |_: &Gpu| {
            let grid = (1..=20).flat_map(|v| (0..=18).map(move |p| (f64::from(v) / 20.0, f64::from(p) / 20.0)));
            let apart: Vec<f64> = grid.map(|(v, p)| shown(v, p) - v / (1.0 - p * (1.0 - v))).collect();
            let count = apart.len() as f64;
            let error = (apart.iter().map(|d| d * d).sum::<f64>() / count).sqrt();
            Ok(Measured { bias: Some(apart.iter().sum::<f64>() / count), ..Measured::exact(error) })
        })
    };
    let choices = vec![
        choice("none", |v, _| v).found_in(|f| !f.settings.shading.multi_bounce),
        choice("polynomial", |v, p| gtao_multi_bounce(v, glam::DVec3::splat(p)).x)
            .counted("gtao_multi_bounce", false)
            .found_in(|f| f.settings.shading.multi_bounce),
    ];
    let what = "Interreflections at occluded points, over visibility 0.05 … 1 and albedo 0 … 0.9.";
    formula("ao-bounces", what, "a spherical cavity, V / (1 − ρ (1 − V)).", "visibility, RMS", choices)
}

fn glass_layers() -> Technique {
    let mut truth = base("glass");
    truth.settings.glass_layers = 4;
    pictures(
        "glass-layers",
        "Layers of glass seen through glass.",
        ("four layers, the most that the frame allows.", Truth::Frame(truth)),
        truth,
        &[
            ("1", Options("glass-layers=1"), |f| f.settings.glass_layers == 1),
            ("2", Options("glass-layers=2"), nowhere),
            ("3", Options("glass-layers=3"), |f| f.settings.glass_layers == 3),
        ],
    )
}

/// Returns columns under a sun with a diameter of 2°, in one shadow map.
fn sunlit() -> Setup {
    let mut setup = base("columns");
    setup.sun = Some((Vec3::new(0.5, 0.7, 0.5).normalize(), 0.0175));
    setup.settings.shadows =
        Some(ShadowSettings { cascades: 2, splits: Splits::Practical(0.8), ..ShadowSettings::texels(1024) });
    setup.settings.shading.micro_shadows = false;
    setup
}

/// Returns the reference: hard shadows of a high-resolution map, averaged over many suns.
fn suns() -> (&'static str, Truth) {
    let mut setup = sunlit();
    let splits = Splits::Practical(0.8);
    setup.settings.shadows = Some(ShadowSettings { cascades: 4, splits, ..ShadowSettings::texels(2048) });
    (
        "the mean of 32 frames with hard shadows from different points of the sun's disc, in four maps of 2048² texels.",
        Truth::Suns(setup, 32),
    )
}

fn shadow_filter() -> Technique {
    pictures(
        "shadow-filter",
        "Filter of the sun's shadow map, under a sun with a diameter of 2°.",
        suns(),
        sunlit(),
        &[
            ("no shadows", Options("shadow=off"), |f| f.settings.shadows.is_none()),
            ("PCF", Options("shadow.filter=pcf"), |f| {
                f.settings.shadows.is_some_and(|s| s.filter == ShadowFilter::Pcf)
            }),
            ("DPCF", Options("shadow.filter=dpcf"), nowhere),
            ("PCSS", Options("shadow.filter=pcss"), |f| {
                f.settings.shadows.is_some_and(|s| s.filter == ShadowFilter::Pcss)
            }),
            ("VSM", Options("shadow.filter=vsm"), nowhere),
            ("EVSM", Options("shadow.filter=evsm"), nowhere),
        ],
    )
}

fn shadow_cascades() -> Technique {
    pictures(
        "shadow-cascades",
        "Number of shadow cascades of the sun, with 512² texels each and PCF.",
        suns(),
        sunlit(),
        &[
            ("1", Options("shadow.cascades=1 shadow.map-size=512"), |f| cascades(f) == Some(1)),
            ("2", Options("shadow.cascades=2 shadow.map-size=512"), |f| cascades(f) == Some(2)),
            ("3", Options("shadow.cascades=3 shadow.map-size=512"), |f| cascades(f) == Some(3)),
            ("4", Options("shadow.cascades=4 shadow.map-size=512"), |f| cascades(f) == Some(4)),
        ],
    )
}

fn cascades(f: &FrameSettings) -> Option<u8> {
    f.settings.shadows.map(|s| s.cascades)
}

fn shadow_size() -> Technique {
    pictures(
        "shadow-size",
        "Size of each of two shadow cascades of the sun, with PCF.",
        suns(),
        sunlit(),
        &[
            ("256²", Options("shadow.map-size=256"), nowhere),
            ("512²", Options("shadow.map-size=512"), nowhere),
            ("1024²", Options("shadow.map-size=1024"), |f| f.settings.shadows.is_some_and(|s| s.map_texels == 1024)),
            ("2048²", Options("shadow.map-size=2048"), |f| f.settings.shadows.is_some_and(|s| s.map_texels == 2048)),
        ],
    )
}

fn antialiasing() -> Technique {
    let one = base("columns");
    pictures(
        "antialiasing",
        "Anti-aliasing by samples per pixel, FXAA, or both.",
        ("8×8 supersampling, averaged as linear display light.", Truth::Supersampled(one, 8)),
        one,
        &[
            ("none", Options(""), |f| f.settings.samples == 1 && !f.settings.fxaa),
            ("FXAA", Options("fxaa=on"), |f| f.settings.samples == 1 && f.settings.fxaa),
            ("4 samples", Options("msaa=4"), |f| f.settings.samples == 4),
            ("4 samples, FXAA", Options("msaa=4 fxaa=on"), nowhere),
        ],
    )
}

fn light_search() -> Technique {
    let mut all = base("lamps:250");
    (all.lights, all.ev100) = (LightSearch::All, 8.0);
    pictures(
        "light-search",
        "Method by which shading finds the lights in range, for 250 punctual lights.",
        ("a loop over all lights.", Truth::Frame(all)),
        all,
        &[
            ("all", Options(""), |f| f.lights == LightSearch::All),
            ("by froxels", Options("lights=froxels"), |f| f.lights != LightSearch::All),
        ],
    )
}
