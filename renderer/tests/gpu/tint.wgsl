@group(0) @binding(0) var<uniform> tint: vec4f;

@vertex
fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
}

@fragment
fn fs_main() -> @location(0) vec4f {
    return tint;
}
