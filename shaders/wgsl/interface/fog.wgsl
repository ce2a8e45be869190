// Fog in front of surfaces and sky; used by the color passes and the sky with FOG.

import package::interface::environment::environment_level;
import package::interface::frame::frame;
import package::lib::environment::rotate_about_y;
import package::lib::fog::{fog_optical_depth, fog_opacity, fog_glow};
import package::lib::numerics::saturate_half3;

/// Distance of the sky, in m.
const FOG_SKY_M: f32 = 1e10;

/// Fog of a view. Mirrored by `layout::FogUniforms`.
struct FogUniforms {
    /// Pre-exposed radiance, linear Rec.709; a tint if `of_environment` is 1.
    color: vec3<f32>,
    /// Density at the eye, in 1/m.
    density: f32,
    /// Height falloff of the density, in 1/m.
    falloff: f32,
    /// Distance from the eye at which fog begins, in m.
    start_m: f32,
    /// Distance beyond which surfaces have no fog, in m.
    cut_off_m: f32,
    /// Maximum opacity, 0…1.
    most_opacity: f32,
    /// Distance from the eye at which in-scattering of sunlight begins, in m.
    glow_start_m: f32,
    /// Exponent of the sun's glow.
    glow_size: f32,
    /// 1: adds the sun's glow. 0: no glow.
    glows: f32,
    /// 1: uses the density where fog begins. 0: as in Filament.
    exact: f32,
    /// 1: takes the color from the environment. 0: uses `color` alone.
    of_environment: f32,
    /// Reciprocal of the distance at which the environment is `sharp_levels` sharper, in 1/m.
    per_sharp_m: f32,
    /// Number of mip levels by which the environment gets sharper with distance.
    sharp_levels: f32,
}

/// Bound after the other uniform buffers of the frame: no branch depends on it. Mesa's software
/// driver corrupts its memory for branches on a fourth uniform buffer (tests/all/branches.rs).
@group(0) @binding(46) var<uniform> fog: FogUniforms;

/// Returns a premultiplied color behind `way_m` of fog along the unit vector `direction`.
fn in_fog(color: vec4<f32>, direction: vec3<f32>, way_m: f32) -> vec4<f32> {
    let decay = fog.falloff * direction.y * way_m;
    let depth = fog_optical_depth(fog.density, decay, fog.start_m, way_m, fog.exact);
    let lit = fog_optical_depth(fog.density, decay, fog.glow_start_m, way_m, fog.exact);
    let inside = step(fog.start_m, way_m) * step(way_m, fog.cut_off_m);
    let opacity = inside * fog_opacity(depth, fog.most_opacity);
    let around = rotate_about_y(direction, frame.environment_rotation);
    let sharper = saturate(way_m * fog.per_sharp_m) * fog.sharp_levels;
    let lod = max(frame.roughness_one_lod - sharper, 0.0);
    let image = environment_level(around, lod);
    let tint = mix(vec3<f32>(1.0), image, fog.of_environment);
    let glow = fog_glow(dot(direction, frame.sun_direction), fog.glow_size) * fog.glows * inside;
    let sun = frame.sun_illuminance * (glow * fog_opacity(lit, 1.0));
    let scattered = fog.color * tint * opacity + sun;
    let seen = color.rgb * (1.0 - opacity) + scattered * color.a;
    return vec4<f32>(saturate_half3(seen), color.a);
}
