//! Debug modes turn off what they name, and poisoning reaches all undefined contents.

use crate::bench::{Bench, RED, SHOW, SHOW_DEPTH, TestResult, draw_of, fill_corner, fill_full, on_every_device};
use framegraph::file::{GraphFile, Registry};
use framegraph::{
    AccessKind, Buffer, ClearValue, Counts, Extent, Format, Intent, Options, Plan, Scratch, Texture, TextureDesc,
};
use framegraph_wgpu::debug::Mode;
use framegraph_wgpu::{
    Compute, Cx, Executor, ExecutorOptions, Gpu, ObjectCounts, Raster, RecordError, Shader, read_buffer,
};
use framegraph_wgpu::{Frame, mock};

/// A culled pass, two merged passes, an inlined pass, and a chain that shares textures.
const FRAME: &str = r#"(version: 1,
    resources: [
        Texture(name: "screen", format: Rgba8Unorm, kind: Import(entry: Undefined, exit: Keep)),
        Texture(name: "idle", format: Rgba8Unorm),
        Texture(name: "depth", format: Depth32Float),
        Texture(name: "a", format: Rgba16Float), Texture(name: "b", format: Rgba16Float),
        Texture(name: "c", format: Rgba16Float), Texture(name: "d", format: Rgba16Float),
        Texture(name: "graded", format: Rgba16Float),
    ],
    passes: [
        Raster(name: "idle", accesses: [Color(to: "idle", intent: Overwrite)]),
        Raster(name: "prepass", accesses: [Depth(to: "depth", intent: ClearDepth(0))]),
        Raster(name: "scene", flags: [TakesEpilogue], accesses: [
            DepthReadOnly(of: "depth"), Color(to: "a", intent: ClearColor(0, 0, 0, 1)),
        ]),
        Raster(name: "grade", flags: [Pointwise], accesses: [SamePixel(of: "a"), Color(to: "graded", intent: Overwrite)]),
        Raster(name: "b", accesses: [Sampled(of: "graded"), Color(to: "b", intent: Overwrite)]),
        Raster(name: "c", accesses: [Sampled(of: "b"), Color(to: "c", intent: Overwrite)]),
        Raster(name: "d", accesses: [Sampled(of: "c"), Color(to: "d", intent: Overwrite)]),
        Raster(name: "show", accesses: [Sampled(of: "d"), Color(to: "screen", intent: Overwrite)]),
    ],
)"#;

/// Returns counts of the frame in a mode.
fn under(gpu: &Gpu, mode: Option<Mode>) -> Result<(Counts, ObjectCounts, u32), Box<dyn std::error::Error>> {
    let mut frame = Frame::<()>::new();
    GraphFile::parse("frame.ron", FRAME)?.declare(&[], &Registry::new(), &mut frame)?;
    mock::add_recorders(&mut frame);
    let (mut options, mut execute) = (Options::for_frame(16, 8), ExecutorOptions::default());
    mode.iter().for_each(|m| m.apply(&mut options, &mut execute));
    let mut plan = Plan::new();
    framegraph::compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    let mut executor = Executor::with(gpu, execute);
    executor.execute(&plan, &frame, &(), &mock::imports(gpu, &plan)?.bound)?;
    assert_eq!(executor.executed(), plan.counts(), "{mode:?}");
    Ok((executor.executed(), executor.objects(), executor.poisoned()))
}

