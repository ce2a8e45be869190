// Bilateral blur of ambient occlusion along one axis, limited to one surface.
//
// Surfaces are distinguished by the 32-bit depth of the depth pyramid. A depth packed next to the
// visibility would have 16 bits: steps of 15 cm for a far plane at 10 km. Each texel is compared
// with the extrapolated surface of the center texel. Ground at a grazing angle is therefore blurred
// as far as a wall.

import package::interface::structure::{structure, structure_depth};
import package::lib::bilateral::bilateral_weight;
import package::lib::depth_normal::continues_ahead_inside;
import package::lib::fullscreen::fullscreen_position;

/// Settings. Mirrored by `layout::BilateralUniforms`.
struct BilateralUniforms {
    /// Copy of `Projection::depth`.
    depth: vec4<f32>,
    /// Step between samples, in texels.
    axis: vec2<i32>,
    /// Distance between surfaces, in m, at which the weight reaches zero.
    threshold_m: f32,
    /// Weight of the center, followed by the weights of samples at increasing distance.
    weights: array<vec4<f32>, 4>,
}

/// Number of samples on each side, at most 12.
override REACH: i32 = 6;
/// Blurs all four channels, otherwise only red.
override ALL_CHANNELS: bool = false;

@group(0) @binding(0) var<uniform> bilateral: BilateralUniforms;
/// Visibility in red; read without filtering.
@group(0) @binding(1) var occlusion_in: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Returns the slope of stored depth along the axis, on the surface of the center texel.
fn slope(texel: vec2<i32>, here: f32, last: vec2<i32>) -> f32 {
    let axis = bilateral.axis;
    let back = vec2<f32>(structure_depth(texel - 2 * axis), structure_depth(texel - axis));
    let ahead = vec2<f32>(structure_depth(texel + axis), structure_depth(texel + 2 * axis));
    let go_ahead = continues_ahead_inside(texel, axis, last, back, here, ahead);
    return select(here - back.y, ahead.x - here, go_ahead);
}

/// Returns a texel of the input.
fn occlusion_at(texel: vec2<i32>) -> vec4<f32> {
    let found = textureLoad(occlusion_in, texel, 0);
    if ALL_CHANNELS {
        return found;
    }
    return vec4<f32>(found.r, 0.0, 0.0, 0.0);
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<i32>(position.xy);
    let here = structure_depth(texel);
    let middle = occlusion_at(texel);
    if here == 0.0 {
        return middle;
    }
    let last = vec2<i32>(textureDimensions(occlusion_in)) - 1;
    let step = slope(texel, here, last);
    // The distance of two depths a and b, by `view_z`, is
    // (a - b) · spread / ((a · z - x) · (b · z - x)).
    let row = bilateral.depth;
    let spread = (row.x * row.w - row.y * row.z) / bilateral.threshold_m;
    var sum = middle * bilateral.weights[0].x;
    var total = bilateral.weights[0].x;
    for (var i = 1; i <= REACH; i++) {
        let weight = bilateral.weights[i >> 2u][i & 3];
        for (var side = -1; side <= 1; side += 2) {
            let at = texel + side * i * bilateral.axis;
            let held = clamp(at, vec2<i32>(0), last);
            let depth = textureLoad(structure, held, 0).r;
            // Extrapolated depth of the surface; invalid once its line has passed the far plane.
            let expected = here + f32(side * i) * step;
            let places = (depth * row.z - row.x) * (expected * row.z - row.x);
            let apart = (depth - expected) * spread / places;
            let near = depth > 0.0 && expected > 0.0 && all(at == held);
            let w = select(0.0, weight * bilateral_weight(apart, 1.0), near);
            sum += w * occlusion_at(held);
            total += w;
        }
    }
    return sum / total;
}
