//! Techniques of the picture: formats, tone curves in tables, quantization.

use super::Change::Options;
use super::{Technique, base, formula, nowhere, number, pictures};
use crate::lab::studio::Truth;
use crate::lab::technique::Measured;
use crate::measure::grading;
use framegraph::Format;
use framegraph_passes::grading::{Extras, GradeBy, Look, TableDesc, TableFormat};
use framegraph_shader_mirrors::dither::dither_offset;
use framegraph_shader_mirrors::grading::{linear_from_log_c, log_c_from_linear};
use framegraph_shader_mirrors::quantize::{quantize_rg11b10ufloat, quantize_rgba16float};
use framegraph_shader_mirrors::srgb::srgb_from_linear_channel;
use framegraph_shaders::layout::ToneMap;
use framegraph_wgpu::Gpu;
use glam::{DVec2, DVec3};

pub(super) fn techniques(_: &Gpu) -> Vec<Technique> {
    vec![format(), tone_mapper(), tone_fit(), tone_table(), table_coordinates(), oetf(), dither(), post_passes()]
}

/// Returns colors from nine stops below gray to seven above, independent per channel.
fn colors() -> Vec<DVec3> {
    let golden = |i: u32, by: f64| 0.18 * (16.0 * (f64::from(i) * by).fract() - 9.0).exp2();
    (0..4096).map(|i| DVec3::new(golden(i, 0.819_172_5), golden(i, 0.671_043_6), golden(i, 0.549_700_5))).collect()
}

fn format() -> Technique {
    let choice = |name: &str, format: Format, kept: fn(DVec3) -> DVec3| {
        let measure = move |_: &Gpu| {
            let luminance = |c: DVec3| c.dot(DVec3::new(0.2126, 0.7152, 0.0722));
            let apart: Vec<f64> = colors().iter().map(|c| luminance(kept(*c)) / luminance(*c) - 1.0).collect();
            let count = apart.len() as f64;
            let error = (apart.iter().map(|d| d * d).sum::<f64>() / count).sqrt();
            Ok(Measured { bias: Some(apart.iter().sum::<f64>() / count), ..Measured::exact(error) })
        };
        let mut setup = base("spheres");
        setup.settings.hdr_format = format;
        // A separate pass reads the stored picture.
        setup.settings.split_post = true;
        number(name, measure).timed(setup)
    };
    let choices = vec![
        choice("Rgba16Float", Format::Rgba16Float, |c| quantize_rgba16float(c.extend(1.0), false).truncate())
            .found_in(|f| f.settings.hdr_format == Format::Rgba16Float),
        choice("Rg11b10Ufloat, rounded", Format::Rg11b10Ufloat, |c| quantize_rg11b10ufloat(c, false).truncate())
            .found_in(|f| f.settings.hdr_format == Format::Rg11b10Ufloat),
        choice("Rg11b10Ufloat, truncated", Format::Rg11b10Ufloat, |c| quantize_rg11b10ufloat(c, true).truncate()),
    ];
    let what = "Format of radiance between shading and grading: relative error of luminance, over sixteen stops.";
    formula("radiance-format", what, "the stored number.", "share, RMS", choices)
}

fn tone_table() -> Technique {
    let aces = grading::looks()[1].1;
    let mut direct = base("spheres");
    direct.settings.post.look = aces;
    let of = move |name: &str, desc: TableDesc| {
        let mut setup = direct;
        setup.settings.post.by = GradeBy::Table(desc);
        number(name, move |_: &Gpu| Ok(Measured::exact(grading::error("aces", &aces, desc)?.rms))).timed(setup)
    };
    let half = |entries| TableDesc { entries, format: TableFormat::Half };
    let choices = vec![
        number("computed", |_: &Gpu| Ok(Measured::exact(0.0)))
            .timed(direct)
            .found_in(|f| f.settings.post.by == GradeBy::Direct),
        of("16³, half floats", half(16)),
        of("32³, half floats", half(32)),
        of("64³, half floats", half(64)),
    ];
    let what = "ACES curve in a table with logarithmic coordinates: root mean square error over random colors.";
    formula("tone-table", what, "the curve itself.", "8-bit steps, RMS", choices)
}

/// Returns a look without grading.
fn curve(tone_map: ToneMap) -> Look {
    Look { tone_map, ..Look::default() }
}

