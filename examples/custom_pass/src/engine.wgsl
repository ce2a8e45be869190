// Shaders of the engine: shaded shapes, with normals and object numbers for post effects.

struct View {
    clip_from_world: mat4x4f,
    // Direction toward the light, and the fraction of ambient light.
    light: vec4f,
}
@group(0) @binding(0) var<uniform> view: View;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}
struct Instance {
    @location(2) x: vec4f,
    @location(3) y: vec4f,
    @location(4) z: vec4f,
    @location(5) w: vec4f,
    // Linear color, and the emission as a multiple of it.
    @location(6) color: vec4f,
    @location(7) number: u32,
}
struct Surface {
    @builtin(position) at: vec4f,
    @location(0) normal: vec3f,
    @location(1) @interpolate(flat) color: vec4f,
    @location(2) @interpolate(flat) number: u32,
}
struct Targets {
    @location(0) color: vec4f,
    // Normal mapped to 0…1, and the object number: 0 for the backdrop.
    @location(1) id: vec4f,
}

@vertex fn vs_shape(vertex: Vertex, instance: Instance) -> Surface {
    let world = mat4x4f(instance.x, instance.y, instance.z, instance.w);
    var out: Surface;
    out.at = view.clip_from_world * world * vec4f(vertex.position, 1.0);
    // Shapes are scaled uniformly, so normals transform like positions.
    out.normal = normalize((world * vec4f(vertex.normal, 0.0)).xyz);
    out.color = instance.color;
    out.number = instance.number;
    return out;
}

@fragment fn fs_shape(in: Surface) -> Targets {
    let normal = normalize(in.normal);
    let lit = view.light.w + (1.0 - view.light.w) * max(dot(normal, view.light.xyz), 0.0);
    let color = in.color.rgb * (lit + in.color.a);
    return Targets(vec4f(color, 1.0), vec4f(normal * 0.5 + 0.5, f32(in.number) / 255.0));
}

@vertex fn vs_backdrop(@builtin(vertex_index) i: u32) -> Surface {
    var out: Surface;
    // One full-screen triangle on the far plane: depth is reversed, 0 is at infinity.
    out.at = vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
    // Height within the picture, 0…1.
    out.normal = vec3f(0.0, f32(i >> 1u) * 2.0, 0.0);
    return out;
}

@fragment fn fs_backdrop(in: Surface) -> Targets {
    let dusk = mix(vec3f(0.060, 0.045, 0.070), vec3f(0.010, 0.012, 0.030), in.normal.y);
    return Targets(vec4f(dusk, 1.0), vec4f(0.5, 0.5, 1.0, 0.0));
}
