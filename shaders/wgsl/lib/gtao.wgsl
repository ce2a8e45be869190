// Ground-truth ambient occlusion (Jiménez et al., "Practical Real-Time Strategies for Accurate
// Indirect Occlusion", 2016). The hemisphere is divided into slices that contain the view
// direction. Each slice finds the horizon on both sides and integrates the light between them
// exactly.
//
// Angles in a slice start at the view direction, positive on the side where the slice points; `n`
// is the angle of the projected normal. All in f32: half floats resolve angles only to a
// thousandth.

import package::lib::math::PI;

/// Returns the arc cosine of x clamped to ±1 (hard case 35), with an error of at most 7e-5.
/// Abramowitz and Stegun 4.4.45.
fn acos_held(x: f32) -> f32 {
    let a = min(abs(x), 1.0);
    let from_one = 1.5707288 + a * (-0.2121144 + a * (0.0742610 - 0.0187293 * a));
    let angle = sqrt(1.0 - a) * from_one;
    return select(angle, PI - angle, x < 0.0);
}

/// Integrates cosine-weighted light from the view direction to the signed angle h, including the
/// solid angle of the slice.
fn slice_arc(h: f32, n: f32) -> f32 {
    return 0.25 * (cos(n) - cos(2.0 * h - n) + 2.0 * h * sin(n));
}

/// Integrates cosine-weighted light over a whole slice: from a right angle below the normal to one
/// above.
fn slice_whole(n: f32) -> f32 {
    return cos(n) + n * sin(n);
}

/// Returns the share of a slice's light from below the angle, 0…1.
fn slice_share(angle: f32, n: f32) -> f32 {
    let held = clamp(angle, n - 0.5 * PI, n + 0.5 * PI);
    let below = slice_arc(n - 0.5 * PI, n) + sign(held) * slice_arc(held, n);
    return saturate(below / slice_whole(n));
}

/// Returns the mean direction of the light between the horizons h0 < h1: x along the slice, y
/// toward the viewer; not normalized.
fn slice_bent(h0: f32, h1: f32, n: f32) -> vec2<f32> {
    let x = 6.0 * (sin(h0 - n) + sin(h1 - n)) - sin(3.0 * h0 - n) - sin(3.0 * h1 - n)
        + 16.0 * sin(n) - 3.0 * (sin(h0 + n) + sin(h1 + n));
    let y = 8.0 * cos(n) - cos(3.0 * h0 - n) - cos(3.0 * h1 - n)
        - 3.0 * (cos(h0 + n) + cos(h1 + n));
    return vec2<f32>(x, y) / 12.0;
}

/// Returns a mask of those of 32 sectors of equal light that lie between two shares of a slice.
/// `jitter` in [0, 1) rounds partial sectors, so that the mean is exact (Therrien, Levesque and
/// Gilet, "Screen Space Indirect Lighting with Visibility Bitmask", 2023).
fn sector_bits(low: f32, high: f32, jitter: f32) -> u32 {
    let first = u32(clamp(floor(32.0 * low + jitter), 0.0, 32.0));
    let last = u32(clamp(floor(32.0 * high + jitter), 0.0, 32.0));
    if last <= first {
        return 0u;
    }
    let count = last - first;
    if count == 32u {
        return 0xffffffffu;
    }
    return ((1u << count) - 1u) << first;
}

/// Returns the rotation of a texel's slices, 0…1 of the angle between two: sixteen values in every
/// 4×4 block of texels.
fn slice_turn(texel: vec2<i32>) -> f32 {
    return f32((((texel.x + texel.y) & 3) << 2u) + (texel.x & 3)) / 16.0;
}

/// Returns the step offset of a texel, 0…1 of a step: four values.
fn slice_offset(texel: vec2<i32>) -> f32 {
    return f32((texel.y - texel.x) & 3) / 4.0;
}
