//! Draws one texel with a shader, to test behavior that the specification leaves open or that drivers get wrong.

use crate::device::gpu::Gpu;
use std::num::NonZeroU32;
use wgpu::{
    Color, CommandEncoderDescriptor, Extent3d, FragmentState, LoadOp, MultisampleState, Operations,
    PipelineCompilationOptions, PrimitiveState, RenderPassColorAttachment, RenderPassDescriptor,
    RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource, StoreOp, Texture, TextureDescriptor,
    TextureDimension, TextureFormat, TextureUsages, VertexState,
};

const VERTEX: &str = "
    @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
        return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
    }
";

/// Draws `fragment`, a WGSL entry point `fs_main`, into a texture of one texel and `layers` layers (1 to 32), cleared
/// to black. Several layers are drawn at once with multiview.
///
/// Errors are not checked here: call it within [`Gpu::guard`].
pub(crate) fn draw_texel(gpu: &Gpu, fragment: &str, target: TextureFormat, layers: u32) -> Texture {
    let Gpu { device, queue, .. } = gpu;
    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: Some("probe"),
        source: ShaderSource::Wgsl([VERTEX, fragment].concat().into()),
    });
    let multiview_mask = if layers > 1 { NonZeroU32::new(u32::MAX >> (u32::BITS - layers)) } else { None };
    let compilation_options = PipelineCompilationOptions::default();
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some("probe"),
        layout: None,
        vertex: VertexState {
            module: &module,
            entry_point: Some("vs_main"),
            compilation_options: compilation_options.clone(),
            buffers: &[],
        },
        primitive: PrimitiveState::default(),
        depth_stencil: None,
        multisample: MultisampleState::default(),
        fragment: Some(FragmentState {
            module: &module,
            entry_point: Some("fs_main"),
            compilation_options,
            targets: &[Some(target.into())],
        }),
        multiview_mask,
        cache: None,
    });
    let texture = device.create_texture(&TextureDescriptor {
        label: Some("probe"),
        size: Extent3d { width: 1, height: 1, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: target,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor { label: Some("probe"), ..Default::default() });
    let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor { label: Some("probe") });
    let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some("probe"),
        color_attachments: &[Some(RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store },
        })],
        multiview_mask,
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.draw(0..3, 0..1);
    drop(pass);
    queue.submit([encoder.finish()]);
    texture
}
