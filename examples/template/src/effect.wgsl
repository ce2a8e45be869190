// The effect: a tone curve. Change and save this file while the program runs.
@group(0) @binding(0) var picture: texture_2d<f32>;

@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let hdr = textureLoad(picture, vec2u(at.xy), 0).rgb;
    return vec4f(hdr / (1.0 + hdr), 1.0);
}
