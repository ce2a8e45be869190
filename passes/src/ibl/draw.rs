//! Full-screen draws outside of any frame: one pipeline, one target, one submission each.

use framegraph_shaders::{Features, Module};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroupDescriptor, BindGroupEntry, BindingResource, BufferUsages, ColorTargetState, ColorWrites, LoadOp,
    Operations, RenderPassColorAttachment, RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, StoreOp,
    TextureFormat, TextureView,
};

use super::IblError;
use framegraph_wgpu::{DeviceError, Gpu};

/// A resolved shader on the device.
pub(super) struct Program {
    module: wgpu::ShaderModule,
    name: &'static str,
}

impl Program {
    pub fn new(gpu: &Gpu, pass: &Module<'static>) -> Result<Self, IblError> {
        let shader = framegraph_shaders::resolve(pass, &Features::NONE, &[])?;
        let module = gpu.guard(pass.name(), || {
            gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(pass.name()),
                source: wgpu::ShaderSource::Wgsl(shader.wgsl.into()),
            })
        })?;
        Ok(Self { module, name: pass.name() })
    }

    /// A pipeline of `vs_main` with `fragment` into one target; its bind group layout is the shader's.
    pub fn pipeline(
        &self,
        gpu: &Gpu,
        fragment: &str,
        format: TextureFormat,
        constants: &[(&str, f64)],
    ) -> Result<RenderPipeline, DeviceError> {
        let options = || wgpu::PipelineCompilationOptions { constants, ..Default::default() };
        gpu.guard(self.name, || {
            gpu.device.create_render_pipeline(&RenderPipelineDescriptor {
                label: Some(fragment),
                layout: None,
                vertex: wgpu::VertexState {
                    module: &self.module,
                    entry_point: Some("vs_main"),
                    compilation_options: options(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &self.module,
                    entry_point: Some(fragment),
                    compilation_options: options(),
                    targets: &[Some(ColorTargetState { format, blend: None, write_mask: ColorWrites::ALL })],
                }),
                multiview_mask: None,
                cache: None,
            })
        })
    }
}

/// A uniform buffer of these bytes.
pub(super) fn uniform(gpu: &Gpu, label: &str, contents: &[u8]) -> wgpu::Buffer {
    gpu.device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage: BufferUsages::UNIFORM })
}

/// Draws rows `from..to` of the target (all of it is cleared when they begin at 0) and submits.
pub(super) fn draw(
    gpu: &Gpu,
    pipeline: &RenderPipeline,
    target: &TextureView,
    width: u32,
    rows: std::ops::Range<u32>,
    bindings: &[(u32, BindingResource<'_>)],
) {
    let entries: Vec<BindGroupEntry<'_>> = bindings
        .iter()
        .map(|(binding, resource)| BindGroupEntry { binding: *binding, resource: resource.clone() })
        .collect();
    let group = (!entries.is_empty()).then(|| {
        gpu.device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    {
        let load = if rows.start == 0 { LoadOp::Clear(wgpu::Color::BLACK) } else { LoadOp::Load };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            color_attachments: &[Some(RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load, store: StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        if let Some(group) = &group {
            pass.set_bind_group(0, group, &[]);
        }
        pass.set_scissor_rect(0, rows.start, width, rows.end - rows.start);
        pass.draw(0..3, 0..1);
    }
    gpu.queue.submit([encoder.finish()]);
}
