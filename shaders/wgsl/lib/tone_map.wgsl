// Tone curves: linear Rec.709 light, scaled by exposure, to display light in [0, 1].
//
// Inputs are clamped to [0, 100] first: a negative makes a rational curve fold back (-0.2
// becomes 0.79), a huge one overflows to Inf/Inf (hard case 47). Every curve has long
// reached white by 100.

/// The curves by number; `layout::ToneMap` mirrors them.
const TONE_MAP_LINEAR: u32 = 0u;
const TONE_MAP_ACES: u32 = 1u;
const TONE_MAP_FILMIC: u32 = 2u;
const TONE_MAP_NEUTRAL: u32 = 3u;
const TONE_MAP_ACES_LEGACY: u32 = 4u;
const TONE_MAP_LINEAR_2020: u32 = 5u;

/// Cut off at one.
fn tone_map_linear(color: vec3<f32>) -> vec3<f32> {
    return saturate(color);
}

/// Cut off at one in the primaries of Rec.2020 (matrices of ITU-R BT.2087), so that bright
/// saturated colors turn paler instead of another hue; what lies within Rec.709 stays.
fn tone_map_linear_2020(color: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(100.0));
    let wide = saturate(vec3<f32>(
        dot(c, vec3<f32>(0.627404, 0.329283, 0.043313)),
        dot(c, vec3<f32>(0.069097, 0.919540, 0.011362)),
        dot(c, vec3<f32>(0.016391, 0.088013, 0.895595)),
    ));
    return saturate(vec3<f32>(
        dot(wide, vec3<f32>(1.660491, -0.587641, -0.072850)),
        dot(wide, vec3<f32>(-0.124550, 1.132900, -0.008349)),
        dot(wide, vec3<f32>(-0.018151, -0.100579, 1.118730)),
    ));
}

/// ACES 1.0 reference rendering and output transform for a 100 nit Rec.709 display, as fitted
/// by Stephen Hill (BakingLab, 2016): into the rendering primaries with desaturation, one
/// rational curve, back. Against the true transform 0.6 codes RMS on greys, 1.4 on colors.
fn tone_map_aces(color: vec3<f32>) -> vec3<f32> {
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

/// The same with its input brightened by 1/0.6, which undoes the dimming of cinema for screens in
/// lit rooms; Filament's default.
fn tone_map_aces_legacy(color: vec3<f32>) -> vec3<f32> {
    return tone_map_aces(color / 0.6);
}

/// Narkowicz' per-channel fit of the ACES curve (2015), without his factor 0.6: brighter, and
/// hues turn toward the primaries. The cheapest of them.
fn tone_map_filmic(color: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(100.0));
    return saturate((c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14));
}

/// Khronos PBR Neutral (2024): base colors up to 0.76 come out as they are, highlights are
/// compressed and desaturated. For product views.
fn tone_map_neutral(color: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(100.0));
    let lowest = min(c.x, min(c.y, c.z));
    let offset = select(0.04, lowest - 6.25 * lowest * lowest, lowest < 0.08);
    let shifted = c - offset;
    let peak = max(shifted.x, max(shifted.y, shifted.z));
    if peak < 0.76 {
        return shifted;
    }
    let new_peak = 1.0 - 0.24 * 0.24 / (peak + 0.24 - 0.76);
    let white = 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0);
    return saturate(mix(shifted * (new_peak / peak), vec3<f32>(new_peak), white));
}

/// The curve of the given number; an unknown number is linear.
fn tone_map(color: vec3<f32>, curve: u32) -> vec3<f32> {
    if curve == TONE_MAP_ACES {
        return tone_map_aces(color);
    }
    if curve == TONE_MAP_FILMIC {
        return tone_map_filmic(color);
    }
    if curve == TONE_MAP_NEUTRAL {
        return tone_map_neutral(color);
    }
    if curve == TONE_MAP_LINEAR_2020 {
        return tone_map_linear_2020(color);
    }
    if curve == TONE_MAP_ACES_LEGACY {
        return tone_map_aces_legacy(color);
    }
    return tone_map_linear(color);
}
