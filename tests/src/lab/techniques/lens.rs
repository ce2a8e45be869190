//! Techniques between scene and sensor, and frames that are accumulated or upscaled.

use super::Change::{Function, Options};
use super::{Choice, Technique, base, formula, nowhere, number, pictures};
use crate::lab::studio::{Setup, Truth};
use crate::lab::technique::Measured;
use framegraph_passes::effects::bloom::Threshold;
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::dof::DofSettings;
use framegraph_passes::effects::upscale::UpscaleFilter;
use framegraph_passes::gpu_scene::punctual::FroxelSettings;
use framegraph_passes::{BloomSettings, FogSettings, LightSearch, TaaSettings, Upscale};
use framegraph_shader_mirrors::fog::{fog_opacity, fog_optical_depth};
use framegraph_wgpu::Gpu;

pub(super) fn techniques() -> Vec<Technique> {
    vec![temporal(), upscaling(), bloom_levels(), dof_rings(), dof_resolution(), fog(), froxels()]
}

fn temporal() -> Technique {
    let one = base("columns");
    pictures(
        "taa",
        "Temporal anti-aliasing: the picture after 32 frames of a still scene. The noise is the deviation of the next 16 frames from their mean.",
        ("8×8 supersampling, averaged as linear display light.", Truth::Supersampled(one, 8)),
        one,
        &[
            ("none", Options(""), |f| f.settings.taa.is_none()),
            ("a share of 0.12, Filament's", Options("taa=on"), |f| f.settings.taa == Some(TaaSettings::DEFAULT)),
            ("a share of 0.05", Options("taa=on:feedback=0.05"), nowhere),
            ("the input not filtered", Options("taa=on:filter-input=off"), nowhere),
            ("the mean of all frames", Options("taa=on:converge=on,filter-input=off,jitter=halton32"), nowhere),
        ],
    )
}

fn upscaling() -> Technique {
    let mut whole = base("columns");
    // Upscaled pictures are anti-aliased, since aliasing would dominate the difference.
    whole.settings.samples = 4;
    fn drawn(setup: &mut Setup, percent: u16, filter: UpscaleFilter) {
        setup.settings.upscale = Some(Upscale { percent, filter, ..Upscale::DEFAULT });
    }
    pictures(
        "upscaling",
        "Upscaling of frames with four samples per pixel: percentage of the width and height, and filter.",
        ("the frame at full resolution.", Truth::Frame(whole)),
        whole,
        &[
            ("100 %", Options(""), |f| f.settings.upscale.is_none()),
            ("77 %, FSR", Function(|s| drawn(s, 77, UpscaleFilter::Fsr)), nowhere),
            ("67 %, FSR", Function(|s| drawn(s, 67, UpscaleFilter::Fsr)), nowhere),
            ("50 %, FSR", Function(|s| drawn(s, 50, UpscaleFilter::Fsr)), nowhere),
            ("50 %, bilinear", Function(|s| drawn(s, 50, UpscaleFilter::Bilinear)), nowhere),
        ],
    )
}

fn bloom_levels() -> Technique {
    let bloom = BloomSettings {
        strength: 0.3,
        threshold: Threshold::None,
        levels: BloomSettings::MAX_LEVELS,
        ..BloomSettings::DEFAULT
    };
    let mut truth = base("spheres");
    truth.settings.bloom = Some(bloom);
    pictures(
        "bloom-levels",
        "Levels of bloom's pyramid, at a strength of 0.3 without a threshold.",
        ("as many levels as the picture has.", Truth::Frame(truth)),
        truth,
        &[
            ("2", Options("bloom.levels=2"), nowhere),
            ("3", Options("bloom.levels=3"), nowhere),
            ("4", Options("bloom.levels=4"), nowhere),
            ("5", Options("bloom.levels=5"), nowhere),
            ("6, the default", Options("bloom.levels=6"), nowhere),
        ],
    )
}

/// Returns a wide-open lens, so that most columns are out of focus.
fn open_lens(rings: u8, resolution: Resolution) -> DofSettings {
    DofSettings {
        focus_m: 3.0,
        f_number: 1.0,
        scale: 4.0,
        resolution,
        rings_before: rings,
        rings_behind: rings,
        rings_even: rings,
        ..DofSettings::DEFAULT
    }
}

