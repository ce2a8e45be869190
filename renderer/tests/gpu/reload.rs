//! Reloads of shaders that would fail in the next frame: the old source stays in use, and the error names both.

use crate::bench::{Bench, GREEN, RED, TestResult, on_adapter, on_every_device};
use framegraph::{DeclareError, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::wgpu::{self, BufferUsages, VertexStepMode};
use framegraph_wgpu::{Compute, Frame, Gpu, Raster, SamplerDesc, Shader, ShaderError, VertexBuffer};

const SOURCE: Shader<'static> = Shader::new(
    "reloaded",
    "@group(0) @binding(0) var<uniform> tint: vec4f;
     @group(0) @binding(1) var image: texture_2d<f32>;
     @group(0) @binding(2) var linear: sampler;
     @group(0) @binding(3) var other: texture_2d<f32>;
     override SHARE: f32 = 0.0;
     @vertex fn vs_main(@location(0) at: vec2f) -> @builtin(position) vec4f { return vec4f(at, 0.0, 1.0); }
     @fragment fn fs_main() -> @location(0) vec4f {
         let all = textureLoad(image, vec2u(0), 0) + textureSampleLevel(other, linear, vec2f(0.5), 0.0);
         return tint + SHARE * all;
     }
     @compute @workgroup_size(1) fn unused() { _ = textureDimensions(image); }",
);

fn declare(frame: &mut Frame, gpu: &Gpu) -> Result<Texture, DeclareError> {
    let desc = |format| TextureDesc::new(Extent::FRAME, format);
    let sources = [("image", Format::Rgba32Float), ("other", Format::Rgba8Unorm)].map(|(name, format)| {
        let texture = frame.graph_mut().texture(name, desc(format));
        frame.add_fn(name, |p| p.color(texture, Intent::Clear(framegraph::ClearValue::BLACK)), |_, (), _| Ok(()))
    });
    let [image, other] = sources;
    let (image, other) = (image?, other?);
    let target = frame.graph_mut().texture("color", desc(Format::Rgba8Unorm));
    let size = wgpu::BufferDescriptor { label: None, size: 24, usage: BufferUsages::VERTEX, mapped_at_creation: true };
    let corners = gpu.device.create_buffer(&size);
    if let Ok(mut bytes) = corners.get_mapped_range_mut(..) {
        bytes.copy_from_slice(bytemuck::cast_slice(&[-1.0_f32, -1.0, 3.0, -1.0, -1.0, 3.0]));
    }
    corners.unmap();
    let accesses = |p: &mut framegraph::PassBuilder<'_>| {
        Ok((p.sampled(image)?, p.sampled(other)?, p.color(target, Intent::Overwrite)?))
    };
    let (.., target) = frame.add_fn("draw", accesses, move |(image, other, _), (), cx| {
        let attributes = wgpu::vertex_attr_array![0 => Float32x2];
        let buffers = [VertexBuffer { stride_bytes: 8, step: VertexStepMode::Vertex, attributes: &attributes }];
        let pipeline = cx.raster_pipeline(&Raster { buffers: &buffers, ..Raster::new(SOURCE) })?;
        let bindings = [
            (0, cx.uniform(&RED)),
            (1, cx.view(*image)?.into()),
            (2, cx.sampler(SamplerDesc::LINEAR).into()),
            (3, cx.view(*other)?.into()),
        ];
        let group = cx.bind_group(pipeline.group(0), &bindings);
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_vertex_buffer(0, corners.slice(..));
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    })?;
    frame.graph_mut().readback(target)?;
    Ok(target)
}

/// Draws a frame and checks its color.
fn shows(bench: &mut Bench, drawn: bool, color: [f32; 4]) -> TestResult {
    let gpu = bench.gpu.clone();
    let target = bench.run(|frame| declare(frame, &gpu))?;
    assert!(!drawn || bench.pixels(target)?.rgba().iter().all(|texel| *texel == color));
    Ok(())
}

/// Replaces a part of the source and returns the error of the reload.
fn reported(bench: &mut Bench, from: &str, to: &str) -> Option<ShaderError> {
    assert!(SOURCE.text().contains(from), "{from}");
    bench.executor.reload_shader(&SOURCE, &SOURCE.text().replace(from, to)).err()
}

