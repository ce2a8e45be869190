// One triangle that covers the screen.
//
// A triangle, not two: along the diagonal of a quad every 2×2 block of pixels would be shaded
// twice. Its corners are (-1, -1), (3, -1) and (-1, 3); nothing outside the screen is shaded.

/// Clip position of vertex 0, 1 or 2 at the given depth; with reversed Z, 0 is the far plane.
fn fullscreen_position(vertex: u32, depth: f32) -> vec4<f32> {
    let x = f32((vertex << 1u) & 2u) * 2.0 - 1.0;
    let y = f32(vertex & 2u) * 2.0 - 1.0;
    return vec4<f32>(x, y, depth, 1.0);
}

/// Texture coordinates of a clip position, (0, 0) at the top left.
fn uv_from_clip(clip: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(clip.x * 0.5 + 0.5, 0.5 - clip.y * 0.5);
}
