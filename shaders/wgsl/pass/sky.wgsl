// Sky: the background where there is no geometry.
//
// It draws a full-screen triangle on the far plane after the opaque geometry, with depth compare
// GreaterEqual and no depth write, so that only uncovered pixels are shaded. The background is an
// environment map, a clear sky with a sun disc (lib/sky.wgsl), or a constant radiance.
//
// Features: FOG applies fog at a very large distance. SUN_HALO draws the sun's disc and halo over
// all backgrounds except black.

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
    /// Perez coefficients A…E for (x, y, Y) in xyz.
    perez: array<vec4<f32>, 5>,
    /// (x, y, Y) at the zenith divided by the Perez function there; Y in pre-exposed nits.
    zenith: vec3<f32>,
    /// 1 - cos of the angular radius of the sun's disc, if it has a halo.
    disc_versine: f32,
    /// Pre-exposed radiance below the horizon, or of the whole constant sky; linear Rec.709.
    ground: vec3<f32>,
    /// Reciprocal of the difference between the versines of the halo and of the disc.
    per_halo: f32,
    /// Unit vector toward the sun for which the coefficients were computed.
    toward_sun: vec3<f32>,
    /// Exponent of the halo's falloff.
    halo_falloff: f32,
}

@group(1) @binding(0) var<uniform> sky: SkyUniforms;

struct SkyVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) ray: vec3<f32>,
}

/// Returns the direction through a point of the screen, not normalized: far point minus near point
/// in homogeneous coordinates. This is correct for perspective and orthographic cameras, and for a
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

/// Adds the sun's disc and halo to `radiance`. The disc is as bright as Filament's, 4π times the
/// illuminance.
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

/// Returns the output color for this background radiance.
fn seen(vertex: SkyVertex, radiance: vec3<f32>) -> vec4<f32> {
    var color = vec4<f32>(saturate_half3(radiance), 1.0);
    @if(FOG) color =
        in_fog(color, normalize_or(vertex.ray, vec3<f32>(0.0, 1.0, 0.0)), FOG_SKY_M);
    return epilogue(color, vertex.position.xy);
}

/// Draws the environment map.
@fragment
fn fs_environment(vertex: SkyVertex) -> @location(0) vec4<f32> {
    let d = normalize_or(vertex.ray, vec3<f32>(0.0, 1.0, 0.0));
    let at = equirect_uv_from_direction(rotate_about_y(d, frame.environment_rotation));
    let texel = textureSampleLevel(environment_map, environment_sampler, at, 0.0).rgb;
    return seen(vertex, with_sun(vertex, texel * frame.environment_scale));
}

/// Draws the clear sky and the sun.
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

/// Draws a constant radiance.
@fragment
fn fs_constant(vertex: SkyVertex) -> @location(0) vec4<f32> {
    return seen(vertex, with_sun(vertex, sky.ground));
}

/// Draws black. A clear value cannot pass through the epilogue, which may depend on the pixel.
@fragment
fn fs_black(vertex: SkyVertex) -> @location(0) vec4<f32> {
    return seen(vertex, vec3<f32>(0.0));
}