#[test]
fn a_reload_that_would_fail_keeps_the_old_source() -> TestResult {
    on_every_device("a_reload_that_would_fail_keeps_the_old_source", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        shows(&mut bench, drawn, RED)?;
        let cases = [
            ("var<uniform> tint: vec4f", "var<uniform> tint: mat4x4f", ["vec4f` (16 bytes)", "mat4x4f` (64 bytes)"]),
            ("@binding(1)", "@binding(4)", ["image: texture_2d<f32>`", "nothing"]),
            ("var linear: sampler", "var linear: sampler_comparison", ["`var linear: sampler`", "sampler_comparison`"]),
            ("textureLoad(image, vec2u(0), 0)", "vec4f(0.0)", ["image: texture_2d<f32>`", "nothing"]),
            ("vs_main", "vs_other", ["`vs_main`", "`vs_other`"]),
            ("fn unused", "fn renamed", ["`unused`", "`renamed`"]),
            ("at: vec2f)", "at: vec2f, @location(1) z: f32)", ["`@location(0) vec2<f32>`", "@location(1) f32`"]),
            ("= textureDimensions(image)", "= textureDimensions(other)", ["image: texture_2d<f32>`", "nothing"]),
        ];
        for (from, to, expected) in cases {
            // The new source must be valid, so that only its interface is wrong.
            let text = match to {
                "var<uniform> tint: mat4x4f" => SOURCE.text().replace("return tint", "return tint[0]"),
                "var linear: sampler_comparison" => {
                    SOURCE.text().replace(
                        "textureSampleLevel(other, linear, vec2f(0.5), 0.0)",
                        "textureSampleCompareLevel(shadow, linear, vec2f(0.5), 0.5)",
                    ) + "@group(0) @binding(5) var shadow: texture_depth_2d;"
                }
                _ => SOURCE.text().to_owned(),
            };
            let report = bench.executor.reload_shader(&SOURCE, &text.replace(from, to));
            let error = report.err().ok_or_else(|| format!("{to}: was reloaded"))?;
            let (place, message) = (matches!(error, ShaderError::Reload(_)), error.to_string());
            assert!(place && message.contains("`reloaded`"), "{to}: {message}");
            assert!(expected.iter().all(|part| message.contains(part)), "{to}: {message}");
            shows(&mut bench, drawn, RED)?;
        }
        let error = reported(&mut bench, "SHARE: f32 = 0.0", "SHARE: f32");
        assert!(matches!(&error, Some(ShaderError::Reload(change)) if change.place == "constant `SHARE`"), "{error:?}");
        shows(&mut bench, drawn, RED)?;
        assert_eq!(reported(&mut bench, "return tint", "return tint.grba"), None);
        shows(&mut bench, drawn, GREEN)?;
        // Later sources are compared with the recorder's, not with the last one.
        assert_eq!(bench.executor.reload_shader(&SOURCE, SOURCE.text())?, 1);
        shows(&mut bench, drawn, RED)
    })
}

/// Without the feature for it, a texture with 32 bits per channel cannot be filtered. Only the bound textures show this.
#[test]
fn bound_textures_must_fit_the_new_source() -> TestResult {
    on_adapter("bound_textures_must_fit_the_new_source", |_| {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let mut bench = Bench::new(&Gpu::wrap(&adapter, &device, &queue), 4, 4);
        shows(&mut bench, true, RED)?;
        let (load, sample) = ("textureLoad(image, vec2u(0), 0)", "textureSampleLevel(image, linear, vec2f(0.5), 0.0)");
        let error = reported(&mut bench, load, sample).ok_or("was reloaded")?;
        assert!(matches!(&error, ShaderError::Reload(change) if change.place == "bind group 0"), "{error}");
        shows(&mut bench, true, RED)
    })
}

/// Without pipelines, a source is compared with the original.
#[test]
fn an_unused_shader_is_checked_too() -> TestResult {
    let gpu = Gpu::noop()?;
    let mut bench = Bench::new(&gpu, 4, 4);
    let shader = Compute::new(SOURCE).shader;
    for (from, to) in
        [("@binding(0)", "@binding(9)"), ("at: vec2f)", "at: vec3i)"), ("-> @location(0)", "-> @location(1)")]
    {
        let text = shader.text().replace(from, to).replace("vec4f(at, 0.0, 1.0)", "vec4f(0.0)");
        let report = bench.executor.reload_shader(&shader, &text);
        assert!(matches!(report, Err(ShaderError::Reload(_))), "{to}: {report:?}");
    }
    assert_eq!(bench.executor.reload_shader(&shader, shader.text()), Ok(0));
    Ok(())
}
