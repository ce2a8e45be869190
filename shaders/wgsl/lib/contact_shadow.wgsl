// Contact shadows: what of a short ray toward the light is hidden by the depth that the picture
// shows.

/// Whether a ray at this reversed depth is behind a surface of this depth, and by no more than two
/// tolerances: what lies farther behind may pass under it. Where nothing is (0) nothing hides.
fn contact_hides(surface: f32, ray: f32, tolerance: f32) -> bool {
    return abs(tolerance - (surface - ray)) < tolerance;
}

/// How much a contact shadow counts at texture coordinates of the picture: it fades toward the
/// edges, beyond which there is no depth (hard case 36).
fn contact_fade(uv: vec2<f32>) -> f32 {
    let edge = max(12.0 * abs(uv - 0.5) - 5.0, vec2<f32>(0.0));
    return saturate(1.0 - dot(edge, edge));
}
