//! Copies of imports. An inspection runs passes a second time, which must not change the caller's textures and buffers.

use crate::device::format::both_forms;
use crate::device::gpu::Gpu;
use crate::resources::imports::Imports;
use framegraph::{Desc, Graph, Join, Kind, Plan, ResourceId};
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoderDescriptor, Texture, TextureDescriptor, TextureUsages,
};

/// Returns the imports for an inspected plan: the original ones, but a fresh copy of each that the inspected plan
/// writes.
///
/// # Errors
/// Returns the first resource that cannot be copied.
pub(super) fn import_copies(
    gpu: &Gpu,
    studied: &Graph,
    inspected: &Plan,
    imports: &Imports,
) -> Result<Imports, ResourceId> {
    let graph = inspected.graph();
    let mut own = Imports::new();
    let written = |resource: ResourceId| {
        let kept = inspected.running().filter(|m| m.join != Join::Inlined);
        let mut accesses = kept.flat_map(|m| graph.accesses_of(m.pass));
        accesses.any(|a| a.resource == resource && a.mode.writes())
    };
    for resource in graph.resource_ids() {
        let row = &graph.resources()[resource.index()];
        if !matches!(row.kind, Kind::Imported { .. }) {
            continue;
        }
        // Missing or mismatched imports are reported when the plan is executed.
        match row.desc {
            Desc::Texture(_) => {
                if let Some((texture, _)) = imports.texture_of(studied, resource) {
                    let copied = if written(resource) {
                        copy_of_texture(gpu, texture).ok_or(resource)?
                    } else {
                        texture.clone()
                    };
                    own.lend_at(resource, copied);
                }
            }
            Desc::Buffer(_) => {
                if let Some(buffer) = imports.buffer_of(studied, resource) {
                    let copied =
                        if written(resource) { copy_of_buffer(gpu, buffer).ok_or(resource)? } else { buffer.clone() };
                    own.buffer_at(resource, &copied);
                }
            }
        }
    }
    Ok(own)
}

/// Returns a texture of equal shape and contents, or `None` if the original cannot be copied.
fn copy_of_texture(gpu: &Gpu, texture: &Texture) -> Option<Texture> {
    if !texture.usage().contains(TextureUsages::COPY_SRC) {
        return None;
    }
    let (size, format, dimension) = (texture.size(), texture.format(), texture.dimension());
    let formats = both_forms(format);
    let made = gpu.guard("a copy of an import", || {
        let copy = gpu.device.create_texture(&TextureDescriptor {
            label: Some("copy of an import"),
            size,
            mip_level_count: texture.mip_level_count(),
            sample_count: texture.sample_count(),
            dimension,
            format,
            usage: texture.usage() | TextureUsages::COPY_DST,
            view_formats: if gpu.has_view_formats() { &formats } else { &[] },
        });
        let mut encoder =
            gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("copy of an import") });
        for mip in 0..texture.mip_level_count() {
            let level = |of| wgpu::TexelCopyTextureInfo {
                texture: of,
                mip_level: mip,
                origin: wgpu::Origin3d::ZERO,
                aspect: wgpu::TextureAspect::All,
            };
            let extent = size.mip_level_size(mip, dimension).physical_size(format);
            encoder.copy_texture_to_texture(level(texture), level(&copy), extent);
        }
        gpu.queue.submit([encoder.finish()]);
        copy
    });
    made.ok()
}

fn copy_of_buffer(gpu: &Gpu, buffer: &Buffer) -> Option<Buffer> {
    if !buffer.usage().contains(BufferUsages::COPY_SRC) {
        return None;
    }
    let made = gpu.guard("a copy of an import", || {
        let copy = gpu.device.create_buffer(&BufferDescriptor {
            label: Some("copy of an import"),
            size: buffer.size(),
            usage: (buffer.usage() - BufferUsages::MAP_READ - BufferUsages::MAP_WRITE) | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder =
            gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("copy of an import") });
        let bytes = buffer.size() / wgpu::COPY_BUFFER_ALIGNMENT * wgpu::COPY_BUFFER_ALIGNMENT;
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, bytes);
        gpu.queue.submit([encoder.finish()]);
        copy
    });
    made.ok()
}
