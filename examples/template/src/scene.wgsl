// The scene: rings that move outward.
@group(0) @binding(0) var<uniform> seconds: vec4f;

@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let distance = length(at.xy - vec2f(320.0, 240.0)) / 40.0;
    let ring = 0.5 + 0.5 * cos(distance - 2.0 * seconds.x);
    return vec4f(ring, 0.3 * ring, 2.0 * (1.0 - ring), 1.0);
}
