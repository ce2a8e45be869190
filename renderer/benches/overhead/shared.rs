//! Shared parts of both variants: full-screen passes that sample the output of their predecessor.

use framegraph_wgpu::Shader;

/// Number of passes and draws.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub passes: usize,
    pub draws: u32,
}

/// Width and height of a texture in texels.
pub const TEXELS: u32 = 64;

/// First pass, which reads no texture.
pub const FIRST: Shader<'static> = Shader::new(
    "first",
    "@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
        return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
    }
    @fragment fn fs_main() -> @location(0) vec4f { return vec4f(0.5); }",
);

/// The others read the picture before them and a block of constants.
pub const NEXT: Shader<'static> = Shader::new(
    "next",
    "@group(0) @binding(0) var before: texture_2d<f32>;
    @group(0) @binding(1) var<uniform> factor: vec4f;
    @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
        return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
    }
    @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
        return textureLoad(before, vec2u(at.xy), 0) * factor;
    }",
);

/// Constants of a pass.
pub const FACTOR: [f32; 4] = [0.5; 4];
