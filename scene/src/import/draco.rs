//! Decoding of `KHR_draco_mesh_compression` (bitstreams up to version 2.2).
//!
//! The compressed meshes of all drawn primitives are decoded in parallel before geometry is built, each once. The
//! decoder is the crate `draco-core`; `Cargo.toml` states why.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

use draco_core::{DataType, DecodeLimits, DecoderBuffer, DracoError, ErrorKind, Mesh, MeshDecoder, PointIndex};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;

use super::limits::MAX_ELEMENTS;
use super::node::FlatNode;
use super::packed::{self, Kind, NAME, PackedAttribute, PackedMesh};
use super::source::Source;
use crate::codec::{CodecError, catch_panic};
use crate::error::SceneError;
use crate::memory::{Loan, OverBudget};
use crate::parallel::in_parallel;
use crate::progress::{Progress, ProgressFn, Stage, report};

/// A compressed mesh that is located but not decoded.
struct Compressed<'a> {
    view: usize,
    /// Place for messages: `mesh 0 primitive 1: KHR_draco_mesh_compression`.
    at: String,
    bytes: &'a [u8],
    /// Ids of the attributes that primitives use.
    ids: BTreeSet<u32>,
    /// Numbers of vertices and triangles according to the accessors.
    vertices: u64,
    triangles: u64,
}

/// Maximum bytes per vertex of attributes that no primitive uses.
const UNNAMED_BYTES: u64 = 64;
/// Bytes of the largest glTF attribute: four floats.
const ATTRIBUTE_BYTES: u64 = 16;
/// Working memory of the decoder per triangle. For 100,000 triangles with four attributes, 168 bytes per triangle were
/// measured, attributes included.
const TRIANGLE_BYTES: u64 = 256;

impl Compressed<'_> {
    /// Returns the maximum number of attribute bytes that the stream may decode to.
    fn attribute_bytes(&self) -> u64 {
        self.vertices.saturating_mul(self.ids.len() as u64 * ATTRIBUTE_BYTES + UNNAMED_BYTES)
    }

    /// Returns the temporary memory of decoding.
    fn working_bytes(&self) -> u64 {
        self.attribute_bytes().saturating_add(self.triangles.saturating_mul(TRIANGLE_BYTES))
    }

    /// Returns the memory of the decoded mesh.
    fn decoded_bytes(&self) -> u64 {
        let attributes = self.vertices.saturating_mul(self.ids.len() as u64 * ATTRIBUTE_BYTES);
        attributes.saturating_add(self.triangles.saturating_mul(12))
    }
}

