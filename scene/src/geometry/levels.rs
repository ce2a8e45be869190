//! Levels of detail: a surface with successively fewer triangles.

mod collapse;
mod deviation;
mod fan;
mod quadric;
mod stream;
mod tree;

pub use self::stream::ReadStreams;

use self::collapse::Collapse;
use self::deviation::deviation;
use self::stream::streams;
use super::order::drawn_order;
use crate::bounds::Aabb;
use crate::mesh::{Mesh, MeshLevel};

/// Minimum number of triangles of a mesh with levels of detail.
const LEAST_TRIANGLES: usize = 128;
/// Maximum number of triangles of a mesh with levels of detail. Simplification needs up to 1.5 KB per vertex, which the
/// memory budget does not count.
const MAX_TRIANGLES: usize = 1 << 22;
/// Maximum number of levels, excluding the mesh itself.
const MAX_LEVELS: usize = 7;
/// Maximum ratio of a level's triangles to those of the previous level.
const WORTH_IT: f64 = 0.8;
/// Maximum error of a level relative to the mesh radius.
const MAX_ERROR: f64 = 0.1;
/// Minimum area of a level relative to the mesh. Meshes of many separate parts, such as leaves, would otherwise lose
/// parts without a geometric error.
const LEAST_AREA: f64 = 0.9;

/// Returns levels of detail of `mesh` and their errors; each level has about half the triangles of the previous one.
/// Empty for meshes of fewer than 128 or more than four million triangles, and for deforming meshes.
#[must_use]
pub fn levels_of_detail(mesh: &Mesh, read: ReadStreams) -> Vec<MeshLevel> {
    let mut levels: Vec<MeshLevel> = Vec::new();
    let counts = LEAST_TRIANGLES..=MAX_TRIANGLES;
    if !counts.contains(&mesh.triangle_count()) || mesh.moves.is_some() {
        return levels;
    }
    let used = mesh.indices.iter().fold(Aabb::EMPTY, |all, i| all.including(mesh.positions[*i as usize].as_dvec3()));
    let streams = streams(mesh, read);
    let mut collapse = Collapse::new(mesh, &streams, &used);
    let (whole, mut triangles) = (area(mesh, &mesh.indices), mesh.triangle_count());
    while levels.len() < MAX_LEVELS {
        collapse.reduce(triangles / 2);
        let (left, indices) = (collapse.left(), collapse.indices());
        if left as f64 > WORTH_IT * triangles as f64 || area(mesh, &indices) < LEAST_AREA * whole {
            break;
        }
        let Some(error_m) = deviation(mesh, &indices, &streams, (MAX_ERROR * used.radius()) as f32) else { break };
        let error_m = error_m.max(levels.last().map_or(0.0, |level| level.error_m));
        levels.push(MeshLevel { indices: drawn_order(mesh, &indices), error_m });
        triangles = left;
    }
    levels
}

fn area(mesh: &Mesh, indices: &[u32]) -> f64 {
    let twice = |t: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|corner| mesh.positions[t[corner] as usize].as_dvec3());
        (b - a).cross(c - a).length()
    };
    0.5 * indices.chunks_exact(3).map(twice).sum::<f64>()
}

#[cfg(test)]
mod tests;
