// Reconstruction of view-space positions from depth.
//
// View space: the eye at the origin, x to the right, y up, the camera looks along -z. A central
// or parallel projection, of a window that may be off the middle, takes (x, y, z) to clip space as
//
//   x' = scale.x·x + slide.x·z + offset.x      z' = depth.x·z + depth.y
//   y' = scale.y·y + slide.y·z + offset.y      w' = depth.z·z + depth.w

/// Coefficients of a projection. Mirrored by `layout::Projection`.
struct Projection {
    /// Coefficients of z and w in clip space.
    depth: vec4<f32>,
    scale: vec2<f32>,
    slide: vec2<f32>,
    offset: vec2<f32>,
}

/// z in view space, in m, of a depth. The far plane may be infinitely far away: then depth 0 has
/// no z, and callers must not ask (hard case 30).
fn view_z(depth: f32, row: vec4<f32>) -> f32 {
    return (row.y - depth * row.w) / (depth * row.z - row.x);
}

/// Position in view space, in m, of a depth at normalized device coordinates.
fn view_position(ndc: vec2<f32>, depth: f32, p: Projection) -> vec3<f32> {
    let z = view_z(depth, p.depth);
    let w = p.depth.z * z + p.depth.w;
    return vec3<f32>((ndc * w - p.slide * z - p.offset) / p.scale, z);
}

/// Normalized device coordinates and depth of a position in view space before the eye.
fn ndc_from_view(position: vec3<f32>, p: Projection) -> vec3<f32> {
    let z = position.z;
    let w = max(p.depth.z * z + p.depth.w, 1e-6);
    let xy = p.scale * position.xy + p.slide * z + p.offset;
    return vec3<f32>(xy, p.depth.x * z + p.depth.y) / w;
}
