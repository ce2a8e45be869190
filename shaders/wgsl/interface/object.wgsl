// Group 2: one element per object. Draws are instanced: the number of the object comes with the
// instance, from the third vertex stream.

import package::interface::frame::frame;
import package::lib::numerics::normalize_or;

/// Placement of an object. Mirrored by `layout::ObjectUniforms`, which fills it.
struct ObjectUniforms {
    /// Model to world space, without the translation, which depends on the eye: its last column is
    /// that of the identity.
    world_from_model: mat4x4<f32>,
    /// Columns of the matrix that carries normals: cofactors of the upper 3×3, scaled to a
    /// largest entry of one, times the sign of the determinant. Cofactors exist where the
    /// inverse does not (hard case 38).
    normal_column_x: vec3<f32>,
    /// Sign of the determinant, ±1: -1 for mirrored objects.
    handedness: f32,
    normal_column_y: vec3<f32>,
    /// Number of its material.
    material: u32,
    normal_column_z: vec3<f32>,
}

@group(2) @binding(0) var<storage, read> objects: array<ObjectUniforms>;
/// Where the zero point of each object's mesh is, in m; xyz.
@group(2) @binding(1) var<storage, read> origins: array<vec4<f32>>;

/// World position in m of a model position.
fn world_position(position: vec3<f32>, instance: u32) -> vec3<f32> {
    let turned = objects[instance].world_from_model;
    let origin = vec4<f32>(origins[instance].xyz, 1.0);
    return (mat4x4<f32>(turned[0], turned[1], turned[2], origin) * vec4<f32>(position, 1.0)).xyz;
}

/// Clip position of a world position. The depth prepass and the color pass must agree to the
/// bit, or an Equal depth test punches holes: both go through here and both mark their output
/// @invariant.
fn clip_position(world: vec3<f32>) -> vec4<f32> {
    return frame.clip_from_world * vec4<f32>(world, 1.0);
}

/// World-space unit normal of a model normal, or zero where the transform flattens it away;
/// the fragment stage then falls back to the triangle's own normal.
fn world_normal(normal: vec3<f32>, instance: u32) -> vec3<f32> {
    let n = objects[instance].normal_column_x * normal.x
        + objects[instance].normal_column_y * normal.y
        + objects[instance].normal_column_z * normal.z;
    return normalize_or(n, vec3<f32>(0.0));
}

/// Meters that a unit of the mesh becomes, the mean over its axes.
fn mesh_scale_m(instance: u32) -> f32 {
    let m = objects[instance].world_from_model;
    return (length(m[0].xyz) + length(m[1].xyz) + length(m[2].xyz)) / 3.0;
}

/// World-space unit tangent of a model tangent, or zero where there is none.
fn world_tangent(tangent: vec3<f32>, instance: u32) -> vec3<f32> {
    let m = objects[instance].world_from_model;
    let t = m[0].xyz * tangent.x + m[1].xyz * tangent.y + m[2].xyz * tangent.z;
    return normalize_or(t, vec3<f32>(0.0));
}
