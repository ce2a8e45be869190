//! Reads textures of any format and buffers as codes. Uses a shader, since multisampled and 24-bit depth textures
//! cannot be copied to buffers. Works without an executor.

use super::code::{Coding, Numeric};
use framegraph::Aspect;
use framegraph_wgpu::{Gpu, ReadbackError, read_buffer};
use std::cell::RefCell;
use std::collections::HashMap;
use wgpu::{
    BindGroupDescriptor, BindGroupEntry, BindingResource, BufferBinding, BufferUsages, ComputePipeline,
    TextureViewDescriptor, TextureViewDimension,
};

/// A texture part or buffer range to read.
pub enum Item<'a> {
    /// One level of one layer of one plane.
    Part { texture: &'a wgpu::Texture, plane: Aspect, coding: Coding, mip: u32, layer: u32 },
    /// A range of a buffer, in bytes.
    Buffer { buffer: &'a wgpu::Buffer, first: u64, bytes: u64 },
}

/// Result for a texel whose samples differ.
pub const SAMPLES_DIFFER: u32 = 0xDEAD_BEEF;

/// Reads parts of textures. See the [module documentation](self).
pub struct Probe {
    gpu: Gpu,
    pipelines: RefCell<HashMap<(Numeric, bool), ComputePipeline>>,
}

impl Probe {
    pub fn new(gpu: &Gpu) -> Self {
        Self { gpu: gpu.clone(), pipelines: RefCell::default() }
    }

    /// Returns the words of each item: four per texel, row by row.
    pub fn read(&self, items: &[Item<'_>]) -> Result<Vec<Vec<u32>>, ReadbackError> {
        let mut offsets = vec![0u64];
        for item in items {
            let bytes = match item {
                Item::Part { texture, mip, .. } => {
                    let size = texture.size();
                    u64::from((size.width >> mip).max(1)) * u64::from((size.height >> mip).max(1)) * 16
                }
                Item::Buffer { bytes, .. } => *bytes,
            };
            offsets.push(offsets[offsets.len() - 1] + bytes.next_multiple_of(256));
        }
        let total = offsets[offsets.len() - 1].max(256);
        let result = self.gpu.guard("a probe", || self.copy(items, &offsets, total))?;
        let bytes = read_buffer(&self.gpu, &result, total)?;
        let words: &[u32] = bytemuck::cast_slice(&bytes);
        let lengths = items.iter().map(|item| match item {
            Item::Part { texture, mip, .. } => {
                let size = texture.size();
                ((size.width >> mip).max(1) * (size.height >> mip).max(1) * 4) as usize
            }
            Item::Buffer { bytes, .. } => *bytes as usize / 4,
        });
        Ok(offsets.iter().zip(lengths).map(|(offset, n)| words[*offset as usize / 4..][..n].to_vec()).collect())
    }

    fn copy(&self, items: &[Item<'_>], offsets: &[u64], total: u64) -> wgpu::Buffer {
        let device = &self.gpu.device;
        let buffer = |usage, size| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("probe"),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let result = buffer(BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST, total);
        let params = buffer(BufferUsages::UNIFORM | BufferUsages::COPY_DST, 256 * items.len().max(1) as u64);
        let mut constants = vec![0u32; 64 * items.len()];
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("probe") });
        for (index, (item, offset)) in items.iter().zip(offsets).enumerate() {
            match item {
                Item::Buffer { buffer, first, bytes } => {
                    encoder.copy_buffer_to_buffer(buffer, *first, &result, *offset, *bytes);
                }
                Item::Part { texture, plane, coding, mip, layer } => {
                    let row = &mut constants[64 * index..];
                    row[0] = *offset as u32 / 4;
                    row[4..8].copy_from_slice(&coding.mask);
                    row[8..12].copy_from_slice(&coding.scale.map(f32::to_bits));
                    let samples = texture.sample_count() > 1;
                    let view = texture.create_view(&TextureViewDescriptor {
                        dimension: Some(if samples { TextureViewDimension::D2 } else { TextureViewDimension::D2Array }),
                        usage: Some(wgpu::TextureUsages::TEXTURE_BINDING),
                        aspect: match plane {
                            Aspect::All => wgpu::TextureAspect::All,
                            Aspect::Depth => wgpu::TextureAspect::DepthOnly,
                            Aspect::Stencil => wgpu::TextureAspect::StencilOnly,
                        },
                        base_mip_level: *mip,
                        mip_level_count: Some(1),
                        base_array_layer: *layer,
                        array_layer_count: Some(1),
                        ..Default::default()
                    });
                    let pipeline = self.pipeline(coding.numeric, samples);
                    let size = std::num::NonZeroU64::new(48);
                    let constant = BufferBinding { buffer: &params, offset: 256 * index as u64, size };
                    let group = device.create_bind_group(&BindGroupDescriptor {
                        label: None,
                        layout: &pipeline.get_bind_group_layout(0),
                        entries: &[
                            BindGroupEntry { binding: 0, resource: BindingResource::Buffer(constant) },
                            BindGroupEntry { binding: 1, resource: result.as_entire_binding() },
                            BindGroupEntry { binding: 2, resource: BindingResource::TextureView(&view) },
                        ],
                    });
                    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                    pass.set_pipeline(&pipeline);
                    pass.set_bind_group(0, &group, &[]);
                    pass.dispatch_workgroups(1, 1, 1);
                }
            }
        }
        self.gpu.queue.write_buffer(&params, 0, bytemuck::cast_slice(&constants));
        self.gpu.queue.submit([encoder.finish()]);
        result
    }

    fn pipeline(&self, numeric: Numeric, samples: bool) -> ComputePipeline {
        let mut pipelines = self.pipelines.borrow_mut();
        let made = pipelines.entry((numeric, samples)).or_insert_with(|| {
            let device = &self.gpu.device;
            let source = wgpu::ShaderSource::Wgsl(text(numeric, samples).into());
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("probe"), source });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("probe"),
                layout: None,
                module: &module,
                entry_point: Some("main"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        });
        made.clone()
    }
}

