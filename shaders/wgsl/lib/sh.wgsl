// Environment light from spherical harmonics of three bands.
//
// Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
// 2001. The nine coefficients come pre-convolved with the cosine lobe, divided by π and with
// the factors of the basis polynomials folded in, so that a Lambert surface of albedo a
// reflects a · irradiance_sh(n). Order of the polynomials: 1, y, z, x, xy, yz, 3z² - 1, zx,
// x² - y². The fourth band would buy nothing: the cosine's l = 3 coefficient is zero.

/// Σ sh[i]·p_i(n) with bands one and two scaled. Not clamped.
fn evaluate_sh(sh: array<vec4<f32>, 9>, n: vec3<f32>, band1: f32, band2: f32) -> vec3<f32> {
    let linear = sh[1].xyz * n.y + sh[2].xyz * n.z + sh[3].xyz * n.x;
    let quadratic = sh[4].xyz * (n.x * n.y)
        + sh[5].xyz * (n.y * n.z)
        + sh[6].xyz * (3.0 * n.z * n.z - 1.0)
        + sh[7].xyz * (n.z * n.x)
        + sh[8].xyz * (n.x * n.x - n.y * n.y);
    return sh[0].xyz + linear * band1 + quadratic * band2;
}

/// Irradiance / π from the hemisphere about the unit vector n. Ringing near a bright sun
/// dips below zero by up to 4 % of the peak, so the result is clamped (hard case 27).
fn irradiance_sh(sh: array<vec4<f32>, 9>, n: vec3<f32>) -> vec3<f32> {
    return max(evaluate_sh(sh, n, 1.0, 1.0), vec3<f32>(0.0));
}

/// Factors that turn the cosine lobe's band weights (2/3, 1/4) into those of the split-sum
/// GGX lobe D(θ/2)·cos θ. At alpha = 1 the two lobes are the same and both factors are one;
/// at alpha = 0 they are 3/2 and 4. Least-squares cubics of our own; largest error 0.015 and
/// 0.081, shown by the mirror's test against quadrature.
fn sh_lobe_scale(alpha: f32) -> vec2<f32> {
    let band1 = 0.52727 + alpha * (-0.55019 + alpha * 0.16995);
    let band2 = 3.16448 + alpha * (-4.35002 + alpha * 2.02739);
    return vec2<f32>(1.0) + (1.0 - alpha) * vec2<f32>(band1, band2);
}

/// Radiance of the environment filtered by the GGX lobe about the unit vector r. What three
/// bands can show: right for rough surfaces, featureless for smooth ones.
fn specular_sh(sh: array<vec4<f32>, 9>, r: vec3<f32>, alpha: f32) -> vec3<f32> {
    let scale = sh_lobe_scale(alpha);
    return max(evaluate_sh(sh, r, scale.x, scale.y), vec3<f32>(0.0));
}
