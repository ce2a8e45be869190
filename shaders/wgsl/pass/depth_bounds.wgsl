// Bounds of depth as a pyramid: the nearest and the farthest surface of each block of texels. Rays
// skip blocks that they pass in front of or behind.
//
// Level 0 has half the size of the depth, rounded up. Further levels are rounded down, and the last
// texel of an odd side is a part of its neighbor's block.

import package::lib::fullscreen::fullscreen_position;

/// Reversed depth, or the previous level. Bound as an unfilterable float.
@group(0) @binding(0) var finer: texture_2d<f32>;

/// Bounds of a block without surfaces.
const EMPTY: vec2<f32> = vec2<f32>(0.0, 1e30);

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Returns the bounds that include both.
fn joined(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(max(a.x, b.x), min(a.y, b.y));
}

/// Computes level 0 from depth: the largest depth in red, the smallest one in green.
@fragment
fn fs_first(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let first = 2 * vec2<i32>(position.xy);
    let last = vec2<i32>(textureDimensions(finer)) - 1;
    var found = EMPTY;
    for (var i = 0; i < 4; i++) {
        let depth = textureLoad(finer, min(first + vec2<i32>(i & 1, i >> 1u), last), 0).r;
        // Depth 0 is no surface.
        found = joined(found, select(EMPTY, vec2<f32>(depth), depth > 0.0));
    }
    return vec4<f32>(found, 0.0, 0.0);
}

/// Computes the next level.
@fragment
fn fs_level(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let first = 2 * vec2<i32>(position.xy);
    let last = vec2<i32>(textureDimensions(finer)) - 1;
    // The third texel of a row belongs to the last block of an odd side.
    let extent = select(vec2<i32>(2), vec2<i32>(3), first + 2 == last);
    var found = EMPTY;
    for (var i = 0; i < 9; i++) {
        let step = vec2<i32>(i % 3, i / 3);
        if all(step < extent) {
            found = joined(found, textureLoad(finer, min(first + step, last), 0).rg);
        }
    }
    return vec4<f32>(found, 0.0, 0.0);
}
