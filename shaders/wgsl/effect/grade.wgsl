// Effect: color grading (lib/grading.wgsl).

import package::lib::grading::{
    LOG_C_GREY, log_c_from_linear, linear_from_log_c, slope_offset_power, contrast_about,
    saturation, vibrance,
};

/// Settings of `grade`. Mirrored by `layout::GradingUniforms`.
struct GradingUniforms {
    /// Adapts linear Rec.709 light from the white of the scene to that of the display.
    white_balance: mat3x3<f32>,
    slope: vec3<f32>,
    /// About 18 % grey, in LogC; 1 changes nothing.
    contrast: f32,
    offset: vec3<f32>,
    /// 1 changes nothing, 0 is grey but for reds.
    vibrance: f32,
    power: vec3<f32>,
    /// 1 changes nothing, 0 is grey.
    saturation: f32,
}

@group(0) @binding(0) var<uniform> grading: GradingUniforms;

/// Scene-referred linear light, graded and not negative; alpha stays.
fn grade(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let balanced = max(grading.white_balance * color.rgb, vec3<f32>(0.0));
    let decided = slope_offset_power(
        log_c_from_linear(balanced),
        grading.slope,
        grading.offset,
        grading.power,
    );
    let linear = linear_from_log_c(contrast_about(decided, LOG_C_GREY, grading.contrast));
    let vivid = saturation(vibrance(linear, grading.vibrance), grading.saturation);
    return vec4<f32>(max(vivid, vec3<f32>(0.0)), color.a);
}
