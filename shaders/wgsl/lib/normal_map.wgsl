// From a tangent-space normal map to a world-space normal.
//
// glTF 2.0 section 3.9.3 and the MikkTSpace convention: the interpolated normal and tangent are
// neither normalized nor orthogonalized. The bitangent is cross(normal, tangent.xyz) · tangent.w.
// Only the result is normalized.

import package::lib::numerics::{normalize_or, DEGENERATE_LENGTH2};

/// Returns the tangent-space normal of a texel in [0, 1]³, with x and y scaled by glTF's normal
/// scale. Not normalized.
fn unpack_normal(texel: vec3<f32>, scale: f32) -> vec3<f32> {
    let n = texel * 2.0 - 1.0;
    return vec3<f32>(n.xy * scale, n.z);
}

/// Returns a unit vector perpendicular to the unit vector n, continuous except where n.z changes
/// sign (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017). Replaces a missing
/// tangent (hard case 10).
fn duff_tangent(n: vec3<f32>) -> vec3<f32> {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    return vec3<f32>(1.0 + s * n.x * n.x * a, s * n.x * n.y * a, -s * n.x);
}

/// Normalizes an interpolated normal. Returns `geometric` (the triangle's normal) for a zero
/// vector, as between opposite normals (hard case 9).
fn vertex_normal(interpolated: vec3<f32>, geometric: vec3<f32>) -> vec3<f32> {
    if dot(interpolated, interpolated) < DEGENERATE_LENGTH2 {
        return geometric;
    }
    return normalize_or(interpolated, geometric);
}

/// Returns the world-space unit normal of a tangent-space normal.
///
/// normal and tangent: interpolated, in world space. handedness: ±1, tangent.w times the sign of
/// the model matrix's determinant. Duff's frame replaces a tangent that is zero or parallel to the
/// normal.
fn apply_normal_map(
    tangent_space: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec3<f32>,
    handedness: f32,
) -> vec3<f32> {
    var t = tangent;
    var b = cross(normal, tangent);
    if dot(b, b) < DEGENERATE_LENGTH2 {
        t = duff_tangent(normalize_or(normal, vec3<f32>(0.0, 0.0, 1.0)));
        b = cross(normal, t);
    }
    let n = t * tangent_space.x + b * (handedness * tangent_space.y) + normal * tangent_space.z;
    return normalize_or(n, normal);
}
