// Equirectangular environment maps: where a direction lies in the map, and which mip level
// stands for a lobe.
//
// u runs once around the Y axis, v from straight up (0) to straight down (1). The middle of
// the map is the direction -Z and +X lies to its right, as a viewer inside the sphere sees it:
// the common layout of .hdr panoramas.

import package::lib::math::PI;

/// d turned about the Y axis by the angle whose (cosine, sine) is given.
fn rotate_about_y(d: vec3<f32>, cos_sin: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(
        cos_sin.x * d.x + cos_sin.y * d.z,
        d.y,
        cos_sin.x * d.z - cos_sin.y * d.x,
    );
}

/// Texture coordinates in [0, 1]² of a unit direction. At the poles atan2(0, 0) is undefined,
/// and any u is right there; zero is chosen.
fn equirect_uv_from_direction(d: vec3<f32>) -> vec2<f32> {
    var azimuth = 0.0;
    if d.x != 0.0 || d.z != 0.0 {
        azimuth = atan2(d.x, -d.z);
    }
    return vec2<f32>(azimuth / (2.0 * PI) + 0.5, acos(clamp(d.y, -1.0, 1.0)) / PI);
}

/// The unit direction at texture coordinates in [0, 1]²: inverse of the above.
fn direction_from_equirect_uv(uv: vec2<f32>) -> vec3<f32> {
    let azimuth = (uv.x - 0.5) * 2.0 * PI;
    let polar = uv.y * PI;
    let s = sin(polar);
    return vec3<f32>(s * sin(azimuth), cos(polar), -s * cos(azimuth));
}

/// Direction of the strongest reflection, not normalized: rough lobes lean from the mirror
/// direction r toward the normal n, by alpha² as in Filament (`getReflectedVector`).
fn specular_dominant_direction(n: vec3<f32>, r: vec3<f32>, alpha: f32) -> vec3<f32> {
    return mix(r, n, alpha * alpha);
}
