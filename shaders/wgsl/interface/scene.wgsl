// The opaque scene behind refractive surfaces, as a pyramid.
//
// Written by pass/scene.wgsl; read by the color pass with TRANSMISSION.

import package::interface::frame::frame;
import package::lib::fullscreen::uv_from_clip;
import package::lib::refraction::pyramid_lod;

/// Pre-exposed radiance in rgb; distance from the eye's plane in m in a, at most 65504.
@group(0) @binding(12) var scene_levels: texture_2d<f32>;
/// Trilinear filter, clamp to edge.
@group(0) @binding(13) var scene_sampler: sampler;

/// Returns the distance of a point from the plane through the eye, in m.
fn distance_ahead(world: vec3<f32>) -> f32 {
    return -dot(frame.world_from_view[2].xyz, world);
}

/// Returns the screen texture coordinates of a point.
fn screen_uv(world: vec3<f32>) -> vec2<f32> {
    let clip = frame.clip_from_world * vec4<f32>(world, 1.0);
    return uv_from_clip(clip.xy / max(clip.w, 1e-6));
}

/// Returns the number of vertical pixels per meter at this distance.
fn pixels_per_m(distance_m: f32) -> f32 {
    let m = frame.clip_from_world;
    let per_m = 0.5 * frame.viewport_size_px.y * length(vec3<f32>(m[0].y, m[1].y, m[2].y));
    // Orthographic projections have the same scale at all distances.
    return per_m / select(1.0, max(distance_m, 1e-6), frame.camera.w != 0.0);
}

/// Returns pre-exposed radiance behind a refractive object. The ray entered at `world` and leaves
/// the object of index `ior` after `path`. `spread_rad` is an angle: x is applied over the
/// distance from the exit point, y from the eye. Inside the object the spread is divided by the
/// index. If the image shows a surface in front of the object, the ray continues straight.
fn radiance_behind(
    world: vec3<f32>,
    path: vec3<f32>,
    ior: f32,
    spread_rad: vec2<f32>,
) -> vec3<f32> {
    let exit = world + path;
    var uv = screen_uv(exit);
    var behind_m = textureSampleLevel(scene_levels, scene_sampler, uv, 0.0).a;
    if behind_m < distance_ahead(world) {
        uv = screen_uv(world);
        behind_m = textureSampleLevel(scene_levels, scene_sampler, uv, 0.0).a;
    }
    let way_m = max(behind_m - distance_ahead(exit), 0.0);
    let spread_m = spread_rad.x * (way_m + length(path) / ior);
    let sigma_px = spread_m * pixels_per_m(behind_m) + spread_rad.y * pixels_per_m(1.0);
    let lod = pyramid_lod(sigma_px);
    return textureSampleLevel(scene_levels, scene_sampler, uv, lod).rgb;
}
