// Final picture: the scene with the glow on top, tone mapped.

@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var glow: texture_2d<f32>;
@group(0) @binding(2) var linear: sampler;

// Weight of the light that the lens scatters.
override GLOW: f32 = 0.35;
// True if the target is not sRGB, so that the shader encodes.
override ENCODE: bool = false;

@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn shown(light: vec3f) -> vec4f {
    let mapped = 1.0 - exp(-light);
    let encoded = select(1.055 * pow(mapped, vec3f(1.0 / 2.4)) - 0.055, mapped * 12.92, mapped <= vec3f(0.0031308));
    return vec4f(select(mapped, encoded, ENCODE), 1.0);
}

@fragment fn fs_plain(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return shown(textureLoad(image, vec2i(at.xy), 0).rgb);
}

@fragment fn fs_glow(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let light = textureLoad(image, vec2i(at.xy), 0).rgb;
    let scattered = textureSampleLevel(glow, linear, at.xy / vec2f(textureDimensions(image)), 0.0).rgb;
    return shown(mix(light, scattered, GLOW));
}
