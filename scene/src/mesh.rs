//! Meshes of triangles, lines or points, stored as separate vertex streams.

use glam::{Vec2, Vec3, Vec4};

use super::bounds::Aabb;
use super::id::Id;
use crate::moves::Moves;
use crate::moves::gather;

/// Id of a mesh of a scene.
pub type MeshId = Id<Mesh>;

/// Primitive topology of a mesh; the importer converts strips, fans and loops to lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Topology {
    /// Triangles with three indices each; front faces are counter-clockwise.
    #[default]
    Triangles,
    /// Lines one pixel wide, with two indices each.
    Lines,
    /// Points one pixel in size, with one index each.
    Points,
}

impl Topology {
    /// Returns the number of indices of a primitive.
    #[must_use]
    pub const fn corners(self) -> usize {
        match self {
            Self::Triangles => 3,
            Self::Lines => 2,
            Self::Points => 1,
        }
    }

    /// Returns the name of the primitives, in the plural.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Lines => "lines",
            Self::Points => "points",
        }
    }
}

/// Indexed mesh.
///
/// Lines and points have no area: they cast no shadows, do not count as occluders, and have no levels of detail.
///
/// Streams have one element per vertex; optional streams may be empty. With separate streams, depth-only passes fetch
/// only what they need, and the uploader chooses the GPU vertex layout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Name, for messages; may be empty.
    pub name: String,
    /// Position of each vertex, in meters; finite.
    pub positions: Vec<Vec3>,
    /// Unit normal of each vertex. May be empty for lines and points with an unlit material.
    pub normals: Vec<Vec3>,
    /// Tangent of each vertex: xyz has unit length and is perpendicular to the normal, w is ±1. The bitangent is w ·
    /// normal × tangent. May be empty.
    pub tangents: Vec<Vec4>,
    /// First set of texture coordinates, v down. May be empty.
    pub uv0: Vec<Vec2>,
    /// Second set of texture coordinates, v down. May be empty.
    pub uv1: Vec<Vec2>,
    /// Vertex colors, linear Rec.709 with alpha, multiplied with the base color; may exceed 1. May be empty.
    pub colors: Vec<Vec4>,
    /// Topology of the primitives.
    pub topology: Topology,
    /// Vertex indices of each primitive, all valid.
    pub indices: Vec<u32>,
    /// Levels of detail with successively fewer triangles ([`Scene::make_levels`](crate::Scene::make_levels)); empty
    /// for a mesh that is always drawn at full detail. Clear them when changing other fields of the mesh.
    pub levels: Vec<MeshLevel>,
    /// Bounding box of all positions.
    pub bounds: Aabb,
    /// Skin influences and morph targets, until they are moved to a [`Body`](crate::motion::Body).
    pub moves: Option<Box<Moves>>,
}

/// Level of detail of a [`Mesh`]: other triangles over the same vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshLevel {
    /// Three valid vertex indices of the mesh per triangle.
    pub indices: Vec<u32>,
    /// Maximum displacement of surfaces, textures, highlights and colors from the full mesh, in meters of model space.
    /// Non-decreasing from level to level.
    pub error_m: f32,
}

impl Mesh {
    /// Returns the number of vertices.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Returns true for triangles; lines and points have no area.
    #[must_use]
    pub fn has_area(&self) -> bool {
        self.topology == Topology::Triangles
    }

    /// Returns the number of primitives of any topology.
    #[must_use]
    pub fn primitive_count(&self) -> usize {
        self.indices.len() / self.topology.corners()
    }

