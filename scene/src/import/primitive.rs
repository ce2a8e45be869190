//! One glTF primitive into one mesh.

use glam::{Vec2, Vec3, Vec4};
use gltf_json::mesh::{Primitive, Semantic};
use gltf_json::validation::Checked;

use super::accessor::{integers, width};
use super::moves::{self, MovesKey};
use super::source::{Source, Warnings};
use super::stream::{finite, stream};
use super::topology::{MODES, list, topology};
use crate::bounds::Aabb;
use crate::error::{SceneError, one_line};
use crate::geometry::{generate_tangents, make_flat, order_for_drawing, repair_tangents};
use crate::material::{AlphaMode, Material};
use crate::mesh::{Mesh, Topology};

/// What a mesh is made of: primitives with equal keys share one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct GeometryKey {
    position: Option<usize>,
    normal: Option<usize>,
    tangent: Option<usize>,
    uv: [Option<usize>; 2],
    color: Option<usize>,
    indices: Option<usize>,
    /// The mode's number in OpenGL; `None` for an invalid one.
    mode: Option<u32>,
    /// The texture coordinates that tangents are wanted for.
    tangent_uv: Option<u32>,
    /// Triangles stay in their order, which shows where they blend.
    blends: bool,
    /// What moves the vertices, if anything does.
    moves: Option<MovesKey>,
}

impl GeometryKey {
    /// The material says which texture coordinates tangents follow, if it asks for them, and whether the order of triangles shows.
    /// A mesh that `node` moves, which has a skin or not, is the node's own.
    pub fn new(primitive: &Primitive, surface: &Material, node: usize, skinned: bool) -> Self {
        let accessor =
            |semantic: Semantic| primitive.attributes.get(&Checked::Valid(semantic)).map(|index| index.value());
        Self {
            position: accessor(Semantic::Positions),
            normal: accessor(Semantic::Normals),
            tangent: accessor(Semantic::Tangents),
            uv: [accessor(Semantic::TexCoords(0)), accessor(Semantic::TexCoords(1))],
            color: accessor(Semantic::Colors(0)),
            indices: primitive.indices.map(|index| index.value()),
            mode: match primitive.mode {
                Checked::Valid(mode) => Some(mode.as_gl_enum()),
                Checked::Invalid => None,
            },
            tangent_uv: surface.tangent_uv_set(),
            blends: surface.alpha == AlphaMode::Blend,
            moves: MovesKey::new(primitive, node, skinned),
        }
    }
}

/// Builds the mesh; `None` when the primitive draws nothing, which is warned of.
pub(super) fn build(
    source: &Source<'_>,
    key: &GeometryKey,
    at: &str,
    name: &str,
    warnings: &mut Warnings,
) -> Result<Option<Mesh>, SceneError> {
    let Some(position) = key.position else {
        return Err(source.malformed(at, "it has no POSITION"));
    };
    let positions = stream(source, at, "POSITION", position, None, Vec3::from_array)?;
    finite(source, at, "POSITION", &positions, |p| p.is_finite())?;
    let vertices = positions.len();
    let Some((topology, indices)) = corners(source, key, at, vertices, warnings)? else {
        return Ok(None);
    };

    let (name, bounds) = (one_line(name), Aabb::from_points(&positions));
    let mut mesh = Mesh { name, bounds, positions, topology, indices, ..Mesh::default() };
    let count = Some(vertices);
    if let Some(key) = &key.moves {
        mesh.moves = Some(Box::new(moves::read(source, key, at, vertices)?));
    }
    for (set, stored) in [&mut mesh.uv0, &mut mesh.uv1].into_iter().enumerate() {
        if let Some(index) = key.uv[set] {
            let what = format!("TEXCOORD_{set}");
            *stored = stream(source, at, &what, index, count, Vec2::from_array)?;
            finite(source, at, &what, stored, |uv| uv.is_finite())?;
        }
    }
    if let Some(index) = key.color {
        mesh.colors = colors(source, at, index, vertices)?;
    }
    match key.normal {
        Some(index) => {
            mesh.normals = normals(source, at, index, vertices)?;
            // Tangents without normals are to be ignored (section 3.7.2.1).
            if let Some(index) = key.tangent {
                let tangents = stream(source, at, "TANGENT", index, count, Vec4::from_array)?;
                finite(source, at, "TANGENT", &tangents, |t| t.is_finite())?;
                mesh.tangents = tangents;
                let replaced = repair_tangents(&mut mesh);
                if replaced > 0 {
                    warnings.push(format!("{at}: {replaced} unusable tangents were replaced"));
                }
            }
        }
        // Lines and points without normals are not lit (section 3.9.7).
        None if !mesh.has_area() => {}
        None => {
            let dropped = make_flat(&mut mesh);
            if dropped > 0 {
                warnings.push(format!("{at}: {dropped} triangles without area were dropped"));
            }
        }
    }
    if let Some(uv_set) = key.tangent_uv
        && mesh.tangents.is_empty()
        && !mesh.normals.is_empty()
    {
        generate_tangents(&mut mesh, uv_set);
    }
    mesh.check().map_err(|error| source.malformed(at, error.to_string()))?;
    if !key.blends && !source.keep_order {
        order_for_drawing(&mut mesh);
    }
    Ok((!mesh.indices.is_empty()).then_some(mesh))
}

