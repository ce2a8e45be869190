//! Levels of detail: the same surface in fewer and fewer triangles.

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

/// Meshes of fewer triangles have no levels.
const LEAST_TRIANGLES: usize = 128;
/// Nor have meshes of more: what making them takes, up to a kilobyte and a half a vertex, no budget counts.
const MAX_TRIANGLES: usize = 1 << 22;
/// The most levels of a mesh, beside the mesh itself.
const MAX_LEVELS: usize = 7;
/// A level of more than so many times as many triangles as the one before is not made.
const WORTH_IT: f64 = 0.8;
/// Nor one that is farther from the mesh than so many times the mesh's radius.
const MAX_ERROR: f64 = 0.1;
/// Nor one of less than so many times the mesh's area: of leaves that go one by one the others are where they were.
const LEAST_AREA: f64 = 0.9;

/// Levels of `mesh`, each of about half the triangles of the one before, with how far it is from the mesh. None of a mesh with less
/// than 128 triangles or more than four million, or one whose vertices move.
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