#[test]
fn every_mode_has_its_effect() -> TestResult {
    on_every_device("every_mode_has_its_effect", |gpu, _| {
        let (base, objects, poisoned) = under(gpu, None)?;
        let found = (base.passes, base.culled, base.render_passes, base.inlined, base.memoryless);
        assert_eq!((found, objects.textures, poisoned), ((7, 1, 5, 1, 1), 3, 0), "depth, and two that take turns");
        for mode in Mode::ALL {
            let (counts, made, poisoned) = under(gpu, Some(mode))?;
            let found = (counts.passes, counts.culled, counts.render_passes, counts.inlined, made.textures);
            let expected = match mode {
                Mode::NoCull => (8, 0, 6, 1, 4),
                Mode::NoMerge => (7, 1, 6, 1, 3),
                Mode::NoInline => (7, 1, 6, 0, 3),
                Mode::NoAlias => (7, 1, 5, 1, 5),
                Mode::Immediate => (8, 0, 8, 0, 7),
                Mode::Poison => (7, 1, 5, 1, 3),
            };
            assert_eq!(found, expected, "{mode}");
            assert_eq!(poisoned > 0, mode == Mode::Poison, "{mode}: {poisoned} fills");
        }
        Ok(())
    })
}

const HALF: Shader<'static> = Shader::new(
    "half",
    "@group(0) @binding(0) var image: texture_storage_2d<r32float, write>;
     @group(0) @binding(1) var<storage, read_write> sums: array<f32>;
     @compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3u) {
       if id.x < 4u { textureStore(image, id.xy, vec4f(0.25)); }
       if id.y == 0u { sums[id.x] = 0.5; }
     }",
);

/// Writes half of a storage texture and a buffer that it declares as overwritten.
fn halves(frame: &mut Frame) -> Result<(Texture, Buffer), framegraph::DeclareError> {
    let desc = TextureDesc::new(Extent::absolute(8, 8), Format::R32Float);
    let (image, sums) = (frame.graph_mut().texture("image", desc), frame.graph_mut().buffer("sums", 64));
    let declare = |p: &mut framegraph::PassBuilder<'_>| {
        let sums = p.write_buffer(sums, AccessKind::StorageWrite, Intent::Overwrite)?;
        Ok((p.storage_write(image, Intent::Overwrite)?, sums))
    };
    let record = |(image, sums): &(Texture, Buffer), (): &(), cx: &mut Cx<'_>| -> Result<(), RecordError> {
        let pipeline = cx.compute_pipeline(&Compute::new(HALF))?;
        let (image, sums) = (cx.view_of(*image)?, cx.buffer_of(*sums)?);
        let group = cx.bind_group(pipeline.group(0), &[(0, image.into()), (1, sums.into())]);
        let pass = cx.compute_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        Ok(())
    };
    let (image, sums) = frame.add_fn("half", declare, record)?;
    frame.graph_mut().readback(image)?;
    frame.graph_mut().readback_buffer(sums)?;
    Ok((image, sums))
}

/// Returns whether the bits are NaN.
fn is_nan(bits: u32) -> bool {
    bits & 0x7fff_ffff > 0x7f80_0000
}

#[test]
fn storage_and_buffers_are_poisoned() -> TestResult {
    on_every_device("storage_and_buffers_are_poisoned", |gpu, drawn| {
        for poison in [false, true] {
            let mut bench = Bench::new(gpu, 8, 8);
            bench.executor = Executor::with(gpu, ExecutorOptions { poison, ..ExecutorOptions::default() });
            for _ in 0..2 {
                let (image, sums) = bench.run(halves)?;
                assert_eq!(bench.executor.poisoned(), if poison { 2 } else { 0 });
                let words = |bytes: &[u8]| bytes.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect();
                let buffer = bench.executor.buffer(&bench.plan, sums).ok_or("no buffer")?;
                let (texels, floats): (Vec<u32>, Vec<u32>) =
                    (words(&bench.pixels(image)?.bytes), words(&read_buffer(gpu, buffer, 64)?));
                if drawn {
                    let quarter = |w: &u32| *w == 0.25f32.to_bits();
                    let (written, left): (Vec<_>, Vec<_>) = (0..64).partition(|i| i % 8 < 4);
                    assert!(written.iter().all(|i| quarter(&texels[*i])));
                    assert!(left.iter().all(|i| is_nan(texels[*i]) == poison), "{texels:x?}");
                    assert!(floats[..8].iter().all(|w| *w == 0.5f32.to_bits()));
                    assert!(floats[8..].iter().all(|w| is_nan(*w) == poison), "{floats:x?}");
                }
            }
        }
        Ok(())
    })
}

