// Scalable ambient obscurance as in Filament (McGuire, Mara and Luebke 2012; Guy, "Ambient
// occlusion in Filament", 2021). Taps on a spiral obscure by their height above the tangent plane.
//
// Lengths count in radii, so that numbers between 0 and 1 are computed in `real`; positions, from
// which they come, do not fit half floats (hard case 34).

import package::lib::math::{PI, sq};
import package::lib::real::{real, real3};

/// Height over which a tap at the point itself would count fully, in radii.
const SAO_PEAK: f32 = 0.1;

/// Distance of tap `index` from the middle of the spiral, as a share of its radius; `noise` in
/// [0, 1), `per_tap` = 1 / (taps - ½). Squared, so that taps are denser near the middle.
fn sao_tap_distance(index: f32, noise: f32, per_tap: f32) -> f32 {
    return sq((index + noise + 0.5) * per_tap);
}

/// Returns the obscurance by a point at `v` (m, relative) of a surface with unit normal n; 0 at the
/// radius. Points obscure nothing below the height `bias_m`, or below the angle whose squared sine
/// is `min_sin2`.
fn sao_term(v: vec3<f32>, n: vec3<f32>, radius_m: f32, bias_m: f32, min_sin2: f32) -> f32 {
    // Points outside the radius may exceed the range of half floats.
    if !(dot(v, v) < radius_m * radius_m) {
        return 0.0;
    }
    let u = real3(v / radius_m);
    let uu = dot(u, u);
    let un = dot(u, real3(n));
    if un * un < uu * real(min_sin2) {
        return 0.0;
    }
    let open = 1.0 - min(uu, 1.0);
    let rise = max(un - real(bias_m / radius_m), 0.0);
    return f32(open * open * rise / (uu + real(SAO_PEAK * SAO_PEAK)));
}

/// Share of the hemisphere that is obscured, from the mean of the terms; visibility is the square
/// of what is left, a look that Filament's artists liked.
fn sao_obscurance(mean: f32, intensity: f32) -> f32 {
    return saturate(sqrt(max(2.0 * PI * SAO_PEAK * intensity * mean, 0.0)));
}
