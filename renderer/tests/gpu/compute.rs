//! Compute passes: buffers and storage textures, written, modified and cleared.

use crate::bench::{Bench, TestResult, on_every_device};
use framegraph::{AccessKind, Buffer, ClearValue, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::{Compute, Constants, Cx, Readback, RecordError, Shader, Subresource, ViewPart, read_buffer};

const COUNT: Shader<'static> = Shader::new(
    "count",
    "@group(0) @binding(0) var<storage, read_write> values: array<u32>;
     @compute @workgroup_size(16) fn square(@builtin(global_invocation_id) id: vec3u) {
       if id.x < arrayLength(&values) { values[id.x] = id.x * id.x; }
     }
     @compute @workgroup_size(16) fn increment(@builtin(global_invocation_id) id: vec3u) {
       if id.x < arrayLength(&values) { values[id.x] += 1u; }
     }",
);

fn dispatch(cx: &mut Cx<'_>, entry: &str, buffer: Buffer) -> Result<(), RecordError> {
    let pipeline = cx.compute_pipeline(&Compute { entry, ..Compute::new(COUNT) })?;
    let bound = cx.buffer_of(buffer)?;
    let group = cx.bind_group(pipeline.group(0), &[(0, bound.into())]);
    let pass = cx.compute_pass()?;
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(2, 1, 1);
    Ok(())
}

#[test]
fn a_buffer_is_written_then_modified() -> TestResult {
    on_every_device("a_buffer_is_written_then_modified", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 1, 1);
        let values = bench.run(|frame| {
            let values = frame.graph_mut().buffer("values", 20 * 4);
            let write = |b: Buffer, intent| {
                move |p: &mut framegraph::PassBuilder<'_>| p.write_buffer(b, AccessKind::StorageWrite, intent)
            };
            let values =
                frame.add_fn("square", write(values, Intent::Overwrite), |v, (), cx| dispatch(cx, "square", *v))?;
            let values =
                frame.add_fn("increment", write(values, Intent::Modify), |v, (), cx| dispatch(cx, "increment", *v))?;
            frame.graph_mut().readback_buffer(values)?;
            Ok(values)
        })?;
        if drawn {
            let physical = bench.executor.buffer(&bench.plan, values).ok_or("no buffer")?;
            let bytes = read_buffer(gpu, physical, 80)?;
            let read: Vec<u32> = bytemuck::cast_slice(&bytes).to_vec();
            assert_eq!(read, (0..20).map(|i| i * i + 1).collect::<Vec<u32>>());
        }
        Ok(())
    })
}

#[test]
fn a_cleared_buffer_is_zero_in_every_frame() -> TestResult {
    on_every_device("a_cleared_buffer_is_zero_in_every_frame", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 1, 1);
        for _ in 0..3 {
            let values = bench.run(|frame| {
                let values = frame.graph_mut().buffer("values", 20 * 4);
                let clear = Intent::Clear(ClearValue::Zero);
                let declare =
                    |p: &mut framegraph::PassBuilder<'_>| p.write_buffer(values, AccessKind::StorageWrite, clear);
                let values = frame.add_fn("increment", declare, |v, (), cx| dispatch(cx, "increment", *v))?;
                frame.graph_mut().readback_buffer(values)?;
                Ok(values)
            })?;
            if drawn {
                let bytes = read_buffer(gpu, bench.executor.buffer(&bench.plan, values).ok_or("no buffer")?, 80)?;
                assert!(bytes.chunks_exact(4).all(|v| v == [1, 0, 0, 0]), "{bytes:?}");
            }
        }
        assert_eq!(bench.executor.objects().buffers, 1);
        Ok(())
    })
}

