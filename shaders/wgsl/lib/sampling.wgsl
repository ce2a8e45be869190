// Points and directions for Monte Carlo integration.

import package::lib::math::PI;

/// Base-two radical inverse of i: its bits mirrored behind the binary point, in [0, 1).
fn radical_inverse(i: u32) -> f32 {
    // The low eight bits would not fit the mantissa and could round up to one.
    return f32(reverseBits(i) >> 8u) * (1.0 / 16777216.0);
}

/// Point i of `count` of the Hammersley set in [0, 1)², centred in its cells along x.
fn hammersley(i: u32, count: u32) -> vec2<f32> {
    return vec2<f32>((f32(i) + 0.5) / f32(count), radical_inverse(i));
}

/// Direction of the upper hemisphere (z up), uniform in solid angle: density 1/2π. Only half
/// of the azimuths is used (y ≥ 0), for integrands that are symmetric about the xz plane.
fn sample_half_hemisphere(u: vec2<f32>) -> vec3<f32> {
    let azimuth = PI * u.y;
    let s = sqrt(max((1.0 - u.x) * (1.0 + u.x), 0.0));
    return vec3<f32>(s * cos(azimuth), s * sin(azimuth), u.x);
}

/// Smith's masking of one direction, G1, for GGX.
fn g1_smith_ggx(nov: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    return 2.0 * nov / max(nov + sqrt((nov - a2 * nov) * nov + a2), 1e-10);
}

/// A half vector distributed as the facet normals visible from v (z up, v.z > 0; Heitz,
/// "Sampling the GGX Distribution of Visible Normals", JCGT 2018). The density of the
/// direction reflected about it is G1(v)·D(h) / (4·v.z).
fn sample_visible_normal(v: vec3<f32>, alpha: f32, u: vec2<f32>) -> vec3<f32> {
    let stretched = normalize(vec3<f32>(alpha * v.xy, v.z));
    let planar2 = dot(stretched.xy, stretched.xy);
    var t1 = vec3<f32>(1.0, 0.0, 0.0);
    if planar2 > 1e-14 {
        t1 = vec3<f32>(-stretched.y, stretched.x, 0.0) * inverseSqrt(planar2);
    }
    let t2 = cross(stretched, t1);
    let radius = sqrt(u.x);
    let azimuth = 2.0 * PI * u.y;
    let p1 = radius * cos(azimuth);
    let s = 0.5 * (1.0 + stretched.z);
    let p2 = (1.0 - s) * sqrt(max(1.0 - p1 * p1, 0.0)) + s * radius * sin(azimuth);
    let p3 = sqrt(max(1.0 - p1 * p1 - p2 * p2, 0.0));
    let h = p1 * t1 + p2 * t2 + p3 * stretched;
    return normalize(vec3<f32>(alpha * h.xy, max(h.z, 0.0)));
}
