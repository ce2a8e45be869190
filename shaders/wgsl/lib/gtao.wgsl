// Ground-truth ambient occlusion (Jiménez et al., "Practical Real-Time Strategies for Accurate
// Indirect Occlusion", 2016): the hemisphere cut into slices that contain the direction toward the
// viewer, the horizon found on either side in each, and the light between the horizons integrated
// exactly.
//
// In a slice, angles count from the direction toward the viewer, positive on the side where the
// slice points; `n` is that of the surface's normal, laid into the slice. All in f32: a half float
// has no more than a thousandth of an angle.

import package::lib::math::PI;

/// The arc cosine, off by up to 7e-5; arguments that rounding has taken past ±1 are held there
/// (hard case 35). Abramowitz and Stegun 4.4.45.
fn acos_held(x: f32) -> f32 {
    let a = min(abs(x), 1.0);
    let from_one = 1.5707288 + a * (-0.2121144 + a * (0.0742610 - 0.0187293 * a));
    let angle = sqrt(1.0 - a) * from_one;
    return select(angle, PI - angle, x < 0.0);
}

/// Cosine-weighted light from the viewer's direction to the angle h, of either sign; what the
/// solid angle of a slice is has been put in.
fn slice_arc(h: f32, n: f32) -> f32 {
    return 0.25 * (cos(n) - cos(2.0 * h - n) + 2.0 * h * sin(n));
}

/// The same over the whole slice: from a right angle below the normal to one above.
fn slice_whole(n: f32) -> f32 {
    return cos(n) + n * sin(n);
}

/// Share of a slice's light that comes from below the angle, 0…1.
fn slice_share(angle: f32, n: f32) -> f32 {
    let held = clamp(angle, n - 0.5 * PI, n + 0.5 * PI);
    let below = slice_arc(n - 0.5 * PI, n) + sign(held) * slice_arc(held, n);
    return saturate(below / slice_whole(n));
}

/// Direction in a slice from which the light between the horizons h0 < h1 comes in the mean: along
/// the slice in x, toward the viewer in y; not of unit length.
fn slice_bent(h0: f32, h1: f32, n: f32) -> vec2<f32> {
    let x = 6.0 * (sin(h0 - n) + sin(h1 - n)) - sin(3.0 * h0 - n) - sin(3.0 * h1 - n)
        + 16.0 * sin(n) - 3.0 * (sin(h0 + n) + sin(h1 + n));
    let y = 8.0 * cos(n) - cos(3.0 * h0 - n) - cos(3.0 * h1 - n)
        - 3.0 * (cos(h0 + n) + cos(h1 + n));
    return vec2<f32>(x, y) / 12.0;
}

/// The bits of those of 32 sectors of equal light that lie between two shares of a slice. `jitter`
/// in [0, 1) decides what becomes of parts of sectors, so that in the mean nothing is lost
/// (Therrien, Levesque and Gilet, "Screen Space Indirect Lighting with Visibility Bitmask", 2023).
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

/// Turn of the slices of a texel, 0…1 of the angle between two: sixteen, each in every block of
/// 4×4 texels.
fn slice_turn(texel: vec2<i32>) -> f32 {
    return f32((((texel.x + texel.y) & 3) << 2u) + (texel.x & 3)) / 16.0;
}

/// Offset of the steps of a texel, 0…1 of a step: four.
fn slice_offset(texel: vec2<i32>) -> f32 {
    return f32((texel.y - texel.x) & 3) / 4.0;
}