/// The second tenant of a texture writes half of it. The contents of the first tenant show unless they are poisoned.
#[test]
fn contents_of_the_last_tenant_are_poisoned() -> TestResult {
    let declare = |frame: &mut Frame| {
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
        let (a, b, c, d) = {
            let graph = frame.graph_mut();
            (graph.texture("a", desc), graph.texture("b", desc), graph.texture("c", desc), graph.texture("d", desc))
        };
        let read = |from: Texture, to: Texture| {
            move |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(from)?, p.color(to, Intent::Overwrite)?))
        };
        let a = frame.add_fn("a", |p| p.color(a, Intent::Overwrite), |_, (), cx| fill_full(cx, [0.5; 4]))?;
        let (_, b) = frame.add_fn("b", read(a, b), |_, (), cx| fill_full(cx, RED))?;
        let (_, c) = frame.add_fn("c", read(b, c), |_, (), cx| fill_corner(cx, RED))?;
        let (_, d) = frame.add_fn("d", read(c, d), |(c, _), (), cx| draw_of(cx, &Raster::new(SHOW), *c))?;
        frame.graph_mut().readback(d)?;
        Ok(d)
    };
    on_every_device("contents_of_the_last_tenant_are_poisoned", |gpu, drawn| {
        for poison in [false, true] {
            let mut bench = Bench::new(gpu, 8, 8);
            bench.executor = Executor::with(gpu, ExecutorOptions { poison, ..ExecutorOptions::default() });
            let out = bench.run(declare)?;
            assert_eq!(bench.plan.slots().len(), 2, "a and c share a texture, or this shows nothing");
            if drawn {
                let corner = bench.pixels(out)?.rgba()[7];
                let seen = corner.map(f32::to_bits).map(is_nan);
                assert_eq!(seen, [poison; 4], "{corner:?}");
                assert!(poison || corner == [0.5; 4], "what `a` left: {corner:?}");
            }
        }
        Ok(())
    })
}

/// A plane that is discarded next to a stored one is poisoned; the other one is not.
#[test]
fn only_the_discarded_plane_is_poisoned() -> TestResult {
    let declare = |frame: &mut Frame| {
        let both = TextureDesc::new(Extent::FRAME, Format::Depth32FloatStencil8);
        let depth = frame.graph_mut().texture("depth", both);
        let clear = Intent::Clear(ClearValue::DepthStencil(0.75, 7));
        let depth = frame.add_fn("draw", |p| p.depth(depth, clear), |_, (), _| Ok(()))?;
        let out = frame.graph_mut().texture("out", TextureDesc::new(Extent::FRAME, Format::R32Float));
        let read = |p: &mut framegraph::PassBuilder<'_>| {
            let view = p.sampled(depth.aspect(framegraph::Aspect::Depth))?;
            Ok((view, p.color(out, Intent::Overwrite)?))
        };
        let draw = |(view, _): &(_, _), (): &(), cx: &mut Cx<'_>| draw_of(cx, &Raster::new(SHOW_DEPTH), *view);
        let (_, out) = frame.add_fn("show", read, draw)?;
        frame.graph_mut().readback(out)?;
        Ok(out)
    };
    on_every_device("only_the_discarded_plane_is_poisoned", |gpu, drawn| {
        let mut fills = Vec::new();
        for poison in [false, true] {
            let mut bench = Bench::new(gpu, 4, 4);
            bench.executor = Executor::with(gpu, ExecutorOptions { poison, ..ExecutorOptions::default() });
            let out = bench.declare(declare)?;
            bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports)?;
            fills.push(bench.executor.poisoned());
            if drawn {
                assert!(bench.pixels(out)?.rgba().iter().all(|t| t[0] == 0.75), "depth is kept");
            }
        }
        // Filled are both textures before their first use, the stencil plane after the first step, and the don't-care
        // target of the second step.
        assert_eq!(fills, [0, 4]);
        Ok(())
    })
}
