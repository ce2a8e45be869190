// Depth of field: how large a point out of focus is seen, and what a tap of a gather counts
// (Jimenez 2014; Abadie, "Life of a Bokeh", 2018). Radii are in pixels of the picture, negative
// before what is in focus.

/// Circles of less than this radius are in focus.
const COC_IN_FOCUS: f32 = 1.0;

/// One over the distance from the eye's plane, in 1/m, of a reversed depth; `row` as in
/// lib/unproject.wgsl. 0 for what is infinitely far away.
fn inverse_distance(depth: f32, row: vec4<f32>) -> f32 {
    return (depth * row.z - row.x) / (depth * row.w - row.y);
}

/// Radius of the circle of confusion at `per_m`, one over a distance, where `focus_m` is in focus;
/// `most` is that of the foreground and of the background, and `scale_px` the diameter that what is
/// infinitely far away has.
fn coc_radius(per_m: f32, focus_m: f32, scale_px: f32, most: vec2<f32>) -> f32 {
    let radius = clamp(0.5 * scale_px * (1.0 - focus_m * per_m), -most.x, most.y);
    return select(radius, 0.0, abs(radius) < COC_IN_FOCUS);
}

/// How much of a pixel what is out of focus covers, 0…1.
fn coc_opacity(radius: f32) -> f32 {
    return saturate(abs(radius) - COC_IN_FOCUS);
}

/// Whether a circle reaches a place that far away, 0…1; `texel_px` is the size of a tap.
fn coc_reaches(radius: f32, distance_px: f32, texel_px: f32) -> f32 {
    return saturate((radius - distance_px) / texel_px + 0.5);
}

/// Light that a circle gives to a place within it, as 1024 over its area in units of π.
fn coc_density(radius: f32, texel_px: f32) -> f32 {
    return 1024.0 / max(radius * radius, 2.0 * texel_px);
}

/// Level that taps on `rings` rings within a radius of so many texels read, so that none is missed.
fn ring_level(rings: f32, radius_texels: f32) -> f32 {
    return max(floor(log2(max(radius_texels, 1e-3) / (rings - 0.5)) + 0.5), 0.0);
}
