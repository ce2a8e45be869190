// Effect: grading, tone curve and encoding in one step, from a 3D table.

import package::lib::table::table_coordinates;

/// sRGB encoded colors; the axes are the scene color in LogC.
@group(0) @binding(0) var grading_table: texture_3d<f32>;
@group(0) @binding(1) var grading_sampler: sampler;

/// Returns sRGB encoded display light in [0, 1]; alpha is unchanged.
fn look_up(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let entries = f32(textureDimensions(grading_table).x);
    let at = table_coordinates(color.rgb, entries);
    return vec4<f32>(textureSampleLevel(grading_table, grading_sampler, at, 0.0).rgb, color.a);
}
