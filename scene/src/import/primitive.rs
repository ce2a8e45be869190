//! Conversion of a glTF primitive to a mesh.

use glam::{Vec2, Vec3, Vec4};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;

use super::accessor::{integers, width};
use super::moves::{self, MovesKey};
use super::packed::{self, PackedMesh, Values};
use super::source::{Repair, Source, Warnings, beyond};
use super::stream::{finite, stream};
use super::topology::{MODES, left_over, list, topology};
use crate::bounds::Aabb;
use crate::error::{SceneError, one_line};
use crate::geometry::{generate_tangents, make_flat, order_for_drawing, repair_normals, repair_tangents};
use crate::material::{AlphaMode, Material};
use crate::mesh::{Mesh, Topology};

/// Key of geometry: primitives with equal keys share a mesh.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct GeometryKey {
    position: Option<Values>,
    normal: Option<Values>,
    tangent: Option<Values>,
    uv: [Option<Values>; 2],
    color: Option<Values>,
    /// Buffer view of the compressed mesh that contains the indices, if any.
    packed: Option<usize>,
    indices: Option<usize>,
    /// OpenGL number of the mode; `None` for an invalid one.
    mode: Option<u32>,
    /// Set of texture coordinates for tangent generation.
    tangent_uv: Option<u32>,
    /// True if triangles keep their order, which is visible when blending.
    blends: bool,
    /// Skin influences and morph targets, if any.
    moves: Option<MovesKey>,
}

impl GeometryKey {
    /// Creates the key. The material `surface` determines the texture coordinates for tangents, and whether triangle
    /// order matters. A mesh that `node` deforms, `skinned` or not, is not shared. `number` is the primitive's in its
    /// mesh.
    pub fn new(primitive: &Primitive, number: usize, surface: &Material, node: usize, skinned: bool) -> Self {
        let values = |semantic: Semantic| packed::values(primitive, &semantic);
        Self {
            position: values(Semantic::Positions),
            normal: values(Semantic::Normals),
            tangent: values(Semantic::Tangents),
            uv: [values(Semantic::TexCoords(0)), values(Semantic::TexCoords(1))],
            color: values(Semantic::Colors(0)),
            packed: packed::of(primitive).and_then(|extension| extension.view()),
            indices: primitive.indices.map(|index| index.value()),
            mode: match primitive.mode {
                Checked::Valid(mode) => Some(mode.as_gl_enum()),
                Checked::Invalid => None,
            },
            tangent_uv: surface.tangent_uv_set(),
            blends: surface.alpha == AlphaMode::Blend,
            moves: MovesKey::new(primitive, number, node, skinned),
        }
    }
}

/// Builds the mesh; `None`, with a warning, if the primitive draws nothing.
pub(super) fn build(
    source: &Source<'_>,
    key: &GeometryKey,
    at: &str,
    name: &str,
    warnings: &mut Warnings,
) -> Result<Option<Mesh>, SceneError> {
    let Some(position) = key.position else {
        warnings.push(format!("{at}: it has no POSITION and is not drawn"));
        return Ok(None);
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
        mesh.moves = Some(Box::new(moves::read(source, key, at, vertices, warnings)?));
    }
    for (set, stored) in [&mut mesh.uv0, &mut mesh.uv1].into_iter().enumerate() {
        if let Some(index) = key.uv[set] {
            let what = format!("TEXCOORD_{set}");
            *stored = stream(source, at, &what, index, count, Vec2::from_array)?;
            let bad = stored.iter_mut().filter(|uv| !uv.is_finite());
            let repaired = bad.map(|uv| *uv = Vec2::ZERO).count();
            warnings.count(Repair::TexCoords, at, repaired);
        }
    }
    if let Some(index) = key.color {
        mesh.colors = colors(source, at, index, vertices, warnings)?;
    }
    match key.normal {
        Some(index) => {
            mesh.normals = stream(source, at, "NORMAL", index, count, Vec3::from_array)?;
            let repaired = repair_normals(&mut mesh);
            warnings.count(Repair::Normals, at, repaired);
            // Tangents without normals must be ignored (section 3.7.2.1).
            if let Some(index) = key.tangent {
                mesh.tangents = stream(source, at, "TANGENT", index, count, Vec4::from_array)?;
                let repaired = repair_tangents(&mut mesh);
                warnings.count(Repair::Tangents, at, repaired);
            }
        }
        // Lines and points without normals are unlit (section 3.9.7).
        None if !mesh.has_area() => {}
        None => {
            let dropped = make_flat(&mut mesh);
            warnings.count(Repair::Triangles, at, dropped);
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

/// Returns the index list, every index below `vertices`; `None`, with a warning, if it is empty.
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
    let packed = key.packed.and_then(|view| source.meshes.get(&view));
    let (mode, corners) = match (packed, key.indices) {
        // A compressed mesh contains triangles, even if the mode is a strip.
        (Some(mesh), index) => (Mode::Triangles, packed_corners(source, mesh, index, mode, at)?),
        (None, Some(index)) => (mode, integers(source, index, &format!("{at} indices"))?),
        (None, None) => {
            source.charge(vertices as u64 * 4)?;
            (mode, (0..vertices as u32).collect())
        }
    };
    if let Some(place) = corners.iter().position(|&c| c as usize >= vertices) {
        let reason = format!("index {place} names vertex {}, but there are {vertices}", corners[place]);
        return Err(source.malformed(at, reason));
    }
    // A strip or fan expands to up to three corners per vertex.
    source.charge(corners.len() as u64 * 12)?;
    warnings.count(Repair::Corners, at, left_over(mode, corners.len()));
    let list = list(mode, &corners);
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

/// Returns the indices of a compressed mesh. Their number must match the accessor, unless the accessor counts those of
/// a strip.
fn packed_corners(
    source: &Source<'_>,
    mesh: &PackedMesh,
    index: Option<usize>,
    mode: Mode,
    at: &str,
) -> Result<Vec<u32>, SceneError> {
    if let Some(index) = index {
        let accessors = &source.root.accessors;
        let accessor =
            accessors.get(index).ok_or_else(|| source.malformed(at, beyond("accessor", index, accessors)))?;
        let (stated, found) = (accessor.count.0, mesh.indices.len());
        if mode == Mode::Triangles && stated != found as u64 {
            let reason = format!("accessor {index} states {stated} indices, but the compressed mesh has {found}");
            return Err(source.malformed(at, reason));
        }
    }
    source.charge(mesh.indices.len() as u64 * 4)?;
    Ok(mesh.indices.clone())
}

/// Reads RGB or RGBA vertex colors. Channels that are not finite become 0.
fn colors(
    source: &Source<'_>,
    at: &str,
    values: Values,
    vertices: usize,
    warnings: &mut Warnings,
) -> Result<Vec<Vec4>, SceneError> {
    let count = Some(vertices);
    let mut colors = if width(source, values.accessor) == Some(3) {
        let opaque = |rgb| Vec3::from_array(rgb).extend(1.0);
        stream(source, at, "COLOR_0", values, count, opaque)?
    } else {
        stream(source, at, "COLOR_0", values, count, Vec4::from_array)?
    };
    let bad = colors.iter_mut().filter(|color| !color.is_finite());
    let repaired = bad.map(|color| *color = Vec4::select(color.is_finite_mask(), *color, Vec4::ZERO)).count();
    warnings.count(Repair::Colors, at, repaired);
    Ok(colors)
}