fn out_of_focus() -> (Setup, (&'static str, Truth)) {
    let mut truth = base("columns");
    truth.settings.dof = Some(open_lens(17, Resolution::Full));
    (truth, ("17 rings at full resolution, the most that the frame allows.", Truth::Frame(truth)))
}

fn dof_rings() -> Technique {
    let (setup, truth) = out_of_focus();
    pictures(
        "dof-rings",
        "Rings of samples in depth of field's gather pass, each with eight more samples, at full resolution.",
        truth,
        setup,
        &[
            ("3", Function(|s| s.settings.dof = Some(open_lens(3, Resolution::Full))), nowhere),
            ("5, the default", Function(|s| s.settings.dof = Some(open_lens(5, Resolution::Full))), nowhere),
            ("8", Function(|s| s.settings.dof = Some(open_lens(8, Resolution::Full))), nowhere),
            ("12", Function(|s| s.settings.dof = Some(open_lens(12, Resolution::Full))), nowhere),
        ],
    )
}

fn dof_resolution() -> Technique {
    let (setup, truth) = out_of_focus();
    pictures(
        "dof-resolution",
        "Resolution of depth of field's gather pass relative to the picture, with five rings.",
        truth,
        setup,
        &[
            ("half, the default", Function(|s| s.settings.dof = Some(open_lens(5, Resolution::Half))), nowhere),
            ("full", Function(|s| s.settings.dof = Some(open_lens(5, Resolution::Full))), nowhere),
        ],
    )
}

/// Returns the opacity along a ray through exponentially decreasing density with a clear start, by numerical
/// integration.
fn marched(density: f64, decay: f64, start_m: f64, way_m: f64) -> f64 {
    const STEPS: u32 = 4096;
    let reached = (way_m - start_m).max(0.0);
    let step = |i: u32| {
        let at = (start_m + reached * (f64::from(i) + 0.5) / f64::from(STEPS)) / way_m;
        density * (-decay * at).exp()
    };
    1.0 - (-(0..STEPS).map(step).sum::<f64>() * reached / f64::from(STEPS)).exp()
}

fn fog() -> Technique {
    /// Compares rays of 1 to 100 m that rise, run level and fall, through fog that starts at 5 m.
    fn apart(opacity: impl Fn(f64, f64, f64, f64) -> f64) -> Measured {
        let grid = (0..20).flat_map(|w| (0..9).map(move |d| (100.0_f64.powf(f64::from(w) / 19.0), f64::from(d) - 4.0)));
        let off = grid.map(|(way, decay)| opacity(0.03, decay, 5.0, way) - marched(0.03, decay, 5.0, way));
        let off: Vec<f64> = off.collect();
        let count = off.len() as f64;
        let error = (off.iter().map(|d| d * d).sum::<f64>() / count).sqrt();
        Measured { bias: Some(off.iter().sum::<f64>() / count), ..Measured::exact(error) }
    }
    let foggy = |exact| {
        let mut setup = base("columns");
        setup.settings.fog = Some(FogSettings { density: 0.03, start_m: 5.0, exact, ..FogSettings::DEFAULT });
        setup
    };
    let of = |name: &str, exact: bool| -> Choice {
        let flag = f64::from(u8::from(exact));
        let measure = move |_: &Gpu| Ok(apart(|d, k, s, w| fog_opacity(fog_optical_depth(d, k, s, w, flag), 1.0)));
        number(name, measure).timed(foggy(exact)).counted("fog_optical_depth", false)
    };
    let choices = vec![
        number("none", |_: &Gpu| Ok(apart(|_, _, _, _| 0.0)))
            .timed(base("columns"))
            .found_in(|f| f.settings.fog.is_none()),
        of("the mean of the whole way, Filament's", false),
        of("the mean of what is in fog, the default", true),
    ];
    let what = "Opacity of height fog that starts 5 m from the eye, over distances of 1 to 100 m.";
    formula("fog", what, "integration in 4,096 steps, in f64.", "opacity, RMS", choices)
}

fn froxels() -> Technique {
    let mut truth = base("lamps:250");
    (truth.lights, truth.ev100) = (LightSearch::All, 8.0);
    pictures(
        "froxel-resolution",
        "Froxel resolution in tiles and depth slices for 250 punctual lights; coarser froxels have longer lists.",
        ("a loop over all lights.", Truth::Frame(truth)),
        truth,
        &[
            ("24 tiles, 4 slices", Options("lights=froxels:tiles=24,slices=4"), nowhere),
            ("24 tiles, 16 slices", Options("lights=froxels:tiles=24,slices=16"), nowhere),
            ("144 tiles, 4 slices", Options("lights=froxels:tiles=144,slices=4"), nowhere),
            ("144 tiles, 16 slices", Options("lights=froxels:tiles=144,slices=16"), |f| {
                f.lights == LightSearch::Auto(FroxelSettings::DEFAULT)
            }),
            ("144 tiles, 32 slices", Options("lights=froxels:tiles=144,slices=32"), nowhere),
        ],
    )
}
