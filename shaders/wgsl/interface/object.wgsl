// Transforms of objects. Draws are instanced, and the third vertex stream is per instance. It holds
// the object's index in the buffers of group 2 or, with INSTANCE_STREAM, all attributes of the
// object. Mesa's software driver reads buffers per vertex, but this stream once.

import package::interface::frame::frame;
@if(STEREO)
import package::interface::frame::eyes;
import package::lib::numerics::normalize_or;

/// Transform of an object. Mirrored by `layout::ObjectUniforms`.
struct ObjectUniforms {
    /// Model-to-world matrix. Its translation is relative to the object's reference point, in m.
    world_from_model: mat4x4<f32>,
    /// Columns of the normal matrix: cofactors of the upper 3×3, scaled to a largest entry of one,
    /// times the sign of the determinant. Cofactors exist even without an inverse (hard case 38).
    normal_column_x: vec3<f32>,
    /// Sign of the determinant, ±1: -1 for mirrored objects.
    handedness: f32,
    normal_column_y: vec3<f32>,
    /// Index of its material.
    material: u32,
    normal_column_z: vec3<f32>,
    /// Index of the reference point in `origins`.
    reference_point: u32,
}

@if(!INSTANCE_STREAM)
@group(2) @binding(0) var<storage, read> objects: array<ObjectUniforms>;
/// Reference points of objects relative to the eye, in m; xyz.
@if(!INSTANCE_STREAM)
@group(2) @binding(1) var<storage, read> origins: array<vec4<f32>>;

/// Attributes of an object in a draw, as in `layout::OBJECT_ATTRIBUTES`.
@if(INSTANCE_STREAM)
struct Instance {
    @location(6) number: u32,
    /// Eye that is drawn.
    @if(STEREO)
    @builtin(view_index) eye: u32,
    /// Columns of the model-to-world matrix, in m.
    @location(8) column_x: vec4<f32>,
    @location(9) column_y: vec4<f32>,
    @location(10) column_z: vec4<f32>,
    @location(11) origin: vec4<f32>,
    /// Columns of the normal matrix; w of the first is the sign of the determinant.
    @location(12) normal_column_x: vec4<f32>,
    @location(13) normal_column_y: vec3<f32>,
    @location(14) normal_column_z: vec3<f32>,
    @location(15) material: u32,
}

@else
struct Instance {
    @location(6) number: u32,
    /// Eye that is drawn.
    @if(STEREO)
    @builtin(view_index) eye: u32,
}

/// Returns the model-to-world matrix, in m.
@if(INSTANCE_STREAM)
fn world_from_model(instance: Instance) -> mat4x4<f32> {
    return mat4x4<f32>(
        instance.column_x, instance.column_y, instance.column_z,
        vec4<f32>(instance.origin.xyz, 1.0),
    );
}

@else
fn world_from_model(instance: Instance) -> mat4x4<f32> {
    let placed = objects[instance.number].world_from_model;
    let origin = origins[objects[instance.number].reference_point].xyz + placed[3].xyz;
    return mat4x4<f32>(placed[0], placed[1], placed[2], vec4<f32>(origin, 1.0));
}

/// Returns the normal matrix.
@if(INSTANCE_STREAM)
fn normal_matrix(instance: Instance) -> mat3x3<f32> {
    return mat3x3<f32>(
        instance.normal_column_x.xyz, instance.normal_column_y, instance.normal_column_z,
    );
}

@else
fn normal_matrix(instance: Instance) -> mat3x3<f32> {
    return mat3x3<f32>(
        objects[instance.number].normal_column_x,
        objects[instance.number].normal_column_y,
        objects[instance.number].normal_column_z,
    );
}

/// Returns the sign of the determinant, ±1: -1 for mirrored objects.
@if(INSTANCE_STREAM)
fn handedness(instance: Instance) -> f32 {
    return instance.normal_column_x.w;
}

@else
fn handedness(instance: Instance) -> f32 {
    return objects[instance.number].handedness;
}

/// Returns the index of the object's material.
@if(INSTANCE_STREAM)
fn material_number(instance: Instance) -> u32 {
    return instance.material;
}

@else
fn material_number(instance: Instance) -> u32 {
    return objects[instance.number].material;
}

/// Returns the world position in m of a model position.
fn world_position(position: vec3<f32>, instance: Instance) -> vec3<f32> {
    return (world_from_model(instance) * vec4<f32>(position, 1.0)).xyz;
}

/// Returns the clip position of a world position. Depth prepass and color pass must agree to the
/// bit, because the depth test is Equal. Both use this function and mark their output @invariant.
@if(STEREO)
fn clip_position(world: vec3<f32>, instance: Instance) -> vec4<f32> {
    return eyes[instance.eye].clip_from_world * vec4<f32>(world, 1.0);
}

@else
fn clip_position(world: vec3<f32>, instance: Instance) -> vec4<f32> {
    return frame.clip_from_world * vec4<f32>(world, 1.0);
}

/// Returns the world-space unit normal of a model normal. It is zero if the transform flattens it;
/// the fragment stage then uses the geometric normal.
fn world_normal(normal: vec3<f32>, instance: Instance) -> vec3<f32> {
    let m = normal_matrix(instance);
    let n = m[0] * normal.x + m[1] * normal.y + m[2] * normal.z;
    return normalize_or(n, vec3<f32>(0.0));
}

/// Returns the length of a mesh unit in m, averaged over the axes.
fn mesh_scale_m(instance: Instance) -> f32 {
    let m = world_from_model(instance);
    return (length(m[0].xyz) + length(m[1].xyz) + length(m[2].xyz)) / 3.0;
}

/// Returns the world-space unit tangent of a model tangent, or zero without one.
fn world_tangent(tangent: vec3<f32>, instance: Instance) -> vec3<f32> {
    let m = world_from_model(instance);
    let t = m[0].xyz * tangent.x + m[1].xyz * tangent.y + m[2].xyz * tangent.z;
    return normalize_or(t, vec3<f32>(0.0));
}
