//! Conversion of stated color grading to our settings.

use super::document::{ColorGrading, GradingFormat, GradingQuality, ToneMapping, Vignette};
use framegraph_passes::grading::{GradeBy, Look, TableDesc, TableFormat};
use framegraph_shaders::layout::{EdgeFade, Grading, ToneMap};
use glam::{Vec3, Vec4};

/// Converts color grading; missing options have Filament's defaults.
pub fn look(stated: &ColorGrading) -> Look {
    let usual = Grading::NEUTRAL;
    let number = |value: Option<f64>, default: f32| value.map_or(default, |x| x as f32);
    let three = |v: [f64; 3]| Vec3::from_array(v.map(|x| x as f32));
    let four = |v: [f64; 4]| Vec4::from_array(v.map(|x| x as f32));
    let rows = |rows: Option<[[f64; 3]; 3]>, default: [Vec3; 3]| rows.map_or(default, |rows| rows.map(three));
    let [temperature, tint] = stated.white_balance.unwrap_or_default().map(|x| x as f32);
    let tones = [usual.shadows, usual.midtones, usual.highlights, usual.ranges];
    let [shadows, midtones, highlights, ranges] =
        stated.shadows_midtones_highlights.map_or(tones, |tones| tones.map(four));
    let [slope, offset, power] = rows(stated.slope_offset_power, [usual.slope, usual.offset, usual.power]);
    let [shadow_gamma, middle, highlight_scale] =
        rows(stated.curves, [usual.shadow_gamma, usual.middle, usual.highlight_scale]);
    Look {
        grading: Grading {
            exposure_ev: number(stated.exposure, 0.0),
            night: number(stated.night_adaptation, 0.0),
            temperature,
            tint,
            mixer: rows(stated.channel_mixer, usual.mixer),
            shadows,
            midtones,
            highlights,
            ranges,
            slope,
            offset,
            power,
            contrast: number(stated.contrast, 1.0),
            vibrance: number(stated.vibrance, 1.0),
            saturation: number(stated.saturation, 1.0),
            shadow_gamma,
            middle,
            highlight_scale,
        },
        tone_map: match stated.tone_mapping {
            ToneMapping::Linear => ToneMap::Linear2020,
            ToneMapping::Aces => ToneMap::Aces,
            ToneMapping::AcesLegacy => ToneMap::AcesLegacy,
            ToneMapping::Filmic => ToneMap::Filmic,
            ToneMapping::DisplayRange => ToneMap::DisplayRange,
        },
        luminance_scaling: stated.luminance_scaling == Some(true),
        gamut_mapping: stated.gamut_mapping == Some(true),
    }
}

/// Returns the size and format of the reference's color table.
pub fn by(stated: &ColorGrading) -> GradeBy {
    let (entries, format) = match stated.quality.unwrap_or(GradingQuality::Medium) {
        GradingQuality::Low => (16, TableFormat::Rgb10),
        GradingQuality::Medium => (32, TableFormat::Rgb10),
        GradingQuality::High => (32, TableFormat::Half),
        GradingQuality::Ultra => (64, TableFormat::Half),
    };
    let format = match stated.format {
        None => format,
        Some(GradingFormat::Integer) => TableFormat::Rgb10,
        Some(GradingFormat::Float) => TableFormat::Half,
    };
    GradeBy::Table(TableDesc { entries, format })
}

/// Converts a vignette; `None` if it is off.
pub fn edge_fade(stated: &Vignette) -> Option<EdgeFade> {
    let usual = EdgeFade::DEFAULT;
    let number = |value: Option<f64>, default: f32| value.map_or(default, |x| x as f32);
    stated.enabled.then(|| EdgeFade {
        middle: number(stated.mid_point, usual.middle),
        roundness: number(stated.roundness, usual.roundness),
        feather: number(stated.feather, usual.feather),
        color: stated.color.map_or(usual.color, |[r, g, b, _]| [r, g, b].map(|x| x as f32)),
        multiple_px: 16,
    })
}

/// Returns the key of the first invalid number.
pub fn wrong(stated: &ColorGrading) -> Option<&'static str> {
    let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite() && x.abs() <= 1e6);
    let g = stated;
    let one = |x: Option<f64>| finite(&[x.unwrap_or(0.0)]);
    let rows = |rows: Option<[[f64; 3]; 3]>| finite(rows.unwrap_or_default().as_flattened());
    let checks = [
        ("exposure", g.exposure.is_none_or(|ev| (-32.0..=32.0).contains(&ev))),
        ("nightAdaptation", one(g.night_adaptation)),
        ("whiteBalance", finite(&g.white_balance.unwrap_or_default())),
        ("channelMixer", rows(g.channel_mixer)),
        ("shadowsMidtonesHighlights", finite(g.shadows_midtones_highlights.unwrap_or_default().as_flattened())),
        ("slopeOffsetPower", rows(g.slope_offset_power)),
        ("contrast", one(g.contrast)),
        ("vibrance", one(g.vibrance)),
        ("saturation", one(g.saturation)),
        ("curves", rows(g.curves)),
    ];
    checks.into_iter().find(|(_, sound)| !sound).map(|(key, _)| key)
}
