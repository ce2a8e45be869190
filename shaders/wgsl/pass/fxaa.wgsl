// FXAA: smooths the edges of the final image (decisions in lib/fxaa.wgsl).
//
// Input: sRGB encoded color with luma in alpha (pass/post.wgsl with OUTPUT_ENCODED and
// LUMA_IN_ALPHA). It works on encoded values because their contrast is perceptually uniform. For
// Filament's unfiltered image of slanted edges, the result matches Filament's at 50 dB; differences
// come from exact ties of the two-tap test.

import package::lib::fullscreen::{fullscreen_position, uv_from_clip};
import package::lib::fxaa::{fxaa_is_edge, fxaa_direction, fxaa_span_texels};
import package::lib::srgb::linear_from_srgb;

/// Settings of the pass. Mirrored by `layout::FxaaUniforms`.
struct FxaaUniforms {
    /// Divisor of the second tap pair's distance; 8 is usual.
    edge_sharpness: f32,
    /// Minimum contrast that is filtered, as a share of the largest luma; 0.08.
    edge_threshold: f32,
    /// Minimum contrast that is filtered, absolute; 0.04.
    edge_threshold_min: f32,
    /// Weight of the unfiltered pixel in the result; 0.25.
    centre_weight: f32,
}

/// True writes encoded values to a Unorm target, false writes linear values to an sRGB target.
override OUTPUT_ENCODED: bool = false;

@group(0) @binding(0) var<uniform> fxaa: FxaaUniforms;
@group(0) @binding(1) var ldr: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(2) var ldr_sampler: sampler;

struct FxaaVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> FxaaVertex {
    let position = fullscreen_position(vertex, 0.0);
    return FxaaVertex(position, uv_from_clip(position.xy));
}

/// Returns the filtered encoded color at texture coordinates `uv`.
fn filter_edge(uv: vec2<f32>) -> vec3<f32> {
    let size = vec2<i32>(textureDimensions(ldr, 0));
    let texel = 1.0 / vec2<f32>(size);
    let pixel = vec2<i32>(uv * vec2<f32>(size));
    let first = max(pixel - 1, vec2<i32>(0));
    let last = min(pixel + 1, size - 1);
    // Luma of the pixel and its eight neighbors, loaded without filtering. A gather returns the
    // four texels around a corner as (bottom left, bottom right, top right, top left).
    let centre = textureLoad(ldr, pixel, 0);
    let around_nw = textureGather(3, ldr, ldr_sampler, uv - 0.5 * texel);
    let around_se = textureGather(3, ldr, ldr_sampler, uv + 0.5 * texel);
    let top_right = textureLoad(ldr, vec2<i32>(last.x, first.y), 0).a;
    let bottom_left = textureLoad(ldr, vec2<i32>(first.x, last.y), 0).a;
    let nw = dot(around_nw, vec4<f32>(0.25));
    let ne = 0.25 * (around_nw.z + top_right + centre.a + around_se.z);
    let sw = 0.25 * (around_nw.x + centre.a + bottom_left + around_se.x);
    let se = dot(around_se, vec4<f32>(0.25));

    let corner_min = min(min(nw, ne), min(sw, se));
    let corner_max = max(max(nw, ne), max(sw, se));
    let luma_min = min(corner_min, centre.a);
    let luma_max = max(corner_max, centre.a);
    if !fxaa_is_edge(luma_min, luma_max, fxaa.edge_threshold, fxaa.edge_threshold_min) {
        return centre.rgb;
    }
    let direction = fxaa_direction(nw, ne, sw, se);
    let near = direction * texel;
    let far = near * fxaa_span_texels(direction, luma_max - luma_min, fxaa.edge_sharpness);
    let two = textureSampleLevel(ldr, ldr_sampler, uv - near, 0.0)
        + textureSampleLevel(ldr, ldr_sampler, uv + near, 0.0);
    let outer = textureSampleLevel(ldr, ldr_sampler, uv - far, 0.0)
        + textureSampleLevel(ldr, ldr_sampler, uv + far, 0.0);
    let four = (two + outer) * 0.25;
    // The wide pair reached past the edge if its luma is outside the local range.
    let overshoots = four.a < corner_min || four.a > corner_max;
    let filtered = select(four.rgb, two.rgb * 0.5, overshoots);
    return mix(filtered, centre.rgb, fxaa.centre_weight);
}

@fragment
fn fs_main(vertex: FxaaVertex) -> @location(0) vec4<f32> {
    let encoded = filter_edge(vertex.uv);
    return vec4<f32>(select(linear_from_srgb(encoded), encoded, OUTPUT_ENCODED), 1.0);
}
