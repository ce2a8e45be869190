// Depth pyramid of visible surfaces, and the positions of its texels.

import package::lib::depth_normal::continues_ahead_inside;
import package::lib::depth_pyramid::finest_texel;
import package::lib::unproject::{Projection, view_position};

/// Reversed depth, all levels or the first; 0 for the background. Bound as an unfilterable float.
@group(0) @binding(20) var structure: texture_2d<f32>;

/// Result of a tap.
struct StructureTap {
    /// Position in view space, in m; invalid if `hit` is false.
    position: vec3<f32>,
    /// True if there is a surface.
    hit: bool,
}

/// Returns the normalized device coordinates of a point in texels of level 0.
fn structure_ndc(texels: vec2<f32>) -> vec2<f32> {
    let uv = texels / vec2<f32>(textureDimensions(structure));
    return vec2<f32>(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0);
}

/// Returns the depth of a texel of level 0, clamped to the edge (hard case 36).
fn structure_depth(texel: vec2<i32>) -> f32 {
    let last = vec2<i32>(textureDimensions(structure)) - 1;
    return textureLoad(structure, clamp(texel, vec2<i32>(0), last), 0).r;
}

/// Returns the view-space position of a texel of level 0 with that depth, which must not be 0.
fn structure_position(texel: vec2<i32>, depth: f32, projection: Projection) -> vec3<f32> {
    return view_position(structure_ndc(vec2<f32>(texel) + 0.5), depth, projection);
}

/// Returns the surface at a point in texels of level 0, read from `level`. The position is that of
/// the texel whose depth was read.
fn structure_tap(at: vec2<f32>, level: i32, projection: Projection) -> StructureTap {
    let size = vec2<i32>(textureDimensions(structure)) >> vec2<u32>(u32(level));
    let last = max(size, vec2<i32>(1)) - 1;
    let coarse = clamp(vec2<i32>(floor(at)) >> vec2<u32>(u32(level)), vec2<i32>(0), last);
    let depth = textureLoad(structure, coarse, level).r;
    if depth == 0.0 {
        return StructureTap(vec3<f32>(0.0), false);
    }
    return StructureTap(structure_position(finest_texel(coarse, level), depth, projection), true);
}

/// Returns the change of a texel's position along `axis`, in m per texel, on the side that
/// continues the surface.
fn structure_tangent(
    texel: vec2<i32>,
    axis: vec2<i32>,
    depth: f32,
    position: vec3<f32>,
    projection: Projection,
) -> vec3<f32> {
    let back = vec2<f32>(structure_depth(texel - 2 * axis), structure_depth(texel - axis));
    let ahead = vec2<f32>(structure_depth(texel + axis), structure_depth(texel + 2 * axis));
    let last = vec2<i32>(textureDimensions(structure)) - 1;
    if continues_ahead_inside(texel, axis, last, back, depth, ahead) {
        return structure_position(texel + axis, max(ahead.x, 1e-30), projection) - position;
    }
    return position - structure_position(texel - axis, max(back.y, 1e-30), projection);
}
