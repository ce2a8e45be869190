// Cube maps: directions of points on the faces.
//
// Faces have the order +X -X +Y -Y +Z -Z and are seen from inside with v pointing down, as WebGPU
// and Vulkan (section 16.5.4) define them. Sampling a cube with the direction below returns the
// texel that was rendered at uv of the face.

/// Returns the direction through uv in [0, 1]² of face 0…5; its largest component is ±1. Not
/// normalized.
fn direction_from_cube_uv(face: u32, uv: vec2<f32>) -> vec3<f32> {
    let s = 2.0 * uv.x - 1.0;
    let t = 2.0 * uv.y - 1.0;
    switch face {
        case 0u: { return vec3<f32>(1.0, -t, -s); }
        case 1u: { return vec3<f32>(-1.0, -t, s); }
        case 2u: { return vec3<f32>(s, 1.0, t); }
        case 3u: { return vec3<f32>(s, -1.0, -t); }
        case 4u: { return vec3<f32>(s, -t, 1.0); }
        default: { return vec3<f32>(-s, -t, -1.0); }
    }
}

/// Returns the solid angle per uv area, relative to the center of the face: (1 + s² + t²)^(-3/2),
/// from 1 to 0.19 in the corners. It is the weight of a texel.
fn cube_solid_angle_weight(uv: vec2<f32>) -> f32 {
    let p = 2.0 * uv - 1.0;
    let r2 = 1.0 + dot(p, p);
    return inverseSqrt(r2) / r2;
}