fn tone_mapper() -> Technique {
    let choice = |name: &str, tone_map: ToneMap| {
        let mut setup = base("spheres");
        setup.settings.post.look = curve(tone_map);
        let measure = move |_: &Gpu| {
            let extras = Extras::default();
            let (ours, aces) = (curve(tone_map).function(&extras)?, curve(ToneMap::Aces).function(&extras)?);
            let squares = colors().iter().map(|c| (255.0 * (ours(*c) - aces(*c))).length_squared()).sum::<f64>();
            Ok(Measured::exact((squares / (3 * colors().len()) as f64).sqrt()))
        };
        number(name, measure).timed(setup)
    };
    let choices = vec![
        choice("ACES", ToneMap::Aces),
        choice("ACES as fitted by Hill", ToneMap::Hill).found_in(|f| f.settings.post.look.tone_map == ToneMap::Hill),
        choice("ACES as fitted by Narkowicz", ToneMap::Filmic),
        choice("Khronos neutral", ToneMap::Neutral),
        choice("mobile, with the encoding in it", ToneMap::Mobile),
    ];
    let what =
        "Tone curve, over random colors of sixteen stops. The error of other curves is their intended difference.";
    formula("tone-mapper", what, "Filament's ACES curve in f64.", "8-bit steps, RMS", choices)
}

fn tone_fit() -> Technique {
    let choice = |name: &str, tone_map: ToneMap| {
        let mut setup = base("spheres");
        setup.settings.post.look = curve(tone_map);
        let measure = move |_: &Gpu| {
            let extras = Extras::default();
            let (ours, fitted) = (curve(tone_map).function(&extras)?, curve(ToneMap::Filmic).function(&extras)?);
            let apart: Vec<DVec3> = colors().iter().map(|c| 255.0 * (ours(*c) - fitted(*c))).collect();
            let count = (3 * apart.len()) as f64;
            let bias = apart.iter().map(|d| d.element_sum()).sum::<f64>() / count;
            let error = (apart.iter().map(|d| d.length_squared()).sum::<f64>() / count).sqrt();
            Ok(Measured { bias: Some(bias), ..Measured::exact(error) })
        };
        number(name, measure).timed(setup)
    };
    let choices = vec![
        choice("Narkowicz, then sRGB", ToneMap::Filmic)
            .counted("tone_map_filmic", false)
            .counted("srgb_from_linear", false),
        choice("mobile, with sRGB in it", ToneMap::Mobile).counted("tone_map_mobile", false),
    ];
    let what = "The mobile tone curve x / (x + 0.155) · 1.019, which includes the transfer function, against the curve that \
                it approximates, over random colors of sixteen stops.";
    formula("tone-fit", what, "ACES as fitted by Narkowicz, sRGB encoded.", "8-bit steps, RMS", choices)
}

fn table_coordinates() -> Technique {
    const ENTRIES: usize = 32;
    /// Maximum light in a table over linear light: seven stops above gray.
    const BRIGHTEST: f64 = 0.18 * 128.0;
    // Grays exercise each axis of a table alone.
    let choice = |name: &str, place: fn(f64) -> f64, light: fn(f64) -> f64, stretched: bool| {
        number(name, move |_: &Gpu| {
            let extras = Extras::default();
            let shown = Look::default().function(&extras)?;
            let last = (ENTRIES - 1) as f64;
            let table: Vec<f64> = (0..ENTRIES).map(|i| shown(DVec3::splat(light(i as f64 / last))).x).collect();
            let sample = |grey: f64| {
                let x = place(grey).clamp(0.0, 1.0);
                // Without the remapping by half a texel, the centers of the first and last texel are missed.
                let at = if stretched { x * last } else { (x * ENTRIES as f64 - 0.5).clamp(0.0, last) };
                let below = (at as usize).min(ENTRIES - 2);
                table[below] + (table[below + 1] - table[below]) * (at - below as f64)
            };
            let greys: Vec<f64> = (0..2000).map(|i| 0.18 * (16.0 * f64::from(i) / 1999.0 - 9.0).exp2()).collect();
            let off = greys.iter().map(|grey| (255.0 * (sample(*grey) - shown(DVec3::splat(*grey)).x)).powi(2));
            Ok(Measured::exact((off.sum::<f64>() / greys.len() as f64).sqrt()))
        })
    };
    let log = |grey: f64| log_c_from_linear(DVec3::splat(grey)).x;
    let light = |x: f64| linear_from_log_c(DVec3::splat(x)).x.max(0.0);
    let choices = vec![
        choice("logarithmic", log, light, true).found_in(|_| true),
        choice("logarithmic, half a texel off", log, light, false),
        choice("linear", |grey| grey / BRIGHTEST, |x| x * BRIGHTEST, true),
    ];
    let what = "Coordinates of a color table with 32 entries per axis: the default look of grays over sixteen stops.";
    formula("table-coordinates", what, "the look itself.", "8-bit steps, RMS", choices)
}

