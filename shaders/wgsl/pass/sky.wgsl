// Sky: what is seen where there is no geometry.
//
// A full-screen triangle on the far plane, drawn after the opaque geometry with depth compare
// GreaterEqual and no depth write, so that only uncovered pixels are shaded. The background
// is an environment map, a clear sky with a sun disc (lib/sky.wgsl), or one radiance.
//
// Features: FOG, it is seen through fog, from very far away; SUN_HALO, the sun's disc and halo are
// drawn over it, all but black.

import package::interface::epilogue::epilogue;
@if(FOG)
import package::interface::fog::{in_fog, FOG_SKY_M};
import package::interface::frame::{frame, environment_map, environment_sampler};
import package::lib::environment::{rotate_about_y, equirect_uv_from_direction};
import package::lib::fullscreen::fullscreen_position;
@if(SUN_HALO)
import package::lib::math::PI;
import package::lib::numerics::{normalize_or, saturate_half3};
import package::lib::sky::sky_radiance;
@if(SUN_HALO)
import package::lib::sky::sun_halo;
@else
import package::lib::sky::{sun_disc, sun_disc_radiance};

/// Coefficients of the clear sky, pre-exposed. Mirrored by `layout::SkyUniforms`.
struct SkyUniforms {
    /// Perez' A…E for (x, y, Y) in xyz.
    perez: array<vec4<f32>, 5>,
    /// (x, y, Y) at the zenith over Perez' function there; Y in pre-exposed nits.
    zenith: vec3<f32>,
    /// 1 - cos of the angular radius of the sun's disc, where it has a halo.
    disc_versine: f32,
    /// Pre-exposed radiance below the horizon, or everywhere where it is constant; linear Rec.709.
    ground: vec3<f32>,
    /// One over the difference between the halo's versine and the disc's.
    per_halo: f32,
    /// Unit vector toward the sun that the sky was made for.
    toward_sun: vec3<f32>,
    /// Exponent of the halo's falloff.
    halo_falloff: f32,
}

@group(1) @binding(0) var<uniform> sky: SkyUniforms;

struct SkyVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) ray: vec3<f32>,
}

/// Direction through a point of the screen, any length: far point minus near point in
/// homogeneous coordinates, which holds for perspective and orthographic cameras and for a
/// far plane at infinity, where the far point's w is zero.
fn world_ray(clip: vec2<f32>) -> vec3<f32> {
    let far = frame.world_from_clip * vec4<f32>(clip, 0.0, 1.0);
    let near = frame.world_from_clip * vec4<f32>(clip, 1.0, 1.0);
    return far.xyz * near.w - near.xyz * far.w;
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> SkyVertex {
    let position = fullscreen_position(vertex, 0.0);
    return SkyVertex(position, world_ray(position.xy));
}

/// `radiance` with the sun's disc and halo in front of it. The disc is as bright as Filament's, 4π
/// times the illuminance.
@if(SUN_HALO)
fn with_sun(vertex: SkyVertex, radiance: vec3<f32>) -> vec3<f32> {
    let d = normalize_or(vertex.ray, vec3<f32>(0.0, 1.0, 0.0));
    let share =
        sun_halo(d, frame.sun_direction, sky.disc_versine, sky.per_halo, sky.halo_falloff);
    return radiance + frame.sun_illuminance * (4.0 * PI * share);
}

@else
fn with_sun(vertex: SkyVertex, radiance: vec3<f32>) -> vec3<f32> {
    return radiance;
}

/// The color to write where the background has this radiance.
fn seen(vertex: SkyVertex, radiance: vec3<f32>) -> vec4<f32> {
    var color = vec4<f32>(saturate_half3(radiance), 1.0);
    @if(FOG) color =
        in_fog(color, normalize_or(vertex.ray, vec3<f32>(0.0, 1.0, 0.0)), FOG_SKY_M);
    return epilogue(color, vertex.position.xy);
}

/// The environment map.
@fragment
fn fs_environment(vertex: SkyVertex) -> @location(0) vec4<f32> {
    let d = normalize_or(vertex.ray, vec3<f32>(0.0, 1.0, 0.0));
    let at = equirect_uv_from_direction(rotate_about_y(d, frame.environment_rotation));
    let texel = textureSampleLevel(environment_map, environment_sampler, at, 0.0).rgb;
    return seen(vertex, with_sun(vertex, texel * frame.environment_scale));
}

/// The clear sky and the sun.
@fragment
fn fs_procedural(vertex: SkyVertex) -> @location(0) vec4<f32> {
    let d = normalize_or(vertex.ray, vec3<f32>(0.0, 1.0, 0.0));
    var color = sky_radiance(sky.perez, sky.zenith, sky.ground, sky.toward_sun, d);
    @if(!SUN_HALO) {
        let sin_radius = sin(frame.sun_angular_radius);
        let disc = sun_disc(d, frame.sun_direction, sin_radius);
        if disc > 0.0 && d.y > 0.0 {
            color += disc * sun_disc_radiance(frame.sun_illuminance, sin_radius);
        }
    }
    return seen(vertex, with_sun(vertex, color));
}

/// The same radiance everywhere.
@fragment
fn fs_constant(vertex: SkyVertex) -> @location(0) vec4<f32> {
    return seen(vertex, with_sun(vertex, sky.ground));
}

/// Black, where there is nothing to see: a clear value cannot go through the epilogue, which
/// may depend on the pixel.
@fragment
fn fs_black(vertex: SkyVertex) -> @location(0) vec4<f32> {
    return seen(vertex, vec3<f32>(0.0));
}
