//! Vertex, index and material buffers.

use std::path::Path;

use bytemuck::{NoUninit, cast_slice};
use framegraph_shaders::layout::{MaterialUniforms, VertexAttributes, VertexPosition};
use wgpu::{Buffer, BufferDescriptor, BufferUsages};

use super::error::UploadError;
use super::material::material_uniforms;
use super::mesh_range::{MeshRanges, indices_of};
use super::pack::{colors_are_cut, vertex_attributes, vertex_positions};
use crate::gpu_scene::indirect::{LEAST_BATCHES, binds_materials};
use framegraph_scene::error::{Quantity, SceneError};
use framegraph_scene::progress::{Progress, ProgressFn, Stage, report};
use framegraph_scene::{MeshId, Scene};
use framegraph_wgpu::Gpu;

/// Vertex and index buffers that draws share.
pub(super) struct Vertices {
    pub positions: Buffer,
    pub attributes: Buffer,
    pub indices: Buffer,
    /// Size of the 32-bit indices in bytes; the 16-bit indices follow.
    pub short_indices_at: u64,
}

/// Creates buffers with all meshes, one after another.
pub(super) fn vertices(
    gpu: &Gpu,
    scene: &Scene,
    warnings: &mut Vec<String>,
    progress: &mut ProgressFn<'_>,
) -> Result<(Vertices, MeshRanges), UploadError> {
    let count = |of: fn(&framegraph_scene::Mesh) -> usize| scene.meshes.iter().map(of).sum::<usize>();
    let (vertex_count, index_count) = (count(|m| m.vertex_count()), count(|m| m.all_indices().map(<[u32]>::len).sum()));
    // Base vertices are signed 32-bit numbers, first indices unsigned ones.
    for (what, value) in [(Quantity::Vertices, vertex_count), (Quantity::Indices, index_count)] {
        limit(&scene.name, what, value as u64, i32::MAX as u64)?;
    }
    let mut positions: Vec<VertexPosition> = Vec::with_capacity(vertex_count);
    let mut attributes: Vec<VertexAttributes> = Vec::with_capacity(vertex_count);
    let ranges = MeshRanges::new(&scene.meshes);
    for (index, mesh) in scene.meshes.iter().enumerate() {
        positions.extend(vertex_positions(mesh));
        attributes.extend(vertex_attributes(mesh));
        if colors_are_cut(mesh) {
            warnings
                .push(format!("{}: vertex colors of mesh {:?} outside 0…65504 were clamped", scene.name, mesh.name));
        }
        let step = Progress { stage: Stage::Vertices, done: index + 1, total: scene.meshes.len(), item: &mesh.name };
        report(progress, Path::new(&scene.name), step)?;
    }
    let (mut long, mut short): (Vec<u32>, Vec<u16>) = (Vec::new(), Vec::new());
    for (mesh, _, indices) in indices_of(&scene.meshes) {
        if ranges.of(MeshId::new(mesh), 0).short {
            short.extend(indices.iter().map(|index| *index as u16));
        } else {
            long.extend(indices);
        }
    }
    let mut bytes: Vec<u8> = cast_slice(&long).to_vec();
    bytes.extend_from_slice(cast_slice(&short));
    // Buffer writes are multiples of four bytes.
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let vertices = Vertices {
        positions: filled(gpu, scene, "positions", BufferUsages::VERTEX, &positions)?,
        attributes: filled(gpu, scene, "attributes", BufferUsages::VERTEX, &attributes)?,
        indices: filled(gpu, scene, "indices", BufferUsages::INDEX, &bytes)?,
        short_indices_at: 4 * long.len() as u64,
    };
    Ok((vertices, ranges))
}

/// Creates a packed array of all material uniforms, if indirect draws may use it.
pub(super) fn material_table(gpu: &Gpu, scene: &Scene) -> Result<Option<Buffer>, UploadError> {
    // Shorter draw lists are never indirect.
    if scene.instances.len() < LEAST_BATCHES || !binds_materials(&gpu.device.limits()) {
        return Ok(None);
    }
    let packed: Vec<MaterialUniforms> = scene.materials.iter().map(material_uniforms).collect();
    Ok(Some(filled(gpu, scene, "material table", BufferUsages::STORAGE, &packed)?))
}

/// Creates a buffer of all material uniforms, to be bound one by one, and returns their distance.
pub(super) fn materials(gpu: &Gpu, scene: &Scene) -> Result<(Buffer, u64), UploadError> {
    let alignment = u64::from(gpu.device.limits().min_uniform_buffer_offset_alignment);
    let stride = (size_of::<MaterialUniforms>() as u64).next_multiple_of(alignment);
    let mut bytes = vec![0_u8; scene.materials.len() * stride as usize];
    for (material, place) in scene.materials.iter().zip(bytes.chunks_exact_mut(stride as usize)) {
        let packed = material_uniforms(material);
        place[..size_of::<MaterialUniforms>()].copy_from_slice(bytemuck::bytes_of(&packed));
    }
    let buffer = filled(gpu, scene, "materials", BufferUsages::UNIFORM, &bytes)?;
    Ok((buffer, stride))
}

/// Creates a buffer of `values`. An empty slice gives one zero element, since empty buffers cannot be bound.
fn filled<T: NoUninit>(
    gpu: &Gpu,
    scene: &Scene,
    what: &'static str,
    usage: BufferUsages,
    values: &[T],
) -> Result<Buffer, UploadError> {
    let bytes: &[u8] = cast_slice(values);
    let size = (bytes.len().max(size_of::<T>()) as u64).next_multiple_of(4);
    let size_limit = gpu.device.limits().max_buffer_size;
    limit(&scene.name, Quantity::BufferBytes(what), size, size_limit)?;
    let label = format!("{} {what}", scene.name);
    let buffer = gpu.guard("a buffer of the scene", || {
        let buffer = gpu.device.create_buffer(&BufferDescriptor {
            label: Some(&label),
            size,
            usage: usage | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        if !bytes.is_empty() {
            gpu.queue.write_buffer(&buffer, 0, bytes);
        }
        buffer
    })?;
    Ok(buffer)
}

/// Fails if a value exceeds a limit.
pub(super) fn limit(file: &str, what: Quantity, value: u64, limit: u64) -> Result<(), SceneError> {
    if value <= limit { Ok(()) } else { Err(SceneError::TooLarge { file: file.into(), what, value, limit }) }
}
