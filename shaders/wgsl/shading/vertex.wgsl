// A surface as it is drawn: what the vertex stage hands on, and the normals made of it.
//
// Feature TEXTURED: the material has a texture; without it no texture coordinates are handed on,
// and tangents only where anisotropy follows them. VERTEX_COLORS: the mesh has colors.

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

/// What the vertex stage of surfaces hands on.
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
    /// Meters a unit of the mesh, the mean over its axes.
    @if(TRANSMISSION || DIFFUSE_TRANSMISSION)
    @location(5) @interpolate(flat) scale_m: f32,
    /// Number of the material.
    @if(MATERIAL_TABLE)
    @location(6) @interpolate(flat) material: u32,
}

/// What a vertex of a mesh hands on; `uv` has both sets.
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
    vertex.position = clip_position(world);
    vertex.world = world;
    vertex.normal = world_normal(normal, instance);
    @if(TEXTURED || ANISOTROPY)
    vertex.tangent =
        vec4<f32>(world_tangent(tangent.xyz, instance), tangent.w * handedness(instance));
    @if(TEXTURED) vertex.uv = uv;
    @if(VERTEX_COLORS) vertex.color = color;
    @if(TRANSMISSION || DIFFUSE_TRANSMISSION)
    vertex.scale_m = mesh_scale_m(instance);
    @if(MATERIAL_TABLE) vertex.material = material_number(instance);
    return vertex;
}

/// Both sets of texture coordinates, where a texture is there to be read.
fn texture_uv(vertex: SurfaceVertex) -> vec4<f32> {
    @if(TEXTURED) return vertex.uv;
    @else return vec4<f32>(0.0);
}

/// What the base color is multiplied by.
fn vertex_color(vertex: SurfaceVertex) -> vec4<f32> {
    @if(VERTEX_COLORS) return vertex.color;
    @else return vec4<f32>(1.0);
}

/// The triangle's own normal, toward the viewer: window y runs downward, hence the order of the
/// factors. Derivatives need every lane of the quad. Lines and points have no plane: theirs is the
/// normal of the mesh.
fn geometric_normal(vertex: SurfaceVertex) -> vec3<f32> {
    if material_has(TRAIT_NO_AREA) {
        return normalize_or(vertex.normal, vec3<f32>(0.0, 0.0, 1.0));
    }
    return normalize_or(
        cross(dpdy(vertex.world), dpdx(vertex.world)),
        vec3<f32>(0.0, 0.0, 1.0),
    );
}

/// +1 on front faces, -1 on the back faces of double-sided materials. Single-sided ones have
/// no visible back faces: the pipeline culls them. It flips its winding for mirrored objects, so
/// their fronts are fronts here.
fn face_sign(front_facing: bool) -> f32 {
    if !material_has(TRAIT_DOUBLE_SIDED) {
        return 1.0;
    }
    return select(-1.0, 1.0, front_facing);
}

/// The interpolated normal in world space, of unit length, facing the side that is seen.
fn smooth_normal(vertex: SurfaceVertex, geometric: vec3<f32>, side: f32) -> vec3<f32> {
    return vertex_normal(vertex.normal, geometric * side) * side;
}

/// Unit shading normal in world space: `smooth_side` (of `smooth_normal`) with the normal map.
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

/// A tangent-space normal in world space, facing the side that is seen.
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
