// One depth per texel from several samples, for effects that read depth.

import package::lib::fullscreen::fullscreen_position;

/// Which sample counts: 0 the first, 1 the nearest, 2 the farthest. Depth is reversed: nearer is larger.
override DEPTH_RESOLVE: u32 = 0u;

/// Loaded as unfilterable floats: OpenGL loads no texels of depth textures as such.
@group(0) @binding(0) var depth_samples: texture_multisampled_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    let at = vec2<i32>(position.xy);
    var depth = textureLoad(depth_samples, at, 0).r;
    if DEPTH_RESOLVE != 0u {
        for (var sample = 1; sample < i32(textureNumSamples(depth_samples)); sample++) {
            let other = textureLoad(depth_samples, at, sample).r;
            depth = select(min(depth, other), max(depth, other), DEPTH_RESOLVE == 1u);
        }
    }
    return depth;
}
