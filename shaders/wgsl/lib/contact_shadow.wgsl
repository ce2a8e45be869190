// Contact shadows: occlusion of a short ray toward the light by screen-space depth.

/// Returns true if a ray at this reversed depth is behind a surface, by at most two tolerances;
/// farther behind, it may pass under the surface. The background (0) occludes nothing.
fn contact_hides(surface: f32, ray: f32, tolerance: f32) -> bool {
    return abs(tolerance - (surface - ray)) < tolerance;
}

/// Returns the weight of a contact shadow by its screen texture coordinates. It fades toward the
/// edges, outside of which depth is unknown (hard case 36).
fn contact_fade(uv: vec2<f32>) -> f32 {
    let edge = max(12.0 * abs(uv - 0.5) - 5.0, vec2<f32>(0.0));
    return saturate(1.0 - dot(edge, edge));
}
