// Effect: grading, tone curve and encoding in one step, with one curve per independent channel.

import package::lib::table::table_coordinates;

/// sRGB encoded channels, by the scene channel in LogC.
@group(0) @binding(0) var grading_curves: texture_2d<f32>;
@group(0) @binding(1) var curves_sampler: sampler;

/// Returns sRGB encoded display light in [0, 1]; alpha is unchanged.
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
