// Effect: grading, tone curve and encoding in one step where channels do not mix: a curve each.

import package::lib::table::table_coordinates;

/// Codes of sRGB of each channel by the channel before, in LogC.
@group(0) @binding(0) var grading_curves: texture_2d<f32>;
@group(0) @binding(1) var curves_sampler: sampler;

/// sRGB encoded display light in [0, 1]; alpha stays.
fn look_up_curves(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let entries = f32(textureDimensions(grading_curves).x);
    let at = table_coordinates(color.rgb, entries);
    let codes = vec3<f32>(
        textureSampleLevel(grading_curves, curves_sampler, vec2<f32>(at.x, 0.5), 0.0).r,
        textureSampleLevel(grading_curves, curves_sampler, vec2<f32>(at.y, 0.5), 0.0).g,
        textureSampleLevel(grading_curves, curves_sampler, vec2<f32>(at.z, 0.5), 0.0).b,
    );
    return vec4<f32>(codes, color.a);
}
