// Normals from depth textures. Stored depth is linear on the screen across a plane, for any
// projection, so planes extrapolate exactly.

/// Returns true if the surface at `here` continues toward larger coordinates rather than smaller
/// ones. `back` has the depths at -2 and -1, `ahead` those at +1 and +2. The error of a side is the
/// distance to its extrapolated line or, if smaller, to its nearer texel.
fn continues_ahead(back: vec2<f32>, here: f32, ahead: vec2<f32>) -> bool {
    let behind = min(abs(2.0 * back.y - back.x - here), abs(back.y - here));
    let before = min(abs(2.0 * ahead.x - ahead.y - here), abs(ahead.x - here));
    return before < behind;
}