    /// Returns the number of triangles; 0 for lines and points.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        if self.has_area() { self.primitive_count() } else { 0 }
    }

    /// Returns the triangles as triples of vertex indices; none for lines and points.
    pub fn triangles(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        let indices = if self.has_area() { self.indices.as_slice() } else { &[] };
        indices.chunks_exact(3).map(|t| [t[0] as usize, t[1] as usize, t[2] as usize])
    }

    /// Returns the indices of the mesh, then those of its levels.
    pub fn all_indices(&self) -> impl Iterator<Item = &[u32]> {
        std::iter::once(self.indices.as_slice()).chain(self.levels.iter().map(|level| level.indices.as_slice()))
    }

    /// Returns the indices of a level, 0 for the mesh itself; clamped to the coarsest level.
    #[must_use]
    pub fn indices_in(&self, level: u8) -> &[u32] {
        let last = self.levels.len().min(usize::from(level));
        last.checked_sub(1).map_or(&self.indices, |level| &self.levels[level].indices)
    }

    /// Returns the texture coordinates of set 0 or 1; empty if the mesh lacks them.
    #[must_use]
    pub fn uv(&self, set: u32) -> &[Vec2] {
        match set {
            0 => &self.uv0,
            1 => &self.uv1,
            _ => &[],
        }
    }

    /// Replaces the vertices by copies of `source[i]`, in that order, to split or reorder vertices. Indices are
    /// unchanged; levels are removed, since their indices become invalid.
    ///
    /// # Panics
    ///
    /// If a source is not a vertex of this mesh.
    pub(crate) fn gather_vertices(&mut self, source: &[u32]) {
        self.levels.clear();
        gather(&mut self.positions, source);
        gather(&mut self.normals, source);
        gather(&mut self.tangents, source);
        gather(&mut self.uv0, source);
        gather(&mut self.uv1, source);
        gather(&mut self.colors, source);
        if let Some(moves) = &mut self.moves {
            moves.gather_vertices(source);
        }
    }

    /// Checks every guarantee of this type.
    ///
    /// # Errors
    ///
    /// Returns the first violated guarantee. Importers report it with the file.
    pub fn check(&self) -> Result<(), MeshError> {
        let vertices = self.positions.len();
        for (stream, length, optional) in [
            ("normals", self.normals.len(), !self.has_area()),
            ("tangents", self.tangents.len(), true),
            ("uv0", self.uv0.len(), true),
            ("uv1", self.uv1.len(), true),
            ("colors", self.colors.len(), true),
        ] {
            if length != vertices && !(optional && length == 0) {
                return Err(MeshError::Length { stream, length, vertices });
            }
        }
        for indices in self.all_indices() {
            if !indices.len().is_multiple_of(self.topology.corners()) {
                return Err(MeshError::Primitives { indices: indices.len(), topology: self.topology });
            }
            if let Some(&index) = indices.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::Index { index, vertices });
            }
        }
        if !self.has_area() && !self.levels.is_empty() {
            return Err(MeshError::Levels { topology: self.topology });
        }
        let mut least = 0.0;
        for (level, error_m) in self.levels.iter().map(|level| level.error_m).enumerate() {
            if !error_m.is_finite() || error_m < least {
                return Err(MeshError::Level { level: level + 1, error_m });
            }
            least = error_m;
        }
        first_bad("position", &self.positions, |p| p.is_finite())?;
        first_bad("normal", &self.normals, |n| (n.length() - 1.0).abs() < 1e-3)?;
        first_bad("tangent", &self.tangents, |t| (t.truncate().length() - 1.0).abs() < 1e-3 && t.w.abs() == 1.0)?;
        first_bad("uv0", &self.uv0, |uv| uv.is_finite())?;
        first_bad("uv1", &self.uv1, |uv| uv.is_finite())?;
        first_bad("color", &self.colors, |c| c.is_finite())
    }
}

/// Returns the first element that fails `good`.
fn first_bad<const N: usize, T: Copy + Into<[f32; N]>>(
    element: &'static str,
    stream: &[T],
    good: impl Fn(&T) -> bool,
) -> Result<(), MeshError> {
    match stream.iter().position(|v| !good(v)) {
        Some(vertex) => Err(MeshError::Value { element, vertex, value: stream[vertex].into().to_vec() }),
        None => Ok(()),
    }
}

