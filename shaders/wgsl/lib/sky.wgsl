// A clear sky and a sun disc, evaluated from a few coefficients.
//
// Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999: the
// luminance and the chromaticity of the sky as products of Perez' five-parameter function
// with the value at the zenith. The CPU turns turbidity and sun height into coefficients
// (`reference::sky::Preetham`); here are six exponentials a pixel and no loop. A single
// scattering integral would be 128 exponentials, Hosek and Wilkie's fit (2012) a table of
// 1080 numbers.

import package::lib::math::PI;

/// Evaluates Perez' sky function for three quantities, (1 + A·e^(B/cos θ))·(1 + C·e^(D·γ) + E·cos²
/// γ), with θ from the zenith and γ from the sun. cos θ is at least 0.01, so that B/cos θ stays
/// finite.
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

/// Converts CIE xyY to linear Rec.709, with negative channels clamped to zero. y is at least 0.001
/// because it is a divisor.
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

/// Returns the coverage of the unit direction d by the sun disc, in [0, 1], fading over the outer
/// tenth of the radius. The sine of the angle comes from the cross product, because the cosine of a
/// quarter degree differs from one by only 180 ulp.
fn sun_disc(d: vec3<f32>, to_sun: vec3<f32>, sin_radius: f32) -> f32 {
    if dot(d, to_sun) <= 0.0 {
        return 0.0;
    }
    let s = length(cross(d, to_sun));
    return 1.0 - smoothstep(0.9 * sin_radius, sin_radius, s);
}

/// Returns the relative brightness of the sun disc and its halo in the unit direction d: 1 in the
/// disc, 0 at the end of the halo (Filament's skybox). `versine` is 1 - cos of the disc's angular
/// radius, `per_halo` the reciprocal of the halo's additional versine. The versine between d and
/// the sun comes from the chord, because a cosine near one has too few digits.
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
