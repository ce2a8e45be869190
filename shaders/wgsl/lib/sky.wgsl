// A clear sky and a sun disc, evaluated from a few coefficients.
//
// Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999: the
// luminance and the chromaticity of the sky as products of Perez' five-parameter function
// with the value at the zenith. The CPU turns turbidity and sun height into coefficients
// (`reference::sky::Preetham`); here are six exponentials a pixel and no loop. A single
// scattering integral would be 128 exponentials, Hosek and Wilkie's fit (2012) a table of
// 1080 numbers.

import package::lib::math::PI;

/// Perez' sky function for three quantities at once, (1 + A·e^(B/cos θ))·(1 + C·e^(D·γ) +
/// E·cos² γ): θ from the zenith, γ from the sun. cos θ is held at 0.01, above the horizon,
/// where B/cos θ stays finite.
fn perez(coefficients: array<vec4<f32>, 5>, cos_theta: f32, cos_gamma: f32) -> vec3<f32> {
    let c = clamp(cos_gamma, -1.0, 1.0);
    let gamma = acos(c);
    let toward_zenith = 1.0
        + coefficients[0].xyz * exp(coefficients[1].xyz / max(cos_theta, 0.01));
    let toward_sun = 1.0
        + coefficients[2].xyz * exp(coefficients[3].xyz * gamma)
        + coefficients[4].xyz * (c * c);
    return toward_zenith * toward_sun;
}

/// Linear Rec.709 color from CIE xyY, negative channels clamped to zero. y is held above
/// 0.001 since it divides.
fn linear_from_xyy(xyy: vec3<f32>) -> vec3<f32> {
    let scale = xyy.z / max(xyy.y, 1e-3);
    let xyz = vec3<f32>(xyy.x * scale, xyy.z, (1.0 - xyy.x - xyy.y) * scale);
    return max(
        vec3<f32>(
            dot(xyz, vec3<f32>(3.2404542, -1.5371385, -0.4985314)),
            dot(xyz, vec3<f32>(-0.9692660, 1.8760108, 0.0415560)),
            dot(xyz, vec3<f32>(0.0556434, -0.2040259, 1.0572252)),
        ),
        vec3<f32>(0.0),
    );
}

/// Radiance of the sky without the sun in the unit direction d, in the unit of zenith.z.
///
/// coefficients: Perez' A…E for (x, y, Y); zenith: (x, y, Y) divided by the function's value
/// at the zenith; ground: linear Rec.709 radiance shown below the horizon, faded in over the
/// last hundredth of d.y.
fn sky_radiance(
    coefficients: array<vec4<f32>, 5>,
    zenith: vec3<f32>,
    ground: vec3<f32>,
    to_sun: vec3<f32>,
    d: vec3<f32>,
) -> vec3<f32> {
    let xyy = zenith * perez(coefficients, d.y, dot(d, to_sun));
    let sky = linear_from_xyy(xyy);
    return mix(ground, sky, smoothstep(-0.01, 0.01, d.y));
}

/// How much of the sun disc covers the unit direction d, in [0, 1]: one inside, fading over
/// the outer tenth of the radius. The sine of the angle comes from the cross product, because
/// the cosine of a quarter degree differs from one by only 180 ulp.
fn sun_disc(d: vec3<f32>, to_sun: vec3<f32>, sin_radius: f32) -> f32 {
    if dot(d, to_sun) <= 0.0 {
        return 0.0;
    }
    let s = length(cross(d, to_sun));
    return 1.0 - smoothstep(0.9 * sin_radius, sin_radius, s);
}

/// Share of the sun's brightness that its disc with a halo shows in the unit direction d, 0…1:
/// one in the disc, falling to zero at the end of the halo (Filament's skybox). `versine` is
/// 1 - cos of the disc's angular radius, `per_halo` one over how much larger the halo's is. The
/// versine of the angle between d and the sun comes from the chord, since a cosine near one has
/// no digits left for it.
fn sun_halo(d: vec3<f32>, to_sun: vec3<f32>, versine: f32, per_halo: f32, falloff: f32) -> f32 {
    let chord = d - to_sun;
    let left = 1.0 - saturate((0.5 * dot(chord, chord) - versine) * per_halo);
    return select(0.0, pow(max(left, 1e-6), falloff), left > 0.0);
}

/// Radiance of a disc of angular radius asin(sin_radius) that lights a surface facing it with
/// `illuminance`: E = π·sin²·L. At noon 1.6e9 nits, so callers clamp it to what their target
/// holds; the energy is carried by the light, not by the picture of it (hard case 20).
fn sun_disc_radiance(illuminance: vec3<f32>, sin_radius: f32) -> vec3<f32> {
    return illuminance / (PI * max(sin_radius * sin_radius, 1e-12));
}
