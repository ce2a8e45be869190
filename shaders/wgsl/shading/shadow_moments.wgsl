// Visibility from shadow maps that hold moments of warped depth.

import package::interface::frame::{frame, light_sampler};
import package::interface::shadow::{shadow, shadow_moments, ShadowMapUniforms};
import package::lib::normal_map::duff_tangent;
import package::lib::shadow::receiver_plane_slope;
import package::lib::shadow_moments::{warp_depth, least_variance, moment_visibility};
import package::shading::shadow_map::{ahead_m, texel_m, layer_uv, uvz_along};

/// Returns the visibility from moments, with all texture filtering.
fn moments_visibility(
    map: ShadowMapUniforms,
    normal: vec3<f32>,
    world: vec4<f32>,
    clip: vec4<f32>,
    at: vec3<f32>,
) -> f32 {
    let tangent = duff_tangent(normal);
    let bitangent = cross(normal, tangent);
    let linear = map.linear_depth.xyz;
    let slope = receiver_plane_slope(
        vec3<f32>(uvz_along(map, clip, tangent).xy, dot(linear, tangent)),
        vec3<f32>(uvz_along(map, clip, bitangent).xy, dot(linear, bitangent)),
    ) / (shadow.texels * map.uv_scale);
    let lod = min(moment_level(map, world.xyz, clip.w), map.last_level);
    let uv = layer_uv(map, at.xy, ceil(lod));
    let moments = textureSampleLevel(shadow_moments, light_sampler, uv, map.layer, lod).xy;
    let warped = warp_depth(dot(map.linear_depth, world), shadow.exponent);
    let least = least_variance(warped, shadow.exponent, shadow.variance_floor, slope);
    return moment_visibility(moments, warped, least, shadow.bleed);
}

/// Returns the mip level whose texels are as large as a pixel of the frame.
fn moment_level(map: ShadowMapUniforms, world: vec3<f32>, w: f32) -> f32 {
    let m = frame.clip_from_world;
    let scale = 0.5 * frame.viewport_size_px.y * length(vec3<f32>(m[0].y, m[1].y, m[2].y));
    let pixel_m = select(1.0, max(ahead_m(world), 1e-6), frame.camera.w != 0.0) / scale;
    let texel = texel_m(map, w);
    return max(log2(pixel_m / max(texel.x, texel.y)), 0.0);
}
