//! Deformed meshes on the device: vertices moved by joints and morph targets, and animated materials.

use super::error::UploadError;
use super::pack::{vertex_attributes, vertex_positions};
use super::scene::GpuScene;
use bytemuck::cast_slice;
use framegraph_scene::{MeshId, Scene};
use framegraph_shaders::layout::{VertexAttributes, VertexPosition};
use framegraph_wgpu::Gpu;
use wgpu::{BufferDescriptor, BufferUsages, CommandEncoderDescriptor};

impl GpuScene {
    /// Uploads the deformed vertices and animated materials of [`Scene::pose`], and keeps the previous positions for
    /// motion vectors. Call it once for each frame in which the scene was posed, and once after the last.
    ///
    /// # Errors
    /// Fails if the device fails.
    ///
    /// # Panics
    /// Panics if `scene` is larger than the uploaded scene.
    pub fn repose(&mut self, gpu: &Gpu, scene: &Scene) -> Result<(), UploadError> {
        for (material, _) in &scene.motion.rest.materials {
            self.write_material(gpu, *material, &scene.materials[material.index()])?;
        }
        let first_vertex = |mesh: MeshId| self.mesh(mesh, 0).base_vertex as u64;
        let bodies: Vec<(MeshId, u64)> =
            scene.motion.bodies.iter().map(|body| (body.mesh, first_vertex(body.mesh))).collect();
        if bodies.is_empty() {
            return Ok(());
        }
        let written = gpu.guard("the vertices of bodies", || {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("bodies") });
            let earlier = self.earlier.get_or_insert_with(|| {
                let usage = BufferUsages::VERTEX | BufferUsages::COPY_DST;
                let (label, size) = (Some("earlier positions"), self.positions.size());
                let buffer =
                    gpu.device.create_buffer(&BufferDescriptor { label, size, usage, mapped_at_creation: false });
                encoder.copy_buffer_to_buffer(&self.positions, 0, &buffer, 0, size);
                buffer
            });
            let [position_bytes, attribute_bytes] =
                [size_of::<VertexPosition>(), size_of::<VertexAttributes>()].map(|bytes| bytes as u64);
            for (mesh, first) in &bodies {
                let (at, count) = (first * position_bytes, scene.meshes[mesh.index()].positions.len() as u64);
                encoder.copy_buffer_to_buffer(&self.positions, at, earlier, at, count * position_bytes);
            }
            // Submitted before the writes below, so that the copies have the previous positions.
            gpu.queue.submit([encoder.finish()]);
            for (mesh, first) in &bodies {
                let own = &scene.meshes[mesh.index()];
                let positions: Vec<VertexPosition> = vertex_positions(own).collect();
                gpu.queue.write_buffer(&self.positions, first * position_bytes, cast_slice(&positions));
                let attributes: Vec<VertexAttributes> = vertex_attributes(own).collect();
                gpu.queue.write_buffer(&self.attributes, first * attribute_bytes, cast_slice(&attributes));
            }
        });
        Ok(written?)
    }

    /// Returns the vertex buffer of `layout::VertexPosition` of the previous frame.
    pub(crate) fn earlier_positions(&self) -> &wgpu::Buffer {
        self.earlier.as_ref().unwrap_or(&self.positions)
    }
}
