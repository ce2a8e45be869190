// Temporal anti-aliasing: each frame has another sub-pixel jitter and is blended with the valid
// history.
//
// A pixel is reprojected into the previous frame by its depth and both cameras. The history is
// clipped to the colors around the pixel, which rejects disoccluded and changed surfaces.

import package::lib::fullscreen::fullscreen_position;
import package::lib::luminance::luminance;
import package::lib::numerics::{all_finite3, saturate_half3};
import package::lib::quantize::quantize_rgba16float;
import package::lib::taa::{
    ycocg_from_rgb, rgb_from_ycocg, compress_range, expand_range, deviation_of_five, share_to_box,
    steadiness, catmull_rom,
};

/// Settings. Mirrored by `layout::TaaUniforms`.
struct TaaUniforms {
    /// Clip space of this frame to clip space of the previous frame, both without jitter.
    earlier_clip_from_clip: mat4x4<f32>,
    /// Weights of a texel and its neighbors, row by row from the top left: eight in two vectors,
    /// and the ninth in x of the last.
    weights: array<vec4<f32>, 3>,
    /// Weight of this frame in the blend; 1 without a history.
    feedback: f32,
    /// Half width of the variance clipping box, in standard deviations.
    variance_gamma: f32,
    /// Exposure of this frame divided by that of the previous frame.
    exposure_ratio: f32,
}

/// Construction of the color box around a pixel.
override BOX: u32 = 0u;
const BOX_BOUNDS: u32 = 0u;
const BOX_VARIANCE: u32 = 1u;
const BOX_BOTH: u32 = 2u;
/// Method that clips the history to the box.
override CLIPPING: u32 = 0u;
const CLIP_ACCURATE: u32 = 0u;
const CLIP_CLAMP: u32 = 1u;
const CLIP_NONE: u32 = 2u;
/// Uses a box in luma and chroma.
override YCOCG: bool = false;
/// Reads the history with a Catmull-Rom filter, otherwise bilinearly.
override FILTER_HISTORY: bool = true;
/// Filters this frame's colors to pixel centers, otherwise uses them as drawn.
override FILTER_INPUT: bool = true;
/// Reduces the weight of this frame where brightness changes.
override PREVENT_FLICKERING: bool = false;
/// Reprojects the history, otherwise reads it at the same pixel.
override REPROJECT: bool = true;
/// Compresses the range so that bright samples do not dominate; otherwise weights samples by
/// radiance.
override COMPRESS: bool = true;

@group(0) @binding(0) var<uniform> temporal: TaaUniforms;
@group(0) @binding(1) var hdr: texture_2d<f32>;
@group(0) @binding(2) var depth: texture_2d<f32>;
/// Motion vectors of moving objects in texture coordinates, summed over samples, and the number of
/// samples.
@if(VELOCITY)
@group(0) @binding(5) var velocity: texture_2d<f32>;
/// History.
@group(0) @binding(3) var earlier: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(4) var earlier_sampler: sampler;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Returns the position of a texel in the previous frame, with (0, 0) at its top left; z is 0 if
/// the previous frame does not show it.
fn earlier_place(texel: vec2<i32>, size: vec2<f32>) -> vec3<f32> {
    let uv = (vec2<f32>(texel) + 0.5) / size;
    let ndc = vec2<f32>(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y);
    let here = vec4<f32>(ndc, textureLoad(depth, texel, 0).r, 1.0);
    let clip = temporal.earlier_clip_from_clip * here;
    let before = clip.xy / max(clip.w, 1e-9);
    let place = vec2<f32>(0.5 + 0.5 * before.x, 0.5 - 0.5 * before.y);
    return shown_place(uv, place, clip.w > 1e-9);
}

/// Returns a position in the previous frame; z is 0 if the previous frame does not show it.
fn shown_place(uv: vec2<f32>, place: vec2<f32>, ahead: bool) -> vec3<f32> {
    let shown = ahead && all(place >= vec2<f32>(0.0)) && all(place <= vec2<f32>(1.0));
    return select(vec3<f32>(uv, 1.0), vec3<f32>(place, f32(shown)), REPROJECT);
}

/// Returns the position of a texel in the previous frame, with motion vectors. At an edge, where
/// the nearest neighboring surface is nearer by a quarter, it uses the motion vector of that
/// surface, so that the edge moves with it. Elsewhere this would displace the outline of round
/// objects.
@if(VELOCITY)
fn moved_place(texel: vec2<i32>, last: vec2<i32>) -> vec3<f32> {
    let own = textureLoad(depth, texel, 0).r;
    var nearest = own;
    var at = texel;
    for (var i = 0; i < 9; i++) {
        let other = clamp(texel + vec2<i32>(i % 3, i / 3) - 1, vec2<i32>(0), last);
        let around = textureLoad(depth, other, 0).r;
        at = select(at, other, around > nearest && around > 1.25 * own);
        nearest = max(nearest, around);
    }
    let size = vec2<f32>(last + 1);
    let aside = vec2<f32>(texel - at) / size;
    let still = earlier_place(at, size);
    let told = textureLoad(velocity, at, 0);
    let uv = (vec2<f32>(texel) + 0.5) / size;
    let way = uv + told.xy / max(told.w, 1e-3);
    let moves = told.w > 0.0;
    return shown_place(uv, select(still.xy + aside, way, moves), moves || still.z > 0.0);
}

