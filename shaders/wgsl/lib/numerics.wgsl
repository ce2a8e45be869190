// Safe forms for inputs that break ordinary arithmetic.
//
// WGSL allows implementations to assume that NaN and infinity never occur (section 15.7.2), and
// compilers do. On one software Vulkan driver `x != x` is false for NaN, because naga emits an
// ordered comparison. These functions therefore test bits, and the rest of the library avoids
// creating such values.

/// Largest finite half float: what an RGBA16F target can hold.
const HALF_MAX: f32 = 65504.0;

/// Squared length below which a direction carries no information (hard case 8).
const DEGENERATE_LENGTH2: f32 = 1e-12;

/// Clamps x to [0, 65504]; NaN and -infinity give 0, +infinity gives 65504. The result is safe to
/// store in a half-float target and to filter.
fn saturate_half(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    let magnitude = bits & 0x7fffffffu;
    let large = select(min(x, HALF_MAX), HALF_MAX, magnitude >= 0x7f800000u);
    return select(large, 0.0, (magnitude > 0x7f800000u) | (bits != magnitude));
}

/// `saturate_half` of each channel of a color.
fn saturate_half3(color: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(saturate_half(color.x), saturate_half(color.y), saturate_half(color.z));
}

/// Returns true if all channels are finite.
fn all_finite3(color: vec3<f32>) -> bool {
    let magnitude = bitcast<vec3<u32>>(color) & vec3<u32>(0x7fffffffu);
    return all(magnitude < vec3<u32>(0x7f800000u));
}

/// Returns v / |v|, or `fallback` if v is too short. It first divides by the largest component, so
/// that squares of huge vectors do not overflow and squares of tiny ones do not underflow. Only
/// lengths below 1e-30 fall back.
fn normalize_or(v: vec3<f32>, fallback: vec3<f32>) -> vec3<f32> {
    let a = abs(v);
    let largest = max(a.x, max(a.y, a.z));
    let scaled = v / max(largest, 1e-30);
    return select(fallback, scaled * inverseSqrt(dot(scaled, scaled)), largest > 1e-30);
}
