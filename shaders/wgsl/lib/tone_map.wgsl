// Tone curves: linear Rec.709 light, scaled by exposure, to linear display light in [0, 1].
// Only `tone_map_mobile` gives encoded light.
//
// Inputs are clamped first: a negative makes a rational curve fold back (-0.2 becomes 0.79), a
// huge one overflows to Inf/Inf (hard case 47). Curves of one channel have long reached white by
// 100.

import package::lib::aces::tone_aces;
import package::lib::agx::{AGX_GOLDEN, AGX_PLAIN, AGX_PUNCHY, tone_agx};
import package::lib::display_range::tone_display_range;
import package::lib::gamut::map_into_gamut;
import package::lib::grading::{positive_power, scale_luminance};
import package::lib::gt7::tone_gt7;
import package::lib::primaries::{rec2020_from_rec709, rec709_from_rec2020};
import package::lib::srgb::linear_from_srgb;

/// The curves by number; `layout::ToneMap` mirrors them.
const TONE_MAP_LINEAR: u32 = 0u;
const TONE_MAP_HILL: u32 = 1u;
const TONE_MAP_FILMIC: u32 = 2u;
const TONE_MAP_NEUTRAL: u32 = 3u;
const TONE_MAP_ACES_LEGACY: u32 = 4u;
const TONE_MAP_LINEAR_2020: u32 = 5u;
const TONE_MAP_ACES: u32 = 6u;
const TONE_MAP_AGX: u32 = 7u;
const TONE_MAP_AGX_GOLDEN: u32 = 8u;
const TONE_MAP_AGX_PUNCHY: u32 = 9u;
const TONE_MAP_GT7: u32 = 10u;
const TONE_MAP_GENERIC: u32 = 11u;
const TONE_MAP_DISPLAY_RANGE: u32 = 12u;
const TONE_MAP_MOBILE: u32 = 13u;

/// ACES 1.0 reference rendering and output transform for a 100 nit Rec.709 display, as fitted
/// by Stephen Hill (BakingLab, 2016): into the rendering primaries with desaturation, one
/// rational curve, back. Against the true transform 0.6 codes RMS on greys, 1.4 on colors.
fn tone_map_hill(color: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(100.0));
    let v = vec3<f32>(
        dot(c, vec3<f32>(0.59719, 0.35458, 0.04823)),
        dot(c, vec3<f32>(0.07600, 0.90834, 0.01566)),
        dot(c, vec3<f32>(0.02840, 0.13383, 0.83777)),
    );
    let fit = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return saturate(vec3<f32>(
        dot(fit, vec3<f32>(1.60475, -0.53108, -0.07367)),
        dot(fit, vec3<f32>(-0.10208, 1.10813, -0.00605)),
        dot(fit, vec3<f32>(-0.00327, -0.07276, 1.07602)),
    ));
}

/// Narkowicz' per-channel fit of the ACES curve (2015), without his factor 0.6: brighter, and
/// hues turn toward the primaries. The cheapest of them.
fn tone_map_filmic(color: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(100.0));
    return saturate((c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14));
}

/// sRGB encoded display light by one division a channel: the transfer function is part of the
/// curve, so no encoding may follow (Guy and Agopian, "High Performance Mobile Rendering", 2018).
/// Close to `tone_map_filmic` and its encoding.
fn tone_map_mobile(color: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(100.0));
    return saturate(c / (c + 0.155) * 1.019);
}

