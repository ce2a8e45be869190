// Exponential variance shadow maps: moments of warped depth, and what they say of visibility.
//
// Donnelly and Lauritzen, "Variance Shadow Maps", 2006; Lauritzen and McCool, "Layered Variance
// Shadow Maps", 2008, for the warp. Depth here is linear, 0 nearest the light and 1 farthest.

/// exp(c · (2 depth - 1)). With c up to 5.54 its square is a half float, with 42 a 32-bit float
/// (hard case 44).
fn warp_depth(depth: f32, exponent: f32) -> f32 {
    return exp(exponent * (2.0 * saturate(depth) - 1.0));
}

/// Returns the moments of a surface at this depth; `dx` and `dy` are its screen derivatives, whose
/// spread adds to the variance.
fn depth_moments(depth: f32, dx: f32, dy: f32, exponent: f32) -> vec2<f32> {
    let warped = warp_depth(depth, exponent);
    let slope = 2.0 * exponent * warped * vec2<f32>(dx, dy);
    // Beyond a half float's range the square would be infinite.
    let most = exp(2.0 * exponent);
    return vec2<f32>(warped, min(warped * warped + 0.25 * dot(slope, slope), most));
}

/// Returns the minimum variance of a receiver's warped depth: a share of its square, plus the
/// spread of depth within a texel. `texel_slope` is the change of depth along the receiver's plane
/// per texel.
fn least_variance(warped: f32, exponent: f32, floor_share: f32, texel_slope: vec2<f32>) -> f32 {
    let slope = 2.0 * exponent * warped;
    return warped * warped * floor_share
        + 0.25 * slope * slope * min(dot(texel_slope, texel_slope), 0.01);
}

/// Returns the upper bound of the light that reaches a receiver of this warped depth (Chebyshev's
/// one-sided inequality), with light bleeding reduced by `bleed`.
fn moment_visibility(moments: vec2<f32>, warped: f32, least: f32, bleed: f32) -> f32 {
    if warped <= moments.x {
        return 1.0;
    }
    let variance = max(moments.y - moments.x * moments.x, least);
    let behind = warped - moments.x;
    let most = variance / (variance + behind * behind);
    return saturate((most - bleed) / (1.0 - bleed));
}
