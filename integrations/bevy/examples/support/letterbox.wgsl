// Two bars: instance 0 at the bottom, instance 1 at the top.

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32, @builtin(instance_index) bar: u32) -> @builtin(position) vec4<f32> {
    let right = vertex == 1u || vertex == 2u || vertex == 4u;
    let upper = vertex == 2u || vertex == 4u || vertex == 5u;
    let bottom = select(-1.0, 0.75, bar == 1u);
    return vec4<f32>(select(-1.0, 1.0, right), bottom + select(0.0, 0.25, upper), 0.0, 1.0);
}

@fragment
fn fs_main() -> @location(0) vec4<f32> {
    return vec4<f32>(0.0, 0.0, 0.0, 1.0);
}