/// Returns the position of a texel in the previous frame, without motion vectors.
@else
fn moved_place(texel: vec2<i32>, last: vec2<i32>) -> vec3<f32> {
    return earlier_place(texel, vec2<f32>(last + 1));
}

/// Reads the history at a position, scaled by the ratio of exposures. The four corners of the
/// spline's sixteen texels are left out, and pairs are read at once.
fn earlier_color(place: vec2<f32>) -> vec3<f32> {
    let size = vec2<f32>(textureDimensions(earlier));
    var sum = vec4<f32>(0.0);
    if FILTER_HISTORY {
        let texel = place * size - 0.5;
        let first = floor(texel);
        let along = catmull_rom(texel.x - first.x);
        let down = catmull_rom(texel.y - first.y);
        let middle = vec2<f32>(along.y + along.z, down.y + down.z);
        let at = first + 0.5 + vec2<f32>(along.z, down.z) / middle;
        let weights = array<f32, 5>(
            middle.x * down.x, along.x * middle.y, middle.x * middle.y, along.w * middle.y,
            middle.x * down.w,
        );
        let places = array<vec2<f32>, 5>(
            vec2<f32>(at.x, first.y - 0.5), vec2<f32>(first.x - 0.5, at.y), at,
            vec2<f32>(first.x + 2.5, at.y), vec2<f32>(at.x, first.y + 2.5),
        );
        var weight = 0.0;
        for (var i = 0u; i < 5u; i++) {
            sum += weights[i] * textureSampleLevel(earlier, earlier_sampler, places[i] / size, 0.0);
            weight += weights[i];
        }
        sum /= weight;
    } else {
        sum = textureSampleLevel(earlier, earlier_sampler, place, 0.0);
    }
    return sum.rgb * temporal.exposure_ratio;
}

/// Converts a color to the space of the box.
fn boxed(c: vec3<f32>) -> vec3<f32> {
    return select(c, ycocg_from_rgb(c), YCOCG);
}

/// Clips `history` to the colors of the nine texels `near`, toward `filtered`.
fn held(history: vec3<f32>, filtered: vec3<f32>, near: array<vec3<f32>, 9>) -> vec3<f32> {
    if CLIPPING == CLIP_NONE {
        return history;
    }
    var s: array<vec3<f32>, 9>;
    for (var i = 0u; i < 9u; i++) {
        s[i] = boxed(near[i]);
    }
    let cross_low = min(s[4], min(min(s[1], s[3]), min(s[5], s[7])));
    let cross_high = max(s[4], max(max(s[1], s[3]), max(s[5], s[7])));
    // Corners contribute half of their extension.
    var low = 0.5 * (cross_low + min(cross_low, min(min(s[0], s[2]), min(s[6], s[8]))));
    var high = 0.5 * (cross_high + max(cross_high, max(max(s[0], s[2]), max(s[6], s[8]))));
    if BOX != BOX_BOUNDS {
        let sum = s[4] + s[1] + s[3] + s[5] + s[7];
        let squares = s[4] * s[4] + s[1] * s[1] + s[3] * s[3] + s[5] * s[5] + s[7] * s[7];
        let reach = temporal.variance_gamma * deviation_of_five(sum, squares);
        low = select(0.2 * sum - reach, max(low, 0.2 * sum - reach), BOX == BOX_BOTH);
        high = select(0.2 * sum + reach, min(high, 0.2 * sum + reach), BOX == BOX_BOTH);
    }
    let start = boxed(history);
    let end = boxed(filtered);
    let clipped = start + (end - start) * share_to_box(start, end, low, high);
    let inside = select(clipped, clamp(start, low, high), CLIPPING == CLIP_CLAMP);
    return select(inside, rgb_from_ycocg(inside), YCOCG);
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<i32>(position.xy);
    let last = vec2<i32>(textureDimensions(hdr)) - 1;
    var near: array<vec3<f32>, 9>;
    var filtered = vec3<f32>(0.0);
    for (var i = 0; i < 9; i++) {
        let at = clamp(texel + vec2<i32>(i % 3, i / 3) - 1, vec2<i32>(0), last);
        near[i] = saturate_half3(textureLoad(hdr, at, 0).rgb);
        filtered += near[i] * temporal.weights[i / 4][i % 4];
    }
    filtered = select(near[4], filtered, FILTER_INPUT);
    let place = moved_place(texel, last);
    let before = earlier_color(place.xy);
    // Rejects NaN and infinity, which would otherwise stay in the history.
    let usable = all_finite3(before) && place.z > 0.0;
    let history = held(select(filtered, max(before, vec3<f32>(0.0)), usable), filtered, near);
    var share = temporal.feedback;
    if PREVENT_FLICKERING {
        share *= steadiness(luminance(filtered), luminance(history));
    }
    let even = mix(history, filtered, share);
    let weighted = expand_range(mix(compress_range(history), compress_range(filtered), share));
    let sum = select(filtered, select(even, weighted, COMPRESS), usable && share < 1.0);
    // Devices that truncate would darken the history a little each frame.
    let alpha = textureLoad(hdr, texel, 0).a;
    return quantize_rgba16float(vec4<f32>(saturate_half3(sum), alpha), false);
}
