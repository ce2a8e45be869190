//! Techniques of surfaces and lighting.

use super::Change::{Function, Options};
use super::{Technique, base, formula, nowhere, number, pictures};
use crate::lab::studio::Truth;
use crate::lab::technique::Measured;
use crate::measure::harmonics::Scene as Around;
use crate::measure::{albedo, furnace, half, harmonics};
use framegraph_passes::Precision;
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::ibl::{DfgSettings, DfgTable};
use framegraph_passes::light::shading::SpecularAa;
use framegraph_scene::environment::{ShBands, ShWindow};
use framegraph_scene::progress;
use framegraph_shader_mirrors::dfg::Visibility;
use framegraph_wgpu::Gpu;
use truth::albedo::Masking;

/// Index into [`furnace::F0`]. At f0 = 1, the table is exact by construction.
const METAL: usize = 2;
/// Random walks per point of the furnace.
const PATHS: u32 = 2000;

pub(super) fn techniques(gpu: &Gpu) -> Vec<Technique> {
    let has_half = gpu.device.features().contains(wgpu::Features::SHADER_F16);
    let mut all = vec![visibility(), table_size(), compensation(), harmonics_bands(), harmonics_window()];
    all.extend([cube_levels(), cube_size(), roughness_floor(), specular_aa(), distribution(has_half)]);
    if has_half {
        all.extend([precision("precision", "spheres"), precision("precision-materials", "materials")]);
    }
    all
}

fn visibility() -> Technique {
    let truth = Truth::Frame(base("materials"));
    pictures(
        "visibility",
        "Visibility term V of the specular lobe, and the DFG table made for it.",
        ("the exact height-correlated Smith term with its own table.", truth),
        base("materials"),
        &[
            ("exact V, exact table", Options(""), |f| f.settings.shading.visibility == Visibility::Exact),
            (
                "fast V, fast table",
                Function(|s| {
                    (s.settings.shading.visibility, s.settings.shading.table) = (Visibility::Fast, Visibility::Fast);
                    s.light.dfg.visibility = Visibility::Fast;
                }),
                |f| f.settings.shading.visibility == Visibility::Fast,
            ),
            ("fast V, exact table", Options("shade=visibility=fast,table=exact"), nowhere),
        ],
    )
}

fn precision(name: &str, scene: &'static str) -> Technique {
    let mut full = base(scene);
    // Both precisions use the roughness limit of half floats, which is not part of the comparison.
    full.settings.shading.roughness_floor = 0.089;
    pictures(
        name,
        &format!(
            "Shading of the scene `{scene}` in half floats compared to f32, with a roughness of at least 0.089 in both."
        ),
        ("shading in f32.", Truth::Frame(full)),
        full,
        &[
            ("f32", Options(""), |f| f.settings.shading.precision == Precision::Full),
            ("f16", Options("shade=precision=f16"), |f| f.settings.shading.precision == Precision::Half),
        ],
    )
}

fn roughness_floor() -> Technique {
    let mut truth = base("spheres");
    truth.settings.shading.specular_aa = None;
    pictures(
        "roughness-floor",
        "Minimum perceptual roughness.",
        ("a minimum of 0.045, the lowest that the frame allows.", Truth::Frame(truth)),
        truth,
        &[
            ("0.045", Options(""), |f| f.settings.shading.roughness_floor == 0.045),
            ("0.089", Options("shade=floor=0.089"), |f| f.settings.shading.roughness_floor == 0.089),
            ("0.2", Options("shade=floor=0.2"), nowhere),
        ],
    )
}

fn specular_aa() -> Technique {
    let mut sharp = base("spheres");
    sharp.settings.shading.specular_aa = None;
    pictures(
        "specular-aa",
        "Specular anti-aliasing, which increases roughness by the variance of normals within a pixel.",
        ("8×8 supersampling without it, averaged as linear light.", Truth::Supersampled(sharp, 8)),
        sharp,
        &[
            ("none", Options(""), |f| f.settings.shading.specular_aa.is_none()),
            ("variance .15, at most .2", Options("shade=aa=on"), |f| {
                f.settings.shading.specular_aa == Some(SpecularAa::FILAMENT)
            }),
            ("variance .25, at most .18", Options("shade=aa=0.25:0.18"), nowhere),
        ],
    )
}

fn cube_levels() -> Technique {
    let mut truth = base("spheres");
    (truth.light.image.cube_texels, truth.light.image.levels) = (512, 8);
    pictures(
        "prefilter-levels",
        "Roughness levels of the prefiltered environment, a cube of 256 texels.",
        ("eight levels of a cube of 512 texels.", Truth::Frame(truth)),
        truth,
        &[
            ("5", Function(|s| (s.light.image.cube_texels, s.light.image.levels) = (256, 5)), |f| {
                f.settings.shading.light(f.quality).image.levels == 5
            }),
            ("6", Function(|s| (s.light.image.cube_texels, s.light.image.levels) = (256, 6)), nowhere),
            ("7", Function(|s| (s.light.image.cube_texels, s.light.image.levels) = (256, 7)), |f| {
                f.settings.shading.light(f.quality).image.levels == 7
            }),
        ],
    )
}

fn cube_size() -> Technique {
    let mut truth = base("spheres");
    truth.light.image.cube_texels = 512;
    pictures(
        "prefilter-size",
        "Cube size of the prefiltered environment, with six levels.",
        ("a cube of 512 texels.", Truth::Frame(truth)),
        truth,
        &[
            ("64", Function(|s| (s.light.image.cube_texels, s.light.image.levels) = (64, 6)), nowhere),
            ("128", Function(|s| s.light.image.cube_texels = 128), nowhere),
            ("256", Function(|s| s.light.image.cube_texels = 256), |f| {
                f.settings.shading.light(f.quality).image.cube_texels == 256
            }),
        ],
    )
}

