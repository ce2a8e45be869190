// Normals of what a depth texture holds. Depth as it is stored is linear on the screen over a
// plane, whatever the projection; so a plane continues exactly.

/// Whether the surface at `here` goes on toward larger coordinates rather than toward smaller
/// ones: `back` has the depths at -2 and -1, `ahead` those at +1 and +2. A side is as far off as
/// its own line through two texels, or where it is two texels wide, as its nearer texel.
fn continues_ahead(back: vec2<f32>, here: f32, ahead: vec2<f32>) -> bool {
    let behind = min(abs(2.0 * back.y - back.x - here), abs(back.y - here));
    let before = min(abs(2.0 * ahead.x - ahead.y - here), abs(ahead.x - here));
    return before < behind;
}
