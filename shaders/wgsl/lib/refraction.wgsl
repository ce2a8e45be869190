// Light that passes through a body: where it leaves, how far it spreads, what is absorbed.
//
// The body under a surface is taken for a sphere of the surface's thickness, as in Filament: a
// ray that enters at an angle meets less of it, so no path is longer than the body is thick.

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

/// Standard deviation along one axis, in radians, of the direction of light that passed a rough
/// interface between air and a body of index `ior`, for small angles: a facet tilted by t bends
/// the ray by (ior - 1)·t, and a Gaussian of deviation 0.85·alpha holds half of GGX's facets
/// within the same tilt as GGX does (half of its slopes are below alpha, half of a Gaussian's
/// below 1.1774 deviations).
fn transmission_spread(alpha: f32, ior: f32) -> f32 {
    return 0.849322 * alpha * max(ior - 1.0, 0.0);
}

/// Standard deviation along one axis, in radians from the eye, of Filament's blur of things behind
/// a rough body. It depends on the perceptual roughness alone, not on their distance. Level n > 0
/// of Filament's picture has a deviation of 11/3 √5^(n-1) pixels.
/// Below an index of 1.5 the blur is less; 0 at 1.
fn seen_transmission_spread(roughness: f32, ior: f32) -> f32 {
    let r = roughness * (1.0 - saturate(3.0 / max(ior, 1.0) - 2.0));
    return 0.31622777 * r * r;
}

/// Level of a pyramid that shows a picture blurred by a Gaussian of `sigma_texels` of level 0.
/// Each level is made of the one above by the kernel (1 3 3 1)/8, of variance 3/4, and read with
/// bilinear filtering, of variance 1/6: level n has a variance of about (5/12)·4ⁿ.
fn pyramid_lod(sigma_texels: f32) -> f32 {
    return max(log2(max(sigma_texels, 1e-3) * 1.549193), 0.0);
}
