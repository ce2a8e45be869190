// Upscaling of the final image: bilinear, or edge-adaptive (lib/upscale.wgsl).
//
// Input and filtering are sRGB encoded, because their steps are perceptually uniform.

import package::lib::fullscreen::{fullscreen_position, uv_from_clip};
import package::lib::luminance::luminance;
import package::lib::srgb::linear_from_srgb;
import package::lib::upscale::{edge_of, kernel_of, kernel_weight};

/// True decodes the result, for an sRGB target.
override DECODE: bool = false;

@group(0) @binding(0) var picture: texture_2d<f32>;
/// Linear filter, clamp to edge; only `fs_bilinear` uses it.
@group(0) @binding(1) var picture_sampler: sampler;

struct UpscaleVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> UpscaleVertex {
    let position = fullscreen_position(vertex, 0.0);
    return UpscaleVertex(position, uv_from_clip(position.xy));
}

fn decoded(color: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(select(color, linear_from_srgb(color), DECODE), 1.0);
}

@fragment
fn fs_bilinear(vertex: UpscaleVertex) -> @location(0) vec4<f32> {
    return decoded(textureSampleLevel(picture, picture_sampler, vertex.uv, 0.0).rgb);
}

/// Returns the index of a texel in the 4×4 neighborhood, which starts at (-1, -1).
fn place_of(x: i32, y: i32) -> i32 {
    return (y + 1) * 4 + x + 1;
}

@fragment
fn fs_edges(vertex: UpscaleVertex) -> @location(0) vec4<f32> {
    let last = vec2<i32>(textureDimensions(picture)) - 1;
    let place = vertex.uv * vec2<f32>(last + 1) - 0.5;
    let corner = floor(place);
    let share = place - corner;
    var near: array<vec3<f32>, 16>;
    var luma: array<f32, 16>;
    for (var i = 0; i < 16; i++) {
        let at = vec2<i32>(corner) + vec2<i32>(i % 4, i / 4) - 1;
        near[i] = textureLoad(picture, clamp(at, vec2<i32>(0), last), 0).rgb;
        luma[i] = luminance(near[i]);
    }
    var edge = vec3<f32>(0.0);
    for (var y = 0; y < 2; y++) {
        for (var x = 0; x < 2; x++) {
            let i = place_of(x, y);
            let along = mix(1.0 - share, share, vec2<f32>(vec2<i32>(x, y)));
            edge += along.x * along.y
                * edge_of(luma[i], luma[i - 4], luma[i - 1], luma[i + 1], luma[i + 4]);
        }
    }
    let kernel = kernel_of(edge);
    var sum = vec4<f32>(0.0);
    for (var i = 0; i < 16; i++) {
        let at = vec2<i32>(i % 4, i / 4) - 1;
        let outer = (at.x == -1 || at.x == 2) && (at.y == -1 || at.y == 2);
        let weight = select(kernel_weight(vec2<f32>(at) - share, kernel, edge.z), 0.0, outer);
        sum += vec4<f32>(near[i] * weight, weight);
    }
    let low = min(min(near[5], near[6]), min(near[9], near[10]));
    let high = max(max(near[5], near[6]), max(near[9], near[10]));
    return decoded(clamp(sum.rgb / sum.w, low, high));
}
