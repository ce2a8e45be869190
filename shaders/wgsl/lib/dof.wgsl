// Depth of field: circles of confusion, and weights of a gather (Jimenez 2014; Abadie, "Life of a
// Bokeh", 2018). Radii are in pixels, negative in the foreground.

/// Radius of the circle of confusion, in pixels, below which a pixel is in focus.
const COC_IN_FOCUS: f32 = 1.0;

/// Returns the reciprocal of the distance from the eye's plane, in 1/m, for a reversed depth; `row`
/// as in lib/unproject.wgsl. 0 at infinity.
fn inverse_distance(depth: f32, row: vec4<f32>) -> f32 {
    return (depth * row.z - row.x) / (depth * row.w - row.y);
}

/// Returns the signed radius of the circle of confusion at the reciprocal distance `per_m`.
/// `focus_m` is the focus distance, `most` the maximum for foreground and background, and
/// `scale_px` the diameter at infinity.
fn coc_radius(per_m: f32, focus_m: f32, scale_px: f32, most: vec2<f32>) -> f32 {
    let radius = clamp(0.5 * scale_px * (1.0 - focus_m * per_m), -most.x, most.y);
    return select(radius, 0.0, abs(radius) < COC_IN_FOCUS);
}

/// Returns the opacity of an out-of-focus pixel, 0…1.
fn coc_opacity(radius: f32) -> f32 {
    return saturate(abs(radius) - COC_IN_FOCUS);
}

/// Returns the coverage of a point at this distance by a circle of confusion, 0…1; `texel_px` is
/// the size of a tap.
fn coc_reaches(radius: f32, distance_px: f32, texel_px: f32) -> f32 {
    return saturate((radius - distance_px) / texel_px + 0.5);
}

/// Returns the light density inside a circle of confusion: 1024 over its area in units of π.
fn coc_density(radius: f32, texel_px: f32) -> f32 {
    return 1024.0 / max(radius * radius, 2.0 * texel_px);
}

/// Returns the mip level for taps on `rings` rings within a radius in texels, so that no texel is
/// missed.
fn ring_level(rings: f32, radius_texels: f32) -> f32 {
    return max(floor(log2(max(radius_texels, 1e-3) / (rings - 0.5)) + 0.5), 0.0);
}