/// Error in a mesh.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A stream does not have one element per vertex.
    #[error("{length} {stream} for {vertices} vertices")]
    Length {
        /// Name of the stream: `normals`.
        stream: &'static str,
        /// Number of its elements.
        length: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// The number of indices is not a multiple of the indices per primitive.
    #[error("{indices} indices are not {}", topology.name())]
    Primitives {
        /// Number of indices.
        indices: usize,
        /// Topology of the mesh.
        topology: Topology,
    },
    /// A mesh without area has levels of detail.
    #[error("{} have no levels of detail", topology.name())]
    Levels {
        /// Topology of the mesh.
        topology: Topology,
    },
    /// An index refers to a vertex that does not exist.
    #[error("index {index} of {vertices} vertices")]
    Index {
        /// Invalid index.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// The error of a level is not finite, or smaller than that of the previous level.
    #[error("level {level} is {error_m} m from the mesh")]
    Level {
        /// Number of the level; the mesh itself is 0.
        level: usize,
        /// Error of the level.
        error_m: f32,
    },
    /// A number is not finite, or a direction is not of unit length.
    #[error("{element} of vertex {vertex} is {value:?}")]
    Value {
        /// Name of the attribute: `normal`.
        element: &'static str,
        /// Number of the vertex.
        vertex: usize,
        /// Components of the attribute at that vertex.
        value: Vec<f32>,
    },
}

impl std::fmt::Debug for MeshError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        Mesh {
            bounds: Aabb::from_points(&positions),
            positions,
            normals: vec![Vec3::Z; 3],
            indices: vec![0, 1, 2],
            ..Mesh::default()
        }
    }

    #[test]
    fn every_broken_promise_is_found() {
        assert_eq!(triangle().check(), Ok(()));
        type Damage = fn(&mut Mesh);
        let broken: [(&str, Damage); 14] = [
            ("index 7 of 3 vertices", |m| m.levels = vec![MeshLevel { indices: vec![0, 7, 2], error_m: 0.0 }]),
            ("level 1 is NaN m", |m| m.levels = vec![MeshLevel { error_m: f32::NAN, ..MeshLevel::default() }]),
            ("level 2 is 0.5 m", |m| {
                m.levels = [1.0, 0.5].map(|error_m| MeshLevel { error_m, ..MeshLevel::default() }).to_vec();
            }),
            ("2 normals for 3 vertices", |m| m.normals.truncate(2)),
            ("1 uv1 for 3 vertices", |m| m.uv1.push(Vec2::ZERO)),
            ("2 indices are not triangles", |m| m.indices.truncate(2)),
            ("3 indices are not lines", |m| m.topology = Topology::Lines),
            ("0 normals for 3 vertices", |m| m.normals.clear()),
            ("1 normals for 3 vertices", |m| {
                m.topology = Topology::Points;
                m.normals.truncate(1);
            }),
            ("points have no levels of detail", |m| {
                m.topology = Topology::Points;
                m.levels = vec![MeshLevel::default()];
            }),
            ("index 3 of 3 vertices", |m| m.indices = vec![0, 3, 2]),
            ("position of vertex 0 is [NaN", |m| {
                m.positions[0] = Vec3::NAN;
            }),
            ("normal of vertex 2 is [0.0, 0.0, 0.0]", |m| m.normals[2] *= 0.0),
            ("tangent of vertex 0 is [1.0, 0.0, 0.0, 0.0]", |m| {
                m.tangents.resize(3, Vec4::X);
            }),
        ];
        for (message, damage) in broken {
            let mut mesh = triangle();
            damage(&mut mesh);
            let said = mesh.check().expect_err(message).to_string();
            assert!(said.starts_with(message), "{said} / {message}");
        }
    }

    /// Lines and points may lack normals, and never have triangles.
    #[test]
    fn lines_and_points_have_no_triangles() {
        for topology in [Topology::Lines, Topology::Points] {
            let mesh = Mesh { topology, normals: Vec::new(), indices: vec![0, 1, 2, 0, 1, 2], ..triangle() };
            assert_eq!((mesh.check(), mesh.triangle_count(), mesh.triangles().count()), (Ok(()), 0, 0));
            assert_eq!(mesh.primitive_count(), 6 / topology.corners());
        }
    }

    #[test]
    fn gathering_copies_every_stream() {
        let mut mesh = triangle();
        mesh.uv0 = vec![Vec2::ZERO, Vec2::X, Vec2::Y];
        mesh.gather_vertices(&[2, 2, 0, 1]);
        assert_eq!(mesh.positions, [Vec3::Y, Vec3::Y, Vec3::ZERO, Vec3::X]);
        assert_eq!(mesh.uv0, [Vec2::Y, Vec2::Y, Vec2::ZERO, Vec2::X]);
        assert_eq!(mesh.normals.len(), 4);
        assert!(mesh.uv1.is_empty());
    }
}