/// Decodes the compressed meshes of all primitives below these nodes; the result is keyed by buffer view.
///
/// # Errors
///
/// Fails for an invalid extension object, for a stream that does not decode, and if memory is short. Fails if a stream
/// has other vertices or more triangles than the accessors state. Reports the first error in file order.
pub(super) fn decode(
    source: &Source<'_>,
    nodes: &[FlatNode],
    progress: &mut ProgressFn<'_>,
) -> Result<BTreeMap<usize, PackedMesh>, SceneError> {
    let compressed = find_all(source, nodes)?;
    for mesh in &compressed {
        source.keep_file(&mesh.at, mesh.decoded_bytes())?;
        source.memory.lend(mesh.working_bytes()).map(drop).map_err(|budget| source.over(&mesh.at, budget))?;
    }
    let mut meshes = Vec::new();
    meshes.resize_with(compressed.len(), || None);
    let (mut stopped, mut done) = (Ok(()), 0);
    let admit = |mesh: &Compressed<'_>| source.memory.lend(mesh.working_bytes());
    in_parallel(&compressed, admit, decode_one, |i, result| {
        done += 1;
        let (total, item) = (compressed.len(), &compressed[i].at);
        if stopped.is_ok() {
            stopped = report(progress, source.file, Progress { stage: Stage::Decompression, done, total, item });
        }
        let go_on = stopped.is_ok() && result.is_ok();
        meshes[i] = Some(result);
        if go_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    stopped?;
    // After an error, later meshes may be missing, but no earlier ones.
    let all = compressed.iter().zip(meshes).filter_map(|(mesh, result)| Some((mesh, result?)));
    all.map(|(mesh, result)| match result {
        Ok(decoded) => Ok((mesh.view, decoded)),
        Err(Failure::Memory(budget)) => Err(source.over(&mesh.at, budget)),
        Err(Failure::Stream(reason)) => Err(source.malformed(&mesh.at, reason)),
    })
    .collect()
}

/// Locates the compressed meshes of all primitives below these nodes, each once, in order of use.
fn find_all<'a>(source: &'a Source<'_>, nodes: &[FlatNode]) -> Result<Vec<Compressed<'a>>, SceneError> {
    let drawn: BTreeSet<usize> = nodes.iter().filter_map(|node| node.mesh).collect();
    let mut compressed: Vec<Compressed<'a>> = Vec::new();
    let mut places: BTreeMap<usize, usize> = BTreeMap::new();
    for index in drawn {
        // An out-of-range index is reported later, as an error of the node.
        let primitives = source.root.meshes.get(index).map_or(&[][..], |mesh| &mesh.primitives);
        for (number, primitive) in primitives.iter().enumerate() {
            let at = format!("mesh {index} primitive {number}: {NAME}");
            let Some(found) = find(source, primitive, at)? else {
                continue;
            };
            match places.get(&found.view) {
                Some(place) => compressed[*place].ids.extend(found.ids),
                None => {
                    places.insert(found.view, compressed.len());
                    compressed.push(found);
                }
            }
        }
    }
    Ok(compressed)
}

/// Reads and checks the extension object of a primitive, if it has one.
fn find<'a>(source: &'a Source<'_>, primitive: &Primitive, at: String) -> Result<Option<Compressed<'a>>, SceneError> {
    let Some(extension) = packed::of(primitive) else {
        return Ok(None);
    };
    let Some(view) = extension.view() else {
        return Err(source.malformed(&at, "it has no bufferView"));
    };
    let (bytes, _) = source.view(view, &at)?;
    let mut ids = BTreeSet::new();
    for semantic in primitive.attributes.keys() {
        let Checked::Valid(semantic) = semantic else { continue };
        match extension.id(&semantic.to_string()) {
            Some(Ok(id)) => drop(ids.insert(id)),
            Some(Err(())) => {
                return Err(source.malformed(&at, format!("its id of {} is not a whole number", semantic.to_string())));
            }
            None => {}
        }
    }
    let count = |index: usize| source.root.accessors.get(index).map(|accessor| accessor.count.0);
    // Missing positions or accessors are reported later, when the mesh is built.
    let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
    let Some(vertices) = position.and_then(|index| count(index.value())) else {
        return Ok(None);
    };
    let corners = match (primitive.indices, &primitive.mode) {
        (Some(index), Checked::Valid(Mode::Triangles)) => count(index.value()).unwrap_or(0),
        // The accessor counts strip indices, but the stream contains triangles.
        (Some(index), _) => count(index.value()).unwrap_or(0).saturating_mul(3),
        // The number of triangles is not stated. A closed mesh has two per vertex.
        (None, _) => vertices.saturating_mul(9),
    };
    if vertices > MAX_ELEMENTS || corners > MAX_ELEMENTS {
        let reason = format!("its accessors state {vertices} vertices and {corners} corners, over {MAX_ELEMENTS}");
        return Err(source.malformed(&at, reason));
    }
    Ok(Some(Compressed { view, at, bytes, ids, vertices, triangles: corners / 3 }))
}

/// Reason why a mesh was not decoded.
enum Failure {
    Memory(OverBudget),
    Stream(String),
}

fn decode_one(compressed: &Compressed<'_>, loan: Result<Loan<'_>, OverBudget>) -> Result<PackedMesh, Failure> {
    let _loan = loan.map_err(Failure::Memory)?;
    let limits = DecodeLimits::permissive()
        .with_max_points(compressed.vertices)
        .with_max_faces(compressed.triangles)
        .with_max_decoded_bytes(compressed.attribute_bytes());
    let mut mesh = Mesh::new();
    let mut buffer = DecoderBuffer::new(compressed.bytes).with_limits(limits);
    let decoded = catch_panic(|| {
        let decoded = MeshDecoder::new().decode(&mut buffer, &mut mesh);
        decoded.map_err(|error| CodecError::Other(reason(compressed, &error).into()))
    });
    decoded.map_err(|error| Failure::Stream(format!("does not decode: {error}")))?;
    unpack(compressed, &mesh).map_err(Failure::Stream)
}

/// Returns the decoder's message; for exceeded limits, one that refers to the accessors.
fn reason(compressed: &Compressed<'_>, error: &DracoError) -> String {
    match error.kind() {
        ErrorKind::LimitExceeded => format!(
            "it holds more than the {} triangles and {} vertices that the accessors of the primitive state",
            compressed.triangles, compressed.vertices
        ),
        _ => error.to_string(),
    }
}

/// Copies the attributes that primitives use, one value per vertex, and the indices.
fn unpack(compressed: &Compressed<'_>, mesh: &Mesh) -> Result<PackedMesh, String> {
    let vertices = mesh.num_points();
    if vertices as u64 != compressed.vertices {
        let stated = compressed.vertices;
        return Err(format!("its stream has {vertices} vertices, but the accessor of POSITION states {stated}"));
    }
    let indices: Vec<u32> = mesh.faces().iter().flatten().map(|corner| corner.0).collect();
    let mut attributes = BTreeMap::new();
    for &id in &compressed.ids {
        let Some(attribute) = mesh.attribute_by_unique_id(id) else {
            let ids = (0..mesh.num_attributes()).filter_map(|i| mesh.try_attribute(i).ok());
            let ids: Vec<String> = ids.map(|attribute| attribute.unique_id().to_string()).collect();
            return Err(format!("its stream has no attribute {id}; its attributes are {}", ids.join(", ")));
        };
        let kind = match attribute.data_type() {
            DataType::Int8 => Kind::I8,
            DataType::Uint8 => Kind::U8,
            DataType::Int16 => Kind::I16,
            DataType::Uint16 => Kind::U16,
            DataType::Int32 => Kind::I32,
            DataType::Uint32 => Kind::U32,
            DataType::Float32 => Kind::F32,
            other => return Err(format!("attribute {id} has components of type {other:?}, which glTF lacks")),
        };
        let width = usize::from(attribute.num_components());
        let (size, data) = (width * kind.size(), attribute.buffer().data());
        if width > 4 {
            return Err(format!("attribute {id} has {width} components; at most 4 are allowed"));
        }
        let mut bytes = Vec::with_capacity(vertices * size);
        for vertex in 0..vertices as u32 {
            let start = attribute.mapped_index(PointIndex(vertex)).0 as usize * size;
            let value = data.get(start..start.saturating_add(size));
            bytes.extend_from_slice(value.ok_or_else(|| format!("attribute {id} has no value for vertex {vertex}"))?);
        }
        attributes.insert(id, PackedAttribute { kind, width, bytes });
    }
    Ok(PackedMesh { indices, attributes })
}
