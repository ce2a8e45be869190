// Transmission through an object: exit point, spread and absorption.
//
// The object under a surface is approximated by a sphere of the surface's thickness, as in
// Filament. A ray that enters at an angle has a shorter path, so no path is longer than the
// thickness.

/// From the point of entry to the point of exit, in the units of `thickness`; zero for a thin
/// wall, which displaces nothing. `view` points away from the surface toward the viewer; `ior`
/// is at least 1, so that light always enters.
fn refracted_path(
    view: vec3<f32>,
    normal: vec3<f32>,
    ior: f32,
    thickness: f32,
) -> vec3<f32> {
    let eta = 1.0 / max(ior, 1.0);
    let cosine = clamp(dot(normal, view), 0.0, 1.0);
    let inside = sqrt(max(1.0 - eta * eta * (1.0 - cosine * cosine), 0.0));
    let ray = (eta * cosine - inside) * normal - eta * view;
    return ray * (thickness * inside);
}

/// Index of refraction of red, green and blue in a medium of index `ior` and `dispersion` 20 over
/// its Abbe number (KHR_materials_dispersion): blue is refracted most. Held at the index of air
/// from below, and beyond any medium from above.
fn dispersed_ior(ior: f32, dispersion: f32) -> vec3<f32> {
    let half_spread = (ior - 1.0) * 0.025 * dispersion;
    let iors = ior + vec3<f32>(-half_spread, 0.0, half_spread);
    return clamp(iors, vec3<f32>(1.0), vec3<f32>(1e4));
}

/// Share of each channel that is left after `distance_m` (Beer and Lambert).
fn transmittance(absorption_per_m: vec3<f32>, distance_m: f32) -> vec3<f32> {
    return exp(-absorption_per_m * distance_m);
}

/// Returns the standard deviation along one axis, in radians, of light refracted by a rough
/// interface between air and index `ior`, for small angles. A facet tilted by t bends the ray by
/// (ior - 1)·t. A Gaussian of deviation 0.85·alpha has the same median tilt as GGX: half of GGX's
/// slopes are below alpha, half of a Gaussian's below 1.1774 deviations.
fn transmission_spread(alpha: f32, ior: f32) -> f32 {
    return 0.849322 * alpha * max(ior - 1.0, 0.0);
}

/// Returns the standard deviation along one axis, in radians from the eye, of Filament's blur
/// behind a rough refractive surface. It depends only on perceptual roughness, not on distance.
/// Level n > 0 of Filament's image has a deviation of 11/3 √5^(n-1) pixels. The blur decreases
/// below an index of 1.5, to 0 at 1.
fn seen_transmission_spread(roughness: f32, ior: f32) -> f32 {
    let r = roughness * (1.0 - saturate(3.0 / max(ior, 1.0) - 2.0));
    return 0.31622777 * r * r;
}

/// Returns the pyramid level for a Gaussian blur of `sigma_texels` texels of level 0. Each level is
/// filtered with (1 3 3 1)/8, of variance 3/4, and read bilinearly, with variance 1/6. Level n has
/// a variance of about (5/12)·4ⁿ.
fn pyramid_lod(sigma_texels: f32) -> f32 {
    return max(log2(max(sigma_texels, 1e-3) * 1.549193), 0.0);
}
