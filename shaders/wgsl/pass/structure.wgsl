// Structure: the depth of the scene as a pyramid, for effects that look around in it. Level 0 is
// drawn by the shader of the depth prepass; each further one keeps a texel of four.

import package::lib::depth_pyramid::finer_texel;
import package::lib::fullscreen::fullscreen_position;

/// The level above. Loaded as an unfilterable float: OpenGL loads no texels of depth textures as
/// such.
@group(0) @binding(0) var finer: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// The next level. A side of one texel has no second one.
@fragment
fn fs_level(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    let last = vec2<i32>(textureDimensions(finer)) - 1;
    return textureLoad(finer, min(finer_texel(vec2<i32>(position.xy)), last), 0).r;
}
