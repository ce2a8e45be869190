// Moment-based transparency: what surfaces in front of a distance let through, from four moments
// of where they absorb.
//
// Münstermann, Krumpen, Klein and Peters, "Moment-Based Order-Independent Transparency", I3D
// 2018. Absorbance is -ln(1 - alpha), so absorbances in a row add up. The first four power
// moments of absorbance over distance bound what lies in front of a distance; the estimate lies
// between the bounds, by the overestimation.

/// Absorbance of an opaque surface, with a transmittance of e^-10.
const OPAQUE_ABSORBANCE: f32 = 10.0;

/// Total absorbance below which surfaces count as fully transparent.
const LEAST_ABSORBANCE: f32 = 0.001;

/// Returns the absorbance of a surface with this alpha, 0…10.
fn absorbance(alpha: f32) -> f32 {
    return min(-log(max(1.0 - alpha, 1e-5)), OPAQUE_ABSORBANCE);
}

/// Returns the transmittance of surfaces with this total absorbance.
fn transmittance_of(total: f32) -> f32 {
    return select(exp(-max(total, 0.0)), 0.0, total >= OPAQUE_ABSORBANCE);
}

/// Distance ahead in m as the logarithm between the ends of a range: -1…1. `range` has the scale
/// and the offset of the binary logarithm.
fn warped_distance(distance_m: f32, range: vec2<f32>) -> f32 {
    return clamp(log2(max(distance_m, 1e-6)) * range.x + range.y, -1.0, 1.0);
}

/// The first four powers.
fn power_moments(at: f32) -> vec4<f32> {
    let square = at * at;
    return vec4<f32>(at, square, square * at, square * square);
}

/// Returns `x` if its magnitude is at least `least`; otherwise `least` with the sign of `x`.
fn divisor(x: f32, least: f32) -> f32 {
    return select(x, select(least, -least, x < 0.0), abs(x) < least);
}

/// Share of the light that passes all surfaces nearer than `at`. `total` is the sum of their
/// absorbances, `moments` the sums of absorbances times powers. `bias` mixes in moments of an even
/// distribution, against rounding. `overestimation` is the share of absorbance at `at` itself that
/// counts as in front.
fn moment_transmittance(
    total: f32,
    moments: vec4<f32>,
    at: f32,
    bias: f32,
    overestimation: f32,
) -> f32 {
    if total < LEAST_ABSORBANCE {
        return 1.0;
    }
    let b = mix(moments / total, vec4<f32>(0.0, 0.375, 0.0, 0.375), bias);
    // Cholesky factors of the Hankel matrix of (1, b).
    let variance = max(b.y - b.x * b.x, 1e-7);
    let skew = b.z - b.x * b.y;
    let l = skew / variance;
    let rest = max(b.w - b.y * b.y - skew * l, 1e-8);
    // Its inverse times (1, at, at²): coefficients of the kernel polynomial.
    var c = vec3<f32>(1.0, at, at * at);
    c.y -= b.x;
    c.z -= b.y + l * c.y;
    c.y /= variance;
    c.z /= rest;
    c.y -= l * c.z;
    c.x -= dot(c.yz, b.xy);
    // Its roots: where else absorbance is taken to be.
    let leading = divisor(c.z, 1e-6);
    let half_p = 0.5 * c.y / leading;
    let q = c.x / leading;
    let root = sqrt(max(half_p * half_p - q, 0.0));
    let larger = select(-half_p - root, -half_p + root, half_p < 0.0);
    let smaller = q / divisor(larger, 1e-6);
    // The polynomial through the share that counts at each of the three, summed by the moments.
    let f0 = overestimation;
    let f1 = select(0.0, 1.0, larger < at);
    let f2 = select(0.0, 1.0, smaller < at);
    let f01 = (f1 - f0) / divisor(larger - at, 1e-6);
    let f12 = (f2 - f1) / divisor(smaller - larger, 1e-6);
    let f012 = (f12 - f01) / divisor(smaller - at, 1e-6);
    let slope = f01 - f012 * larger;
    let share = f0 - slope * at + (slope - f012 * at) * b.x + f012 * b.y;
    return exp(-total * clamp(share, 0.0, 1.0));
}
