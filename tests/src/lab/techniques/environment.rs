//! Storage of the prefiltered environment, and sources of its irradiance.

use super::Change::{Function, Options};
use super::{Technique, base, formula, number, pictures};
use crate::lab::studio::Truth;
use crate::lab::technique::Measured;
use crate::measure::harmonics::{self, Scene as Around};
use framegraph_passes::light::ibl::EnvironmentFormat;
use framegraph_passes::light::shading::Irradiance;
use framegraph_scene::environment::{ShBands, ShWindow};
use framegraph_shader_mirrors::quantize::{quantize_rg11b10ufloat, quantize_rgba16float};
use framegraph_shader_mirrors::rgbm::{linear_from_rgbm, rgbm_bytes};
use framegraph_wgpu::Gpu;
use glam::{DVec3, DVec4};

pub(super) fn techniques() -> Vec<Technique> {
    vec![storage(), filtering(), irradiance()]
}

fn storage() -> Technique {
    let mut half = base("spheres");
    half.light.image.format = EnvironmentFormat::Half;
    pictures(
        "environment-storage",
        "Storage of the prefiltered environment: bytes per texel, and the error of the picture. RGBM has \
         eight bits per channel and a range up to the brightest channel of the cube.",
        ("half floats.", Truth::Frame(half)),
        half,
        &[
            ("half floats, 8 bytes", Options(""), |f| f.settings.shading.environment_format == EnvironmentFormat::Half),
            ("R11G11B10F, 4 bytes", Function(|s| s.light.image.format = EnvironmentFormat::Rg11b10), |f| {
                f.settings.shading.environment_format == EnvironmentFormat::Rg11b10
            }),
            ("RGBM, 4 bytes", Function(|s| s.light.image.format = EnvironmentFormat::Rgbm), |f| {
                f.settings.shading.environment_format == EnvironmentFormat::Rgbm
            }),
        ],
    )
}

/// Returns the RMS relative error of luminance midway between two texels that differ by `stops`. The truth is their mean.
fn midway(stops: f64, kept: &dyn Fn(DVec3, DVec3) -> DVec3) -> f64 {
    let tint = DVec3::new(1.0, 0.8, 0.5);
    let luminance = |c: DVec3| c.dot(DVec3::new(0.2126, 0.7152, 0.0722));
    let errors = (0..500).map(|i| {
        let dark = tint * (0.001 * 100.0_f64.powf(f64::from(i) / 499.0));
        let bright = dark * stops.exp2();
        luminance(kept(dark, bright)) / luminance(0.5 * (dark + bright)) - 1.0
    });
    (errors.map(|e| e * e).sum::<f64>() / 500.0).sqrt()
}

fn filtering() -> Technique {
    /// Difference between the sky and the aureole of the sun, in stops.
    const STOPS: f64 = 6.0;
    let choice = |name: &str, kept: fn(DVec3, DVec3) -> DVec3| {
        number(name, move |_: &Gpu| Ok(Measured::exact(midway(STOPS, &kept))))
    };
    let choices = vec![
        choice("half floats", |a, b| {
            let of = |c: DVec3| quantize_rgba16float(c.extend(1.0), false).truncate();
            0.5 * (of(a) + of(b))
        }),
        choice("R11G11B10F", |a, b| {
            let of = |c: DVec3| quantize_rg11b10ufloat(c, false).truncate();
            0.5 * (of(a) + of(b))
        }),
        choice("RGBM, decoded before filtering", |a, b| {
            0.5 * (linear_from_rgbm(stored(a)) + linear_from_rgbm(stored(b)))
        }),
        choice("RGBM, filtered as stored", |a, b| linear_from_rgbm(0.5 * (stored(a) + stored(b))))
            .counted("linear_from_rgbm", false),
    ];
    let what = "The same formats, interpolated midway between two texels that are six stops apart, as beside the \
                sun: relative error of luminance. Devices interpolate the encoded values of RGBM.";
    formula("environment-filter", what, "the mean of the two colors.", "share, RMS", choices)
}

fn stored(color: DVec3) -> DVec4 {
    DVec4::from_array(rgbm_bytes(color).map(|byte| f64::from(byte) / 255.0))
}

fn irradiance() -> Technique {
    const NORMALS: u32 = 400;
    let bands = |name: &str, bands, function| {
        let measure = move |_: &Gpu| {
            let e = harmonics::errors(Around::KeyDisc, bands, ShWindow::None, NORMALS, |sh| sh);
            Ok(Measured { bias: Some(e.lowest.min(0.0)), ..Measured::exact(e.worst) })
        };
        let mut setup = base("spheres");
        (setup.settings.shading.bands, setup.light.image.bands) = (bands, bands);
        number(name, measure).timed(setup).counted(function, false)
    };
    let cube = |name: &str, texels: u32, levels: u32| {
        let measure = move |gpu: &Gpu| {
            let e = harmonics::cube_errors(gpu, Around::KeyDisc, [texels, levels], NORMALS)?;
            Ok(Measured { bias: Some(e.lowest.min(0.0)), ..Measured::exact(e.worst) })
        };
        let mut setup = base("spheres");
        setup.settings.shading.irradiance = Irradiance::Cube;
        (setup.light.image.cube_texels, setup.light.image.levels) = (texels, levels);
        number(name, measure).timed(setup)
    };
    let choices = vec![
        bands("2 bands, 64 bytes", ShBands::Two, "irradiance_sh2"),
        bands("3 bands, 144 bytes", ShBands::Three, "irradiance_sh").found_in(|f| {
            let shading = &f.settings.shading;
            shading.irradiance == Irradiance::Harmonics && shading.bands == ShBands::Three
        }),
        cube("cube of 4², 384 bytes", 128, 6),
        cube("cube of 16², 6 KiB", 256, 5),
        cube("cube of 32², 24 KiB", 512, 5),
    ];
    let what = "Source of diffuse light from the environment, under a bright disc of 30°: the largest error, and as \
                bias the lowest value, both relative to the peak. Harmonics need no texture and no sampler. Bytes of \
                cubes are for R11G11B10F. A separate cube needs a texture and a sampler; the frame instead reads the \
                last level of the prefiltered cube, which holds the same values.";
    formula("irradiance", what, "irradiance by quadrature over the sphere.", "share of the peak", choices)
}