/// The list of primitives, every corner below `vertices`; `None` with a warning when there is none.
fn corners(
    source: &Source<'_>,
    key: &GeometryKey,
    at: &str,
    vertices: usize,
    warnings: &mut Warnings,
) -> Result<Option<(Topology, Vec<u32>)>, SceneError> {
    let mode = MODES
        .into_iter()
        .find(|mode| Some(mode.as_gl_enum()) == key.mode)
        .ok_or_else(|| source.malformed(at, "unknown primitive mode"))?;
    let topology = topology(mode);
    let corners = match key.indices {
        Some(index) => integers(source, index, &format!("{at} indices"))?,
        None => {
            source.charge(vertices as u64 * 4)?;
            (0..vertices as u32).collect()
        }
    };
    if let Some(place) = corners.iter().position(|&c| c as usize >= vertices) {
        let reason = format!("index {place} names vertex {}, but there are {vertices}", corners[place]);
        return Err(source.malformed(at, reason));
    }
    // A strip or fan has up to three corners a vertex.
    source.charge(corners.len() as u64 * 12)?;
    let Some(list) = list(mode, &corners) else {
        let reason = format!("{} indices do not make {}", corners.len(), topology.name());
        return Err(source.malformed(at, reason));
    };
    if list.is_empty() {
        warnings.push(match topology {
            Topology::Triangles => format!("{at}: it has no triangle with three different corners"),
            Topology::Lines => format!("{at}: it has no line between two different vertices"),
            Topology::Points => format!("{at}: it has no points"),
        });
        return Ok(None);
    }
    Ok(Some((topology, list)))
}

/// Reads normals to unit length; a zero-length one is an error, since no direction can stand for it.
fn normals(source: &Source<'_>, at: &str, index: usize, vertices: usize) -> Result<Vec<Vec3>, SceneError> {
    let mut normals = stream(source, at, "NORMAL", index, Some(vertices), Vec3::from_array)?;
    finite(source, at, "NORMAL", &normals, |n| n.is_finite())?;
    for (i, normal) in normals.iter_mut().enumerate() {
        let length = normal.as_dvec3().length();
        if length < 1e-6 {
            return Err(source.malformed(at, format!("NORMAL of vertex {i} has zero length")));
        }
        *normal = (normal.as_dvec3() / length).as_vec3();
    }
    Ok(normals)
}

/// Reads RGB or RGBA vertex colors.
fn colors(source: &Source<'_>, at: &str, index: usize, vertices: usize) -> Result<Vec<Vec4>, SceneError> {
    let count = Some(vertices);
    let colors = if width(source, index) == Some(3) {
        let opaque = |rgb| Vec3::from_array(rgb).extend(1.0);
        stream(source, at, "COLOR_0", index, count, opaque)?
    } else {
        stream(source, at, "COLOR_0", index, count, Vec4::from_array)?
    };
    finite(source, at, "COLOR_0", &colors, |c| c.is_finite())?;
    Ok(colors)
}
