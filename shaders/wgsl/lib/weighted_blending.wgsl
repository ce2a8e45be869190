// Weighted blended transparency: colors are averaged, nearer ones with a larger weight.
//
// McGuire and Bavoil, "Weighted Blended Order-Independent Transparency", JCGT 2(2), 2013,
// equation 7. Only ratios of weights count, so they are divided by 32 here: a weighted half float
// then holds 22 times the radiance.

/// Largest weighted radiance of one fragment: eight of them fit a half float.
const WEIGHTED_MAX: f32 = 8000.0;

/// Weight of a fragment, without its factor alpha, for a distance ahead of the eye in m.
fn blend_weight(distance_m: f32) -> f32 {
    let z = clamp(abs(distance_m), 0.0, 1e4);
    let near = z / 5.0;
    let far2 = (z / 200.0) * (z / 200.0);
    return clamp(10.0 / (1e-5 + near * near + far2 * far2 * far2), 1e-2, 3e3) / 32.0;
}

/// Returns the fragment's contribution to the sums; `color` is premultiplied by alpha.
fn weighted_color(color: vec4<f32>, distance_m: f32) -> vec4<f32> {
    let weight = color.a * blend_weight(distance_m);
    return vec4<f32>(min(color.rgb * weight, vec3<f32>(WEIGHTED_MAX)), color.a * weight);
}