fn oetf() -> Technique {
    let choice = |name: &str, curve: fn(f64) -> f64| {
        number(name, move |_: &Gpu| {
            let apart =
                (0..=4096).map(|i| f64::from(i) / 4096.0).map(|x| 255.0 * (curve(x) - srgb_from_linear_channel(x)));
            Ok(Measured::exact(apart.map(f64::abs).fold(0.0, f64::max)))
        })
    };
    let three_roots = |x: f64| {
        let s1 = x.sqrt();
        let s2 = s1.sqrt();
        0.585_122_381 * s1 + 0.783_140_355 * s2 - 0.368_262_736 * s2.sqrt()
    };
    let choices = vec![
        choice("piecewise", srgb_from_linear_channel).counted("srgb_from_linear_channel", false),
        choice("three roots", three_roots),
        choice("x^(1/2.2)", |x| x.powf(1.0 / 2.2)),
        choice("√x", f64::sqrt),
    ];
    formula(
        "transfer",
        "Transfer function of the display: largest error.",
        "sRGB, IEC 61966-2-1.",
        "8-bit steps, largest",
        choices,
    )
}

fn dither() -> Technique {
    const SIDE: usize = 128;
    let choice = |name: &str, offset: fn(usize, usize) -> f64| {
        number(name, move |_: &Gpu| {
            // A ramp over four 8-bit steps, rounded, and the difference that remains after a blur.
            let ramp = |x: usize| 100.0 + 4.0 * (x as f64 + 0.5) / SIDE as f64;
            let apart = |x: usize, y: usize| (ramp(x) + offset(x, y)).round() - ramp(x);
            let weight = |d: i32| (-f64::from(d * d) / 8.0).exp();
            let total: f64 = (-6..=6).map(weight).sum::<f64>().powi(2);
            let mut squares = 0.0;
            let inner = 6..SIDE - 6;
            for y in inner.clone() {
                for x in inner.clone() {
                    let taps = (0..169).map(|i| (i % 13 - 6, i / 13 - 6));
                    let at = |a: usize, d: i32| (a as i32 + d) as usize;
                    let sum: f64 = taps.map(|(dx, dy)| weight(dx) * weight(dy) * apart(at(x, dx), at(y, dy))).sum();
                    squares += (sum / total).powi(2);
                }
            }
            Ok(Measured::exact((squares / (inner.len() * inner.len()) as f64).sqrt()))
        })
    };
    let [mut on, off] = [base("spheres"); 2];
    on.settings.post.dither = 1.0;
    let choices = vec![
        choice("none", |_, _| 0.0).timed(off).found_in(|f| f.settings.post.dither == 0.0),
        choice("interleaved gradient noise", |x, y| {
            255.0 * dither_offset(DVec2::new(x as f64, y as f64) + 0.5, 0, 255.0)
        })
        .timed(on)
        .counted("dither_offset", false)
        .found_in(|f| f.settings.post.dither > 0.0),
    ];
    let what = "Dithering against banding: root mean square error of a ramp over four 8-bit steps, rounded and blurred by σ = 2 pixels.";
    formula("dither", what, "the ramp.", "8-bit steps, RMS", choices)
}

fn post_passes() -> Technique {
    let one = base("spheres");
    pictures(
        "post-passes",
        "Post-processing in the color pass's shader, or in one pass per effect with radiance stored in between.",
        ("all effects in the color pass, which stores no radiance.", Truth::Frame(one)),
        one,
        &[
            ("in the color pass", Options(""), |f| !f.settings.split_post),
            ("a pass an effect", Options("split-post=on"), nowhere),
        ],
    )
}
