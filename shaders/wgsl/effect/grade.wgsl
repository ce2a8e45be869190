// Effect: color grading (lib/grading.wgsl).

import package::lib::grading::{
    contrast_about, linear_from_log_c, log_c_from_linear, saturation, slope_offset_power,
    toe_and_shoulder, tonal_shares, vibrance,
};
import package::lib::night::night_adaptation;

/// Settings of `grade`. Mirrored by `layout::GradingUniforms`.
struct GradingUniforms {
    /// Linear Rec.709 to the working primaries, including white balance.
    into: mat3x3<f32>,
    /// Channel mixer in the working primaries.
    mixer: mat3x3<f32>,
    /// Working primaries to linear Rec.709.
    out_of: mat3x3<f32>,
    /// Luminance limits at which shadows end and highlights begin.
    ranges: vec4<f32>,
    /// Luminance weights of the working primaries.
    weights: vec3<f32>,
    /// Factor on scene light: 2^EV.
    exposure: f32,
    shadows: vec3<f32>,
    /// Night adaptation, from 0 (day) to 1 (night).
    night: f32,
    midtones: vec3<f32>,
    /// Contrast around CONTRAST_PIVOT, in LogC; 1 changes nothing.
    contrast: f32,
    highlights: vec3<f32>,
    /// Vibrance; 1 changes nothing.
    vibrance: f32,
    slope: vec3<f32>,
    /// Saturation; 1 changes nothing, 0 is gray.
    saturation: f32,
    @size(16) offset: vec3<f32>,
    @size(16) power: vec3<f32>,
    @size(16) shadow_gamma: vec3<f32>,
    @size(16) middle: vec3<f32>,
    @size(16) highlight_scale: vec3<f32>,
}

/// LogC value that contrast leaves unchanged: 18 % gray in ACEScct.
const CONTRAST_PIVOT: f32 = 0.4135884;

/// Enables night adaptation.
override NIGHT: bool = false;

@group(0) @binding(0) var<uniform> grading: GradingUniforms;

/// Grades scene-referred linear light. Results outside Rec.709 have negative channels. Alpha is
/// unchanged.
fn grade(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let g = grading;
    // A grading table cannot hold negative values, so they count as black here, too.
    var c = clamp(color.rgb * g.exposure, vec3<f32>(0.0), vec3<f32>(65504.0));
    if NIGHT {
        c = night_adaptation(c, g.night);
    }
    c = g.mixer * max(g.into * c, vec3<f32>(0.0));
    let shares = tonal_shares(dot(c, g.weights), g.ranges);
    c *= shares.x * g.shadows + shares.y * g.midtones + shares.z * g.highlights;
    let decided = slope_offset_power(log_c_from_linear(c), g.slope, g.offset, g.power);
    c = linear_from_log_c(contrast_about(decided, CONTRAST_PIVOT, g.contrast));
    c = saturation(vibrance(c, g.weights, g.vibrance), g.weights, g.saturation);
    c = clamp(c, vec3<f32>(0.0), vec3<f32>(65504.0));
    c = vec3<f32>(
        toe_and_shoulder(c.x, g.shadow_gamma.x, g.middle.x, g.highlight_scale.x),
        toe_and_shoulder(c.y, g.shadow_gamma.y, g.middle.y, g.highlight_scale.y),
        toe_and_shoulder(c.z, g.shadow_gamma.z, g.middle.z, g.highlight_scale.z),
    );
    return vec4<f32>(g.out_of * c, color.a);
}
