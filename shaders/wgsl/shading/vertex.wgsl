// Output of the vertex stage, and the normals derived from it.
//
// Without the feature TEXTURED there are no texture coordinates, and tangents exist only for
// anisotropy. VERTEX_COLORS: the mesh has colors.

@if(STEREO)
import package::interface::frame::eyes;
import package::interface::object::{
    Instance, world_position, clip_position, world_normal, world_tangent, handedness,
};
@if(TRANSMISSION || DIFFUSE_TRANSMISSION)
import package::interface::object::mesh_scale_m;
@if(MATERIAL_TABLE)
import package::interface::object::material_number;
import package::interface::material::{
    material, SLOT_NORMAL, TRAIT_DOUBLE_SIDED, TRAIT_NO_AREA, material_has, map_uv,
    normal_texture, normal_sampler,
};
import package::lib::normal_map::{unpack_normal, vertex_normal, apply_normal_map};
import package::lib::numerics::normalize_or;

/// Output of the vertex stage for surfaces.
struct SurfaceVertex {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    /// World tangent; w is the sign of the bitangent in world space.
    @if(TEXTURED || ANISOTROPY)
    @location(2) tangent: vec4<f32>,
    @if(TEXTURED)
    @location(3) uv: vec4<f32>,
    @if(VERTEX_COLORS)
    @location(4) color: vec4<f32>,
    /// Length of a mesh unit in m, averaged over the axes.
    @if(TRANSMISSION || DIFFUSE_TRANSMISSION)
    @location(5) @interpolate(flat) scale_m: f32,
    /// Index of the material.
    @if(MATERIAL_TABLE)
    @location(6) @interpolate(flat) material: u32,
    /// Eye that is drawn.
    @if(STEREO)
    @location(7) @interpolate(flat) eye: u32,
}

/// Returns the output for a vertex; `uv` holds both sets of texture coordinates.
fn surface_vertex(
    instance: Instance,
    position: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec4<f32>,
    uv: vec4<f32>,
    color: vec4<f32>,
) -> SurfaceVertex {
    let world = world_position(position, instance);
    var vertex: SurfaceVertex;
    vertex.position = clip_position(world, instance);
    vertex.world = world;
    vertex.normal = world_normal(normal, instance);
    @if(TEXTURED || ANISOTROPY)
    vertex.tangent =
        vec4<f32>(world_tangent(tangent.xyz, instance), tangent.w * handedness(instance));
    @if(TEXTURED) vertex.uv = uv;
    @if(VERTEX_COLORS) vertex.color = color;
    @if(TRANSMISSION || DIFFUSE_TRANSMISSION)
    vertex.scale_m = mesh_scale_m(instance);
    @if(STEREO) vertex.eye = instance.eye;
    @if(MATERIAL_TABLE) vertex.material = material_number(instance);
    return vertex;
}

/// Returns the vector toward the eye that is drawn: of any length, and in m for a perspective.
@if(STEREO)
fn toward_eye(vertex: SurfaceVertex) -> vec3<f32> {
    let camera = eyes[vertex.eye].camera;
    return camera.xyz - camera.w * vertex.world;
}

/// Returns both sets of texture coordinates, or zeros without textures.
fn texture_uv(vertex: SurfaceVertex) -> vec4<f32> {
    @if(TEXTURED) return vertex.uv;
    @else return vec4<f32>(0.0);
}

/// Returns the vertex color, a factor on the base color.
fn vertex_color(vertex: SurfaceVertex) -> vec4<f32> {
    @if(VERTEX_COLORS) return vertex.color;
    @else return vec4<f32>(1.0);
}

/// Returns the triangle's normal, facing the viewer; window y points down, hence the order of
/// factors. Derivatives need every lane of the quad. Lines and points use the mesh's normal.
fn geometric_normal(vertex: SurfaceVertex) -> vec3<f32> {
    if material_has(TRAIT_NO_AREA) {
        return normalize_or(vertex.normal, vec3<f32>(0.0, 0.0, 1.0));
    }
    return normalize_or(
        cross(dpdy(vertex.world), dpdx(vertex.world)),
        vec3<f32>(0.0, 0.0, 1.0),
    );
}

/// Returns +1 on front faces and -1 on back faces of double-sided materials. Back faces of
/// single-sided materials are culled. The pipeline flips its winding for mirrored objects, so
/// front_facing is correct for them.
fn face_sign(front_facing: bool) -> f32 {
    if !material_has(TRAIT_DOUBLE_SIDED) {
        return 1.0;
    }
    return select(-1.0, 1.0, front_facing);
}

/// Returns the interpolated unit normal in world space, facing the visible side.
fn smooth_normal(vertex: SurfaceVertex, geometric: vec3<f32>, side: f32) -> vec3<f32> {
    return vertex_normal(vertex.normal, geometric * side) * side;
}

/// Returns the unit shading normal in world space: `smooth_side` (from `smooth_normal`) with the
/// normal map.
@if(TEXTURED)
fn shading_normal(vertex: SurfaceVertex, smooth_side: vec3<f32>, side: f32) -> vec3<f32> {
    if !material_has(SLOT_NORMAL) {
        return smooth_side;
    }
    let at = map_uv(material.normal_map, vertex.uv);
    let texel = textureSample(normal_texture, normal_sampler, at).xyz;
    return mapped_normal(vertex, smooth_side, side, unpack_normal(texel, material.normal_scale));
}

@else
fn shading_normal(vertex: SurfaceVertex, smooth_side: vec3<f32>, side: f32) -> vec3<f32> {
    return smooth_side;
}

/// Returns a tangent-space normal in world space, facing the visible side.
@if(TEXTURED)
fn mapped_normal(vertex: SurfaceVertex, smooth_side: vec3<f32>, side: f32, tangent_space: vec3<f32>)
    -> vec3<f32>
{
    return side * apply_normal_map(
        tangent_space,
        smooth_side * side,
        vertex.tangent.xyz,
        vertex.tangent.w,
    );
}
