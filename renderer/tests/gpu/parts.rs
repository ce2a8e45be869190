//! Parts of resources: byte ranges of buffers, and sRGB views of linear textures.

use crate::bench::{Bench, TestResult, on_every_device};
use framegraph::{Buffer, ClearValue, Extent, Format, Intent, PassBuilder, TextureDesc};
use framegraph_wgpu::{Compute, Cx, Readback, RecordError, Shader, Subresource, read_buffer};

const FILL: Shader<'static> = Shader::new(
    "fill",
    "@group(0) @binding(0) var<storage, read_write> values: array<u32>;
     @compute @workgroup_size(16) fn fill(@builtin(global_invocation_id) id: vec3u) {
       if id.x < arrayLength(&values) { values[id.x] += 10u + arrayLength(&values); }
     }",
);

fn fill(buffer: Buffer, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let pipeline = cx.compute_pipeline(&Compute { entry: "fill", ..Compute::new(FILL) })?;
    let bound = cx.buffer_of(buffer)?;
    let group = cx.bind_group(pipeline.group(0), &[(0, bound.into())]);
    let pass = cx.compute_pass()?;
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(1, 1, 1);
    Ok(())
}

#[test]
fn a_pass_binds_the_declared_bytes() -> TestResult {
    on_every_device("a_pass_binds_the_declared_bytes", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 1, 1);
        let values = bench.run(|frame| {
            let values = frame.graph_mut().buffer("values", 1024);
            let all = |p: &mut PassBuilder<'_>| p.storage_write_buffer(values, Intent::Clear(ClearValue::Zero));
            let values = frame.add_fn("all", all, |v, (), cx| fill(*v, cx))?;
            // A separate access clears and fills sixteen bytes in the middle.
            let some = |p: &mut PassBuilder<'_>| {
                p.storage_write_buffer(values.bytes(256, 16), Intent::Clear(ClearValue::Zero))
            };
            let values = frame.add_fn("some", some, |v, (), cx| fill(*v, cx))?;
            frame.graph_mut().readback_buffer(values)?;
            Ok(values)
        })?;
        if drawn {
            let bytes = read_buffer(gpu, bench.executor.buffer(&bench.plan, values).ok_or("no buffer")?, 1024)?;
            let words: Vec<u32> = bytemuck::cast_slice(&bytes).to_vec();
            // One workgroup can write sixteen words: the first pass binds 256, the second 4.
            let expected = |at: usize| match at {
                0..16 => 10 + 256,
                64..68 => 10 + 4,
                _ => 0,
            };
            assert_eq!(words, (0..256).map(expected).collect::<Vec<u32>>());
        }
        Ok(())
    })
}

#[test]
fn an_srgb_view_changes_the_stored_values() -> TestResult {
    on_every_device("an_srgb_view_changes_the_stored_values", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 1, 1);
        let gray = Intent::Clear(ClearValue::Color([0.5, 0.5, 0.5, 1.0]));
        let mut codes = |own: Format, view: Format| -> Result<u8, Box<dyn std::error::Error>> {
            let texture = bench.run(|frame| {
                let texture = frame.graph_mut().texture("t", TextureDesc::new(Extent::absolute(4, 4), own));
                let draw = |p: &mut PassBuilder<'_>| p.color(texture.viewed_as(view), gray);
                let texture = frame.add_fn("clear", draw, |_, (), _| Ok(()))?;
                frame.graph_mut().readback(texture)?;
                Ok(texture)
            })?;
            let physical = bench.executor.texture(&bench.plan, texture).ok_or("no texture")?;
            Ok(if drawn { Readback::start(gpu, physical, Subresource::FIRST)?.wait(gpu)?.bytes[0] } else { 0 })
        };
        let (srgb, linear) = (Format::Rgba8UnormSrgb, Format::Rgba8Unorm);
        let found = [codes(linear, linear)?, codes(linear, srgb)?, codes(srgb, linear)?, codes(srgb, srgb)?];
        // 0.5 is stored as 188 with sRGB encoding and as 128 without.
        assert!(!drawn || found == [128, 188, 128, 188], "{found:?}");
        Ok(())
    })
}
