//! Mock imports: textures and buffers for everything that a plan imports.

use crate::device::error::DeviceError;
use crate::device::format::{both_forms, buffer_usages, texture_format, texture_usages};
use crate::device::gpu::Gpu;
use crate::resources::imports::Imports;
use framegraph::{Desc, Dimension, Placement, Plan, ResourceId};
use wgpu::{BufferUsages, Texture, TextureUsages};

/// Textures and buffers that [`imports`] created.
#[derive(Debug)]
pub struct MockImports {
    /// Bindings to pass to [`Executor::execute`](crate::Executor::execute).
    pub bound: Imports,
    /// Created textures, for reading them back.
    pub textures: Vec<(ResourceId, Texture)>,
}

/// Creates a zero-filled texture or buffer for each import that the plan uses. Usages are those that the plan needs,
/// plus copying, sampling and rendering where the format allows it.
///
/// # Errors
/// Fails if the device rejects one of the resources.
pub fn imports(gpu: &Gpu, plan: &Plan) -> Result<MockImports, DeviceError> {
    let mut made = MockImports { bound: Imports::new(), textures: Vec::new() };
    gpu.guard("a mock import", || {
        let graph = plan.graph();
        for (resource, row) in graph.resource_ids().zip(plan.resources()) {
            if row.placement != Placement::External || row.first.is_none() {
                continue;
            }
            match graph.resources()[resource.index()].desc {
                Desc::Texture(_) => {
                    let texture = texture(gpu, plan, resource);
                    made.bound.texture_at(resource, &texture);
                    made.textures.push((resource, texture));
                }
                Desc::Buffer(desc) => {
                    let usage = buffer_usages(row.usage) | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
                    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                        label: Some(graph.resource_name(resource)),
                        size: desc.bytes(plan.frame()).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT),
                        usage,
                        mapped_at_creation: false,
                    });
                    made.bound.buffer_at(resource, &buffer);
                }
            }
        }
    })?;
    Ok(made)
}

fn texture(gpu: &Gpu, plan: &Plan, resource: ResourceId) -> Texture {
    let Desc::Texture(desc) = plan.graph().resources()[resource.index()].desc else {
        unreachable!("only called for textures");
    };
    let [width, height] = desc.extent.texels(plan.frame());
    let allowed = gpu.format_features(desc.format).allowed_usages;
    // Render attachment usage lets a pass clear the texture to any value.
    let wanted = TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT;
    let offered = wanted & allowed;
    let formats = both_forms(texture_format(desc.format));
    let row = &plan.resources()[resource.index()];
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(plan.graph().resource_name(resource)),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: desc.layers.into() },
        mip_level_count: desc.mip_count(plan.frame()),
        sample_count: desc.samples.into(),
        dimension: match desc.dimension {
            Dimension::D2 => wgpu::TextureDimension::D2,
            Dimension::D3 => wgpu::TextureDimension::D3,
        },
        format: texture_format(desc.format),
        usage: texture_usages(row.usage) | offered,
        view_formats: if row.srgb_views && gpu.has_view_formats() { &formats } else { &[] },
    })
}