/// Khronos PBR Neutral (2024): base colors up to 0.76 come out as they are, highlights are
/// compressed and desaturated. For product views.
fn tone_map_neutral(color: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(100.0));
    let lowest = min(c.x, min(c.y, c.z));
    let offset = select(0.04, lowest - 6.25 * lowest * lowest, lowest < 0.08);
    let shifted = c - offset;
    let peak = max(shifted.x, max(shifted.y, shifted.z));
    // No branch: where conditions read many uniforms, Mesa 22.3's software driver crashes.
    let high = max(peak, 0.76);
    let new_peak = 1.0 - 0.24 * 0.24 / (high + 0.24 - 0.76);
    let white = 1.0 - 1.0 / (0.15 * (high - new_peak) + 1.0);
    let compressed = saturate(mix(shifted * (new_peak / high), vec3<f32>(new_peak), white));
    return select(compressed, shifted, peak < 0.76);
}

/// A curve of one channel by four numbers (Lottes, 2016), given as contrast, input scale and
/// output scale: `layout::GenericCurve` has them.
fn tone_generic(color: vec3<f32>, curve: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(65504.0));
    let x = vec3<f32>(
        positive_power(c.x, curve.x),
        positive_power(c.y, curve.x),
        positive_power(c.z, curve.x),
    );
    return curve.z * x / (x + curve.y);
}

/// Returns true if input and output of a curve are in Rec.2020, as for Filament's own curves.
/// Khronos', Hill's, Narkowicz' and the mobile curve use Rec.709.
fn tone_in_rec2020(curve: u32) -> bool {
    return curve >= TONE_MAP_ACES_LEGACY && curve != TONE_MAP_MOBILE;
}

/// Display light of a color, both in the primaries of the curve; an unknown number cuts off at
/// one. `generic` is for TONE_MAP_GENERIC.
fn tone_curve(color: vec3<f32>, curve: u32, generic: vec3<f32>) -> vec3<f32> {
    switch curve {
        case TONE_MAP_HILL: { return tone_map_hill(color); }
        case TONE_MAP_FILMIC: { return tone_map_filmic(color); }
        case TONE_MAP_NEUTRAL: { return tone_map_neutral(color); }
        case TONE_MAP_ACES_LEGACY: { return tone_aces(color, 1.0 / 0.6); }
        case TONE_MAP_ACES: { return tone_aces(color, 1.0); }
        case TONE_MAP_AGX: { return tone_agx(color, AGX_PLAIN); }
        case TONE_MAP_AGX_GOLDEN: { return tone_agx(color, AGX_GOLDEN); }
        case TONE_MAP_AGX_PUNCHY: { return tone_agx(color, AGX_PUNCHY); }
        case TONE_MAP_GT7: { return tone_gt7(color); }
        case TONE_MAP_GENERIC: { return tone_generic(color, generic); }
        case TONE_MAP_DISPLAY_RANGE: { return tone_display_range(color); }
        case TONE_MAP_MOBILE: { return linear_from_srgb(tone_map_mobile(color)); }
        default: { return saturate(color); }
    }
}

/// Linear Rec.709 display light of linear Rec.709 light. `by_luminance` puts luminance alone
/// through the curve and keeps hues; `into_gamut` moves what the display cannot show to where it
/// can, instead of cutting channels off.
fn tone_map(
    color: vec3<f32>,
    curve: u32,
    generic: vec3<f32>,
    by_luminance: bool,
    into_gamut: bool,
) -> vec3<f32> {
    let wide = tone_in_rec2020(curve);
    let own = select(color, rec2020_from_rec709(color), wide);
    var shown: vec3<f32>;
    if by_luminance {
        let rec2020 = vec3<f32>(0.2627002, 0.6779981, 0.0593017);
        let weights = select(vec3<f32>(0.2126, 0.7152, 0.0722), rec2020, wide);
        let positive = clamp(own, vec3<f32>(0.0), vec3<f32>(65504.0));
        let grey = vec3<f32>(dot(positive, weights));
        shown = scale_luminance(positive, weights, tone_curve(grey, curve, generic).y);
    } else {
        shown = tone_curve(own, curve, generic);
    }
    shown = select(shown, rec709_from_rec2020(shown), wide);
    if into_gamut {
        shown = map_into_gamut(shown);
    }
    return saturate(shown);
}