fn table_size() -> Technique {
    let choice = |texels: u32| {
        let measure = move |gpu: &Gpu| {
            let settings = DfgSettings { texels, visibility: Visibility::Exact };
            let table = DfgTable::new(gpu, settings, &Cache::off(), &mut progress::silent)?;
            Ok(Measured::exact(albedo::errors(gpu, &table, Masking::Smith, 300)?.albedo_rms))
        };
        let mut setup = base("materials");
        setup.light.dfg.texels = texels;
        number(&format!("{texels}²"), measure).timed(setup)
    };
    let choices = vec![
        choice(32),
        choice(64).found_in(|f| f.settings.shading.light(f.quality).dfg.texels == 64),
        choice(128).found_in(|f| f.settings.shading.light(f.quality).dfg.texels == 128),
    ];
    let what = "Size of the DFG table: root mean square error of the directional albedo at f0 = 1.";
    formula("table-size", what, "the lobe's integral by quadrature.", "albedo, RMS", choices)
}

fn compensation() -> Technique {
    let choice = |name: &str, compensation| {
        let measure = move |gpu: &Gpu| {
            let settings = DfgSettings { texels: 64, visibility: Visibility::Exact };
            let table = DfgTable::new(gpu, settings, &Cache::off(), &mut progress::silent)?;
            let of_metal = furnace::errors(gpu, &table, compensation, PATHS)?[METAL];
            // Standard error of a binomial distribution at its widest.
            let truth_error = 0.5 / f64::from(PATHS * 60).sqrt();
            Ok(Measured { error: of_metal.mean, bias: None, noise: None, truth_error })
        };
        number(name, measure)
    };
    let mut off = base("materials");
    (off.settings.shading.compensate_image, off.settings.shading.compensate_punctual) = (false, false);
    let choices = vec![
        choice("none", furnace::Compensation::None).timed(off).found_in(|f| !f.settings.shading.compensate_image),
        choice("by the table", furnace::Compensation::Table)
            .timed(base("materials"))
            .counted("energy_compensation", false)
            .found_in(|f| f.settings.shading.compensate_image),
    ];
    let what = "Compensation for multiple scattering in rough metal, in a white furnace at f0 = 0.6: mean relative error over 60 roughnesses and angles.";
    formula("energy-compensation", what, "random walks over a microsurface, 2000 per point.", "share", choices)
}

fn harmonics_bands() -> Technique {
    let choice = |name: &str, bands| {
        let measure = move |_: &Gpu| {
            let e = harmonics::errors(Around::KeyDisc, bands, ShWindow::None, 400, |sh| sh);
            Ok(Measured { bias: Some(e.lowest.min(0.0)), ..Measured::exact(e.worst) })
        };
        let mut setup = base("spheres");
        (setup.settings.shading.bands, setup.light.image.bands) = (bands, bands);
        number(name, measure).timed(setup)
    };
    let choices = vec![
        choice("2", ShBands::Two).counted("irradiance_sh2", false),
        choice("3", ShBands::Three)
            .counted("irradiance_sh", false)
            .found_in(|f| f.settings.shading.bands == ShBands::Three),
        choice("5", ShBands::Five)
            .counted("irradiance_sh5", false)
            .found_in(|f| f.settings.shading.bands == ShBands::Five),
    ];
    let what = "Bands of the spherical harmonics of irradiance, under a bright disc with a radius of 30°. The error is the largest, and the bias is the lowest value, both relative to the peak.";
    formula("harmonics-bands", what, "irradiance by quadrature over the sphere.", "share of the peak", choices)
}

fn harmonics_window() -> Technique {
    let choice = |name: &str, window| {
        number(name, move |_: &Gpu| {
            let e = harmonics::errors(Around::Sun, ShBands::Three, window, 400, |sh| sh);
            Ok(Measured { bias: Some(e.lowest.min(0.0)), ..Measured::exact(e.worst) })
        })
    };
    let choices = vec![
        choice("none", ShWindow::None).found_in(|f| f.settings.shading.window == ShWindow::None),
        choice("Hann", ShWindow::Hann),
        choice("sinc", ShWindow::Sinc),
        choice("Laplacian, .01", ShWindow::Laplacian { lambda: 0.01 }),
    ];
    let what = "Window that attenuates high bands against ringing, with three bands and only a sun. The error is the largest, and the bias is the lowest value, both relative to the peak.";
    formula("harmonics-window", what, "the cosine of the sun.", "share of the peak", choices)
}

fn distribution(has_half: bool) -> Technique {
    let choice = |form: half::Form, function, in_half| {
        let measure = move |gpu: &Gpu| {
            let e = half::lobe_error(gpu, form, 0.089, 2048)?;
            Ok(Measured::exact(e.p99))
        };
        let choice = number(&form.name().replace("\\|", "|").replace('|', "‖"), measure);
        match function {
            Some(function) => choice.counted(function, in_half),
            None => choice,
        }
    };
    let mut choices = vec![
        choice(half::Form::Textbook, None, false),
        choice(half::Form::Product, Some("d_ggx"), false).found_in(|f| f.settings.shading.precision == Precision::Full),
        choice(half::Form::Cross, Some("d_ggx_cross"), false),
    ];
    if has_half {
        choices.push(choice(half::Form::HalfTextbook, None, true));
        choices.push(choice(half::Form::HalfCross, Some("d_ggx_cross"), true));
    }
    let what = "Formula for the angle in the GGX distribution, at roughness 0.089 over the lobe: the relative error that 1 % of the half vectors exceed.";
    formula("distribution", what, "the distribution at the exact angle in f64.", "share, 99th percentile", choices)
}
