// Lines around objects, from object numbers and depth. A texel is on an outline if a texel one or two steps away along an
// axis belongs to another object and is farther away. The line is inside the object in front.

@group(0) @binding(0) var ids: texture_2d<f32>;
// Depth as a float texture, because OpenGL shaders cannot load texels of a depth texture.
@group(0) @binding(1) var depth: texture_2d<f32>;
@group(0) @binding(2) var<uniform> color: vec4f;

@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn number(at: vec2i) -> u32 {
    return u32(round(textureLoad(ids, at, 0).a * 255.0));
}

@fragment fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = vec2i(position.xy);
    let last = vec2i(textureDimensions(ids)) - 1;
    let own = number(at);
    let own_depth = textureLoad(depth, at, 0).x;
    var steps = array(vec2i(1, 0), vec2i(-1, 0), vec2i(0, 1), vec2i(0, -1));
    for (var i = 0; i < 8; i++) {
        let other = clamp(at + steps[i % 4] * (1 + i / 4), vec2i(), last);
        // Depth is reversed: farther is smaller.
        if number(other) != own && textureLoad(depth, other, 0).x < own_depth {
            return color;
        }
    }
    discard;
}
