//! The passes written without a graph. Everything is created in advance; a frame only encodes and submits.

use crate::shared::{Case, FACTOR, FIRST, NEXT, TEXELS};
use framegraph_wgpu::{Gpu, Shader};
use std::error::Error;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, Buffer, BufferDescriptor, BufferUsages, Color,
    ColorTargetState, CommandEncoderDescriptor, Extent3d, FragmentState, LoadOp, Operations, RenderPassColorAttachment,
    RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource, StoreOp,
    TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView, VertexState,
};

/// Two textures that are drawn alternately, with pipelines and bind groups.
pub struct ByHand {
    gpu: Gpu,
    case: Case,
    pictures: [TextureView; 2],
    first: RenderPipeline,
    next: RenderPipeline,
    /// Indexed by the texture that is read, then by pass, since each pass has its own constants.
    groups: Vec<BindGroup>,
    constants: Buffer,
    /// Constants of a frame, as they are uploaded.
    bytes: Vec<u8>,
}

impl ByHand {
    /// Creates all objects.
    pub fn new(gpu: &Gpu, case: Case) -> Self {
        let device = &gpu.device;
        let texture = || {
            let texture = device.create_texture(&TextureDescriptor {
                label: None,
                size: Extent3d { width: TEXELS, height: TEXELS, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format: TextureFormat::Rgba8Unorm,
                usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let pictures = [texture(), texture()];
        let [first, next] = [FIRST, NEXT].map(|shader| pipeline(gpu, &shader));
        let alignment = u64::from(device.limits().min_uniform_buffer_offset_alignment);
        let size = alignment * case.passes as u64;
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let constants = device.create_buffer(&BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
        let layout = next.get_bind_group_layout(0);
        let group = |pass: usize| {
            let buffer = wgpu::BufferBinding {
                buffer: &constants,
                offset: alignment * pass as u64,
                size: std::num::NonZeroU64::new(16),
            };
            let resources = [BindingResource::TextureView(&pictures[(pass + 1) % 2]), BindingResource::Buffer(buffer)];
            let entries: Vec<_> =
                (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
            device.create_bind_group(&BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
        };
        let groups = (0..case.passes).map(group).collect();
        let mut bytes = vec![0; size as usize];
        for place in bytes.chunks_mut(alignment as usize) {
            place[..16].copy_from_slice(bytemuck::cast_slice(&FACTOR));
        }
        Self { gpu: gpu.clone(), case, pictures, first, next, groups, constants, bytes }
    }

    /// Encodes and submits one frame.
    pub fn frame(&mut self) -> Result<(), Box<dyn Error>> {
        let Self { gpu, case, pictures, first, next, groups, constants, bytes } = self;
        gpu.device.poll(wgpu::PollType::Poll)?;
        let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("frame") });
        for (number, group) in groups.iter().enumerate() {
            let ops = Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store };
            let view = &pictures[number % 2];
            let target = RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("draw"),
                color_attachments: &[Some(target)],
                ..Default::default()
            });
            if number == 0 {
                pass.set_pipeline(first);
            } else {
                pass.set_pipeline(next);
                pass.set_bind_group(0, group, &[]);
            }
            (0..case.draws).for_each(|_| pass.draw(0..3, 0..1));
        }
        gpu.queue.write_buffer(constants, 0, bytes);
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }
}

fn pipeline(gpu: &Gpu, shader: &Shader<'_>) -> RenderPipeline {
    let source = ShaderSource::Wgsl(shader.text().into());
    let module = gpu.device.create_shader_module(ShaderModuleDescriptor { label: None, source });
    gpu.device.create_render_pipeline(&RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(ColorTargetState::from(TextureFormat::Rgba8Unorm))],
        }),
        multiview_mask: None,
        cache: None,
    })
}