fn text(numeric: Numeric, samples: bool) -> String {
    let kind = match (numeric, samples) {
        (Numeric::Float, false) => "texture_2d_array<f32>",
        (Numeric::Float, true) => "texture_multisampled_2d<f32>",
        (Numeric::Uint | Numeric::Stencil, false) => "texture_2d_array<u32>",
        (Numeric::Uint | Numeric::Stencil, true) => "texture_multisampled_2d<u32>",
        (Numeric::Depth, false) => "texture_depth_2d_array",
        (Numeric::Depth, true) => "texture_depth_multisampled_2d",
    };
    let load = if samples { "textureLoad(image, xy, sample)" } else { "textureLoad(image, xy, 0, 0)" };
    let code = match numeric {
        Numeric::Float => format!("vec4u(round({load} * params.scale)) & params.mask"),
        Numeric::Depth => format!("vec4u(u32(round({load} * params.scale.x)), 0u, 0u, 0u)"),
        Numeric::Uint | Numeric::Stencil => format!("{load} & params.mask"),
    };
    let count = if samples { "4" } else { "1" };
    format!(
        "struct Params {{ first: u32, mask: vec4u, scale: vec4f }}
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> result: array<u32>;
@group(0) @binding(2) var image: {kind};
fn code(xy: vec2u, sample: i32) -> vec4u {{ return {code}; }}
@compute @workgroup_size(64) fn main(@builtin(local_invocation_index) local: u32) {{
  let size = textureDimensions(image);
  for (var i = local; i < size.x * size.y; i += 64u) {{
    let xy = vec2u(i % size.x, i / size.x);
    var first = code(xy, 0);
    for (var sample = 1; sample < {count}; sample++) {{
      if any(code(xy, sample) != first) {{ first = vec4u({SAMPLES_DIFFER}u); }}
    }}
    for (var channel = 0u; channel < 4u; channel++) {{ result[params.first + i * 4u + channel] = first[channel]; }}
  }}
}}
"
    )
}
