// Depth pyramid of visible surfaces, for screen-space effects. The shader of the depth prepass
// draws level 0; each further level keeps one texel of four.

import package::lib::depth_pyramid::finer_texel;
import package::lib::fullscreen::fullscreen_position;

/// Previous level. Bound as an unfilterable float, because OpenGL cannot load texels of depth
/// textures.
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
