// Bloom: extracts bright parts, downsamples them level by level, and adds the levels up again.
//
// `fs_first` loads texels without filtering, because a filter would spread NaN and infinity; its
// output is finite. `fs_down` halves images with even sides, `fs_down_odd` all others. `fs_up` adds
// the next smaller level, filtered by a tent of three texels, or with NARROW by a box of one.

import package::lib::bloom::{
    BLOOM_MOST, tent_weights, firefly_weight, glowing,
};
import package::lib::fullscreen::{fullscreen_position, uv_from_clip};
import package::lib::numerics::saturate_half3;

/// Settings of the first bloom pass. Mirrored by `layout::BloomUniforms`.
struct BloomUniforms {
    /// Size of the area that the coordinates span, in texels of the source.
    span_px: vec2<f32>,
    /// Position of the image in that area, in texels.
    begin_px: vec2<f32>,
    /// Brightness threshold of the glow.
    threshold: f32,
    /// See `glowing`.
    hard: f32,
    /// See `glowing`.
    per_highlight: f32,
    /// 1: only texels above the threshold glow. 0: all texels glow.
    thresholds: f32,
    /// 1: reduces the weight of single bright texels. 0: weights all texels equally.
    @size(16) fireflies: f32,
}

/// Adds levels with a box filter instead of a tent.
override NARROW: bool = false;

@group(0) @binding(0) var<uniform> bloom: BloomUniforms;
/// Pre-exposed single-sampled radiance, or a level of the glow.
@group(0) @binding(1) var glow: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(2) var glow_sampler: sampler;
/// Glow of this level.
@group(0) @binding(3) var level: texture_2d<f32>;

struct BloomVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> BloomVertex {
    let position = fullscreen_position(vertex, 0.0);
    return BloomVertex(position, uv_from_clip(position.xy));
}

/// Returns a texel of the image, clamped to the border; always finite.
fn texel(at: vec2<i32>) -> vec3<f32> {
    let last = vec2<i32>(textureDimensions(glow, 0)) - 1;
    let color = textureLoad(glow, clamp(at, vec2<i32>(0), last), 0).rgb;
    return min(saturate_half3(color), vec3<f32>(BLOOM_MOST));
}

/// Extracts the glow with a tent of three texels in each direction, in four groups of four texels.
@fragment
fn fs_first(vertex: BloomVertex) -> @location(0) vec4<f32> {
    let at = vertex.uv * bloom.span_px - bloom.begin_px + 0.5;
    let first = vec2<i32>(floor(at)) - 2;
    let across = tent_weights(fract(at.x));
    let down = tent_weights(fract(at.y));
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    for (var group = 0; group < 4; group++) {
        let x = 2 * (group % 2);
        let y = 2 * (group / 2);
        let wx = vec2<f32>(across[x], across[x + 1]);
        let wy = vec2<f32>(down[y], down[y + 1]);
        let corner = first + vec2<i32>(x, y);
        let above = wx.x * texel(corner) + wx.y * texel(corner + vec2<i32>(1, 0));
        let below = wx.x * texel(corner + vec2<i32>(0, 1)) + wx.y * texel(corner + vec2<i32>(1, 1));
        let whole = (wx.x + wx.y) * (wy.x + wy.y);
        let mean = (wy.x * above + wy.y * below) / whole;
        let own = whole * mix(1.0, firefly_weight(mean), bloom.fireflies);
        sum += mean * own;
        weight += own;
    }
    let color = sum / weight;
    let over = glowing(color, bloom.threshold, bloom.hard, bloom.per_highlight);
    return vec4<f32>(mix(color, over, bloom.thresholds), 1.0);
}

fn tap(uv: vec2<f32>) -> vec3<f32> {
    return textureSampleLevel(glow, glow_sampler, uv, 0.0).rgb;
}

/// Sums four taps at the corners of a square around `uv`.
fn corners(uv: vec2<f32>, d: vec2<f32>) -> vec3<f32> {
    return tap(uv - d) + tap(uv + vec2<f32>(d.x, -d.y))
        + tap(uv + vec2<f32>(-d.x, d.y)) + tap(uv + d);
}

/// Sums four taps at the midpoints of the sides of a square around `uv`.
fn sides(uv: vec2<f32>, d: vec2<f32>) -> vec3<f32> {
    return tap(uv - vec2<f32>(d.x, 0.0)) + tap(uv + vec2<f32>(d.x, 0.0))
        + tap(uv - vec2<f32>(0.0, d.y)) + tap(uv + vec2<f32>(0.0, d.y));
}

/// Halves an image with even sides: a kernel of six texels in nine taps.
@fragment
fn fs_down(vertex: BloomVertex) -> @location(0) vec4<f32> {
    let reach = 1.761629 / vec2<f32>(textureDimensions(glow, 0));
    let outer = 7.46602 / 32.0;
    let middle = 1.0 - 2.0 * outer;
    let color = tap(vertex.uv) * (middle * middle) + sides(vertex.uv, reach) * (outer * middle)
        + corners(vertex.uv, reach) * (outer * outer);
    return vec4<f32>(color, 1.0);
}

/// Halves an image of any size: five boxes of four texels in thirteen taps.
@fragment
fn fs_down_odd(vertex: BloomVertex) -> @location(0) vec4<f32> {
    let one = 1.0 / vec2<f32>(textureDimensions(glow, 0));
    let color = corners(vertex.uv, one) * 0.125 + tap(vertex.uv) * 0.125
        + sides(vertex.uv, 2.0 * one) * 0.0625 + corners(vertex.uv, 2.0 * one) * 0.03125;
    return vec4<f32>(color, 1.0);
}

/// Adds all smaller levels to this level.
@fragment
fn fs_up(vertex: BloomVertex) -> @location(0) vec4<f32> {
    let own = textureLoad(level, vec2<i32>(vertex.position.xy), 0).rgb;
    let uv = vertex.uv;
    var below: vec3<f32>;
    if NARROW {
        below = corners(uv, 0.5 / vec2<f32>(textureDimensions(level, 0))) * 0.25;
    } else {
        let one = 1.0 / vec2<f32>(textureDimensions(glow, 0));
        below = (4.0 * tap(uv) + 2.0 * sides(uv, one) + corners(uv, one)) / 16.0;
    }
    return vec4<f32>(own + below, 1.0);
}
