// Fog in front of what is shaded: read by the color passes and the sky under FOG.

import package::interface::environment::environment_level;
import package::interface::frame::frame;
import package::lib::environment::rotate_about_y;
import package::lib::fog::{fog_optical_depth, fog_opacity, fog_glow};
import package::lib::numerics::saturate_half3;

/// How far away what no surface covers is taken to be, in m.
const FOG_SKY_M: f32 = 1e10;

/// The fog of a view. Mirrored by `layout::FogUniforms`.
struct FogUniforms {
    /// Pre-exposed radiance, linear Rec.709; or a tint of the environment's.
    color: vec3<f32>,
    /// Density at the eye, in 1/m.
    density: f32,
    /// How fast density falls with height, in 1/m.
    falloff: f32,
    /// Where fog begins, in m from the eye.
    start_m: f32,
    /// What is farther away is not in fog.
    cut_off_m: f32,
    /// The most that it hides, 0…1.
    most_opacity: f32,
    /// Where the sun's light begins to be scattered, in m from the eye.
    glow_start_m: f32,
    /// Exponent of the glow about the sun.
    glow_size: f32,
    /// 1: there is a glow. 0: there is none.
    glows: f32,
    /// 1: density where fog begins counts. 0: as Filament has it.
    exact: f32,
    /// 1: the color is the environment's. 0: it is not.
    of_environment: f32,
    /// One over the distance from which on the environment is blurred less by `sharp_levels`, in
    /// 1/m.
    per_sharp_m: f32,
    /// Levels by which it is blurred less from that distance on.
    sharp_levels: f32,
}

/// Bound after the other uniform buffers of the frame: no branch depends on it. Mesa's software
/// driver corrupts its memory for branches on a fourth uniform buffer (tests/all/branches.rs).
@group(0) @binding(46) var<uniform> fog: FogUniforms;

/// A color, multiplied by its alpha, as it is seen through `way_m` of fog along the unit vector
/// `direction`.
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