#[test]
fn a_storage_texture_is_cleared_to_a_color_and_written_in_part() -> TestResult {
    const DOT: Shader<'static> = Shader::new(
        "dot",
        "@group(0) @binding(0) var image: texture_storage_2d<rgba8unorm, write>;
         @compute @workgroup_size(1) fn main() { textureStore(image, vec2u(1, 2), vec4f(0.0, 1.0, 0.0, 1.0)); }",
    );
    on_every_device("a_storage_texture_is_cleared_to_a_color_and_written_in_part", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        for value in [ClearValue::Color([1.0, 0.0, 0.0, 1.0]), ClearValue::Zero] {
            let image = bench.run(|frame| {
                let image = frame.graph_mut().texture("image", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
                let image = frame.add_fn(
                    "dot",
                    |p| p.storage_write(image, Intent::Clear(value)),
                    |image: &Texture, (), cx| {
                        let pipeline = cx.compute_pipeline(&Compute::new(DOT))?;
                        let view = cx.view_of(*image)?;
                        let group = cx.bind_group(pipeline.group(0), &[(0, view.into())]);
                        let pass = cx.compute_pass()?;
                        pass.set_pipeline(&pipeline);
                        pass.set_bind_group(0, &group, &[]);
                        pass.dispatch_workgroups(1, 1, 1);
                        Ok(())
                    },
                )?;
                frame.graph_mut().readback(image)?;
                Ok(image)
            })?;
            if drawn {
                let pixels = bench.pixels(image)?;
                let around = if value == ClearValue::Zero { [0; 4] } else { [255, 0, 0, 255] };
                assert_eq!(
                    (pixels.at(1, 2), pixels.at(0, 0)),
                    (Some([0, 255, 0, 255].as_slice()), Some(around.as_slice()))
                );
            }
        }
        Ok(())
    })
}

/// A pass that writes two mip levels selects the one to bind. The results are read back without waiting.
#[test]
fn levels_are_written_one_by_one_and_read_back_without_waiting() -> TestResult {
    const LEVEL: Shader<'static> = Shader::new(
        "level",
        "override RED: f32;
         @group(0) @binding(0) var image: texture_storage_2d<rgba8unorm, write>;
         @compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
           textureStore(image, id.xy, vec4f(RED, 0.0, 0.0, 1.0));
         }",
    );
    on_every_device("levels_are_written_one_by_one_and_read_back_without_waiting", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 4, 4);
        let image = bench.run(|frame| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm).mips(2);
            let image = frame.graph_mut().texture("image", desc);
            let record = |image: &Texture, (): &(), cx: &mut Cx<'_>| {
                for (mip, red) in [(0, 0.2), (1, 0.4)] {
                    let constants = Constants(&[("RED", red)]);
                    let pipeline = cx.compute_pipeline(&Compute { constants, ..Compute::new(LEVEL) })?;
                    let view = cx.view_of_part(*image, ViewPart::mip(mip))?;
                    let group = cx.bind_group(pipeline.group(0), &[(0, view.into())]);
                    let pass = cx.compute_pass()?;
                    pass.set_pipeline(&pipeline);
                    pass.set_bind_group(0, &group, &[]);
                    pass.dispatch_workgroups(4 >> mip, 4 >> mip, 1);
                }
                Ok(())
            };
            let image = frame.add_fn("levels", |p| p.storage_write(image, Intent::Overwrite), record)?;
            frame.graph_mut().readback(image)?;
            Ok(image)
        })?;
        let texture = bench.executor.texture(&bench.plan, image).ok_or("no texture")?;
        for (mip, red) in [(0, 51), (1, 102)] {
            let mut copy = Readback::start(gpu, texture, Subresource { mip, ..Subresource::FIRST })?;
            let pixels = loop {
                match copy.try_take(gpu)? {
                    Ok(pixels) => break pixels,
                    Err(later) => copy = later,
                }
                std::thread::yield_now();
            };
            assert!(!drawn || pixels.bytes.chunks_exact(4).all(|texel| texel == [red, 0, 0, 255]), "level {mip}");
        }
        Ok(())
    })
}
