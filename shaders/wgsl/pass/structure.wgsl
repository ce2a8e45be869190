// Depth pyramid of visible surfaces, for screen-space effects. Level 0 is the depth of the prepass,
// at its size or at half of it; each further level keeps one texel of four.

import package::lib::depth_normal::continues_ahead_inside;
import package::lib::depth_pyramid::finer_texel;
import package::lib::fullscreen::fullscreen_position;

/// Previous level, or the depth of the prepass. Bound as an unfilterable float, because OpenGL
/// cannot load texels of depth textures.
@group(0) @binding(0) var finer: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Computes the next level. A side of one texel has no second texel.
@fragment
fn fs_level(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    let last = vec2<i32>(textureDimensions(finer)) - 1;
    return textureLoad(finer, min(finer_texel(vec2<i32>(position.xy)), last), 0).r;
}

/// Copies the depth of the prepass.
@fragment
fn fs_copy(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    return textureLoad(finer, vec2<i32>(position.xy), 0).r;
}

/// Returns the depth of a texel of the prepass, clamped to the edge.
fn finer_depth(texel: vec2<i32>) -> f32 {
    let last = vec2<i32>(textureDimensions(finer)) - 1;
    return textureLoad(finer, clamp(texel, vec2<i32>(0), last), 0).r;
}

/// Returns the change of depth per texel along `axis`, on the side that continues the surface of a
/// texel of the prepass. Returns 0 if the texels of that side are not on a line, as they belong to
/// other surfaces.
fn finer_slope(texel: vec2<i32>, axis: vec2<i32>, here: f32) -> f32 {
    let back = vec2<f32>(finer_depth(texel - 2 * axis), finer_depth(texel - axis));
    let ahead = vec2<f32>(finer_depth(texel + axis), finer_depth(texel + 2 * axis));
    let last = vec2<i32>(textureDimensions(finer)) - 1;
    var near = here - back.y;
    var next = back.y - back.x;
    if continues_ahead_inside(texel, axis, last, back, here, ahead) {
        near = ahead.x - here;
        next = ahead.y - ahead.x;
    }
    return select(0.0, near, abs(next - near) <= 0.25 * abs(near));
}

/// Returns the depth at the center of a texel of half the size: that of one texel of the prepass,
/// moved along its surface.
@fragment
fn fs_half(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    let size = vec2<f32>(textureDimensions(finer));
    let at = position.xy * size / ceil(0.5 * size);
    let texel = vec2<i32>(at);
    let here = finer_depth(texel);
    if here == 0.0 {
        return 0.0;
    }
    let x = finer_slope(texel, vec2<i32>(1, 0), here);
    let y = finer_slope(texel, vec2<i32>(0, 1), here);
    let depth = here + dot(vec2<f32>(x, y), at - vec2<f32>(texel) - 0.5);
    return select(here, min(depth, 1.0), depth > 0.0);
}
