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

/// Returns `continues_ahead` for a texel of a texture whose last texel is `last`, with neighbors at
/// steps of `axis`. The repeated edge texel does not continue the surface.
fn continues_ahead_inside(
    texel: vec2<i32>,
    axis: vec2<i32>,
    last: vec2<i32>,
    back: vec2<f32>,
    here: f32,
    ahead: vec2<f32>,
) -> bool {
    let at_start = any(texel - axis < vec2<i32>(0));
    let at_end = any(texel + axis > last);
    return at_start || (!at_end && continues_ahead(back, here, ahead));
}
