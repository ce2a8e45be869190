// Visibility from depth shadow maps, with a tent filter or penumbrae.

import package::interface::shadow::{
    shadow, shadow_map, shadow_sampler, shadow_depth, ShadowMapUniforms, SHADOW_FILTER_PCSS,
};
import package::lib::dither::interleaved_gradient_noise;
import package::lib::math::PI;
import package::lib::normal_map::duff_tangent;
import package::lib::shadow::{
    tent_3x3, vogel_tap, hardened_kernel, penumbra_ratio_parallel, penumbra_ratio_perspective,
    receiver_plane_slope,
};
import package::shading::shadow_map::{Receiver, texel_m, layer_uv, uvz_along};

/// Compares depth `z` at a position in a layer, filtered over the four nearest texels.
fn compare(layer: u32, at: vec2<f32>, z: f32) -> f32 {
    return textureSampleCompareLevel(shadow_map, shadow_sampler, at, layer, z);
}

/// Returns the visibility with a 3×3 tent filter.
fn tent_visibility(map: ShadowMapUniforms, at: vec3<f32>) -> f32 {
    let taps = tent_3x3(at.xy, vec2<f32>(shadow.texels * map.uv_scale));
    let low = layer_uv(map, vec2<f32>(taps.u.x, taps.v.x), 0.0);
    let high = layer_uv(map, vec2<f32>(taps.u.y, taps.v.y), 0.0);
    let top = vec2<f32>(
        compare(map.layer, low, at.z),
        compare(map.layer, vec2<f32>(high.x, low.y), at.z),
    );
    let bottom = vec2<f32>(
        compare(map.layer, vec2<f32>(low.x, high.y), at.z),
        compare(map.layer, high, at.z),
    );
    let rows = vec2<f32>(dot(top, taps.column_weight), dot(bottom, taps.column_weight));
    return dot(rows, taps.row_weight);
}

/// Numbers of taps for the blocker search of each filter, and for the penumbra.
const DPCF_TAPS: u32 = 12u;
const PCSS_TAPS: u32 = 16u;

/// Returns the visibility with DPCF (Myers, "Shadow of Cold War", 2021) or PCSS (Fernando,
/// "Percentage-Closer Soft Shadows", 2005). The mean depth of blockers determines the penumbra
/// width.
fn soft_visibility(
    map: ShadowMapUniforms,
    receiver: Receiver,
    clip: vec4<f32>,
    at: vec3<f32>,
) -> f32 {
    let tangent = duff_tangent(receiver.normal);
    let slope = receiver_plane_slope(
        uvz_along(map, clip, tangent),
        uvz_along(map, clip, cross(receiver.normal, tangent)),
    );
    let turn = interleaved_gradient_noise(receiver.pixel, 0u) * (2.0 * PI);
    let size = shadow.texels * map.uv_scale;
    let per_m = 1.0 / texel_m(map, clip.w);
    let is_disc = map.bulb_m == 0.0;
    // The search radius of a disc at infinity grows with the distance to the blocker, at most from
    // the near end.
    let to_near_m = (1.0 - at.z) * map.depth_m * clip.w;
    let search_m = select(map.bulb_m, map.tan_radius * to_near_m, is_disc);
    let search = penumbra_texels(search_m, per_m, is_disc);
    let is_pcss = shadow.filter_kind == SHADOW_FILTER_PCSS;
    let count = select(DPCF_TAPS, PCSS_TAPS, is_pcss);
    let last = vec2<f32>(shadow.texels - 1.0);

    var blockers = 0.0;
    var depth_sum = 0.0;
    for (var i = 0u; i < count; i++) {
        let offset = vogel_tap(i, count, turn) * search / size;
        // Loads do not clamp to the edge, so the coordinates are clamped.
        let texel = clamp(layer_uv(map, at.xy + offset, 0.0) * shadow.texels, vec2<f32>(0.0), last);
        let depth = textureLoad(shadow_depth, vec2<i32>(texel), map.layer, 0).r;
        if depth - at.z > plane_rise(slope, offset, at.z) {
            blockers += 1.0;
            depth_sum += depth;
        }
    }
    if blockers == 0.0 {
        return 1.0;
    }
    let blocker = depth_sum / blockers;
    var ratio = penumbra_ratio_parallel(at.z, blocker);
    if map.near_over_range > 0.0 {
        ratio = penumbra_ratio_perspective(at.z, blocker, map.near_over_range);
    }
    if is_disc {
        // Relative to the search radius.
        ratio = (blocker - at.z) / max(1.0 - at.z, 1e-4);
    }
    if !is_pcss {
        let share = blockers / f32(count);
        return 1.0 - mix(hardened_kernel(share), share, saturate(ratio));
    }
    let radius = penumbra_texels(search_m * ratio, per_m, is_disc);
    var lit = 0.0;
    for (var i = 0u; i < PCSS_TAPS; i++) {
        let offset = vogel_tap(i, PCSS_TAPS, turn) * radius / size;
        let tap = layer_uv(map, at.xy + offset, 0.0);
        lit += compare(map.layer, tap, at.z + plane_rise(slope, offset, at.z));
    }
    return lit / f32(PCSS_TAPS);
}

/// Returns the change of depth along the receiver's plane at an offset, from its depth `z`. It is
/// limited to the far end of the map, 0, which has no casters.
fn plane_rise(slope: vec2<f32>, offset: vec2<f32>, z: f32) -> f32 {
    return max(dot(slope, offset), -z);
}

/// Returns a radius in texels along both axes, at most the size of a layer. A disc has at least one
/// texel, which hides the texel grid.
fn penumbra_texels(radius_m: f32, texels_per_m: vec2<f32>, is_disc: bool) -> vec2<f32> {
    let least = select(0.0, 1.0, is_disc);
    return clamp(radius_m * texels_per_m, vec2<f32>(least), vec2<f32>(shadow.texels));
}
