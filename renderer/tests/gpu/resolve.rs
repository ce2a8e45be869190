//! Resolve modes for four different samples of colors, integers and depth.

use crate::bench::{Bench, FILL, SHOW_DEPTH, TestResult, draw, draw_of, fill, on_adapter, on_every_device};
use framegraph::{ClearValue, Extent, Format, Intent, Join, Options, Plan, ResolveMode, Scratch, TextureDesc, compile};
use framegraph_wgpu::{
    Cx, Depth, ExecuteError, Executor, Frame, Gpu, Imports, Raster, RecordError, Shader, read_texture,
};
use wgpu::CompareFunction;

const SIDE: u32 = 16;

/// Returns multiples of 1/16 that vary between samples and texels, so that no sample is always the minimum.
fn sixteenths(x: u32, y: u32, sample: u32) -> u32 {
    (x * 7 + y * 3 + sample * (5 + x % 4) + sample * sample * y) % 13
}

const PAINT: &str = "
@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
  return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
struct Out {
  @location(0) color: vec4f,
  @location(1) whole: vec4u,
  @builtin(frag_depth) depth: f32,
}
@fragment fn fs_main(@builtin(position) position: vec4f, @builtin(sample_index) sample: u32) -> Out {
  let at = vec2u(position.xy);
  let n = (at.x * 7 + at.y * 3 + sample * (5 + at.x % 4) + sample * sample * at.y) % 13;
  return Out(vec4f(f32(n) / 16.0), vec4u(n), f32(n) / 16.0);
}
";

/// Returns the resolved value of a texel in a mode, in sixteenths.
fn expected(mode: ResolveMode, x: u32, y: u32) -> f32 {
    let samples = [0, 1, 2, 3].map(|sample| sixteenths(x, y, sample) as f32);
    match mode {
        ResolveMode::Average => samples.iter().sum::<f32>() / 4.0,
        ResolveMode::Sample0 => samples[0],
        ResolveMode::Min => samples.into_iter().fold(f32::MAX, f32::min),
        ResolveMode::Max => samples.into_iter().fold(0.0, f32::max),
    }
}

/// Declares a frame that draws samples and resolves color, integers and depth with one mode. Integers and depth use
/// sample 0 if the mode is average. Returns the three targets.
fn frame(frame: &mut Frame, mode: ResolveMode) -> Result<[framegraph::Texture; 3], framegraph::DeclareError> {
    let formats = [Format::Rgba16Float, Format::R8Uint, Format::Depth32Float];
    let desc = |format| TextureDesc::new(Extent::FRAME, format);
    let samples = formats.map(|format| frame.graph_mut().texture("samples", desc(format).samples(4)));
    let targets = formats.map(|format| frame.graph_mut().texture("target", desc(format)));
    let declare = |p: &mut framegraph::PassBuilder<'_>| {
        let clear = Intent::Clear(ClearValue::Zero);
        let drawn = [p.color(samples[0], clear)?, p.color(samples[1], clear)?, p.depth(samples[2], clear)?];
        let whole = if mode == ResolveMode::Average { ResolveMode::Sample0 } else { mode };
        Ok([
            p.resolve_as(mode, drawn[0], targets[0])?,
            p.resolve_as(whole, drawn[1], targets[1])?,
            p.resolve_as(whole, drawn[2], targets[2])?,
        ])
    };
    let resolved = frame.add_fn("paint", declare, |_, _, cx| -> Result<(), RecordError> {
        let depth = Depth { compare: CompareFunction::Always, write: true, ..Depth::NONE };
        draw(cx, &Raster { depth, ..Raster::new(Shader::new("paint", PAINT)) }, &[])
    })?;
    resolved.iter().try_for_each(|target| frame.graph_mut().readback(*target))?;
    Ok(resolved)
}

/// Checks the error on OpenGL, where wgpu has no multisampled textures in shaders: it names pass, samples, mode, reason
/// and solution.
fn is_refused<T>(found: Result<T, Box<dyn std::error::Error>>, mode: &str) -> TestResult {
    let message = found.map(drop).expect_err("OpenGL has no samples in memory").to_string();
    let parts =
        ["pass `", "`samples", &format!("with mode `{mode}`"), "on OpenGL", "use another backend, or one sample"];
    assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    Ok(())
}

#[test]
fn each_resolve_mode_gives_its_value() -> TestResult {
    const NAME: &str = "each_resolve_mode_gives_its_value";
    on_every_device(NAME, |gpu, drawn| {
        let mut bench = Bench::new(gpu, SIDE, SIDE);
        if gpu.info().backend == wgpu::Backend::Gl {
            return is_refused(bench.run(|f| frame(f, ResolveMode::Min)), "min");
        }
        for mode in ResolveMode::ALL {
            let [color, whole, depth] = bench.run(|f| frame(f, mode))?;
            let full_screen = bench.plan.step_passes().iter().filter(|m| m.join == Join::Resolve).count();
            assert_eq!((full_screen, bench.plan.counts().passes), (1, 1), "one pass makes all of them");
            assert_eq!(bench.plan.counts().multisample_resolves, u32::from(mode == ResolveMode::Average));
            if !drawn {
                continue;
            }
            let red = |texture| -> Result<Vec<f32>, Box<dyn std::error::Error>> {
                Ok(bench.pixels(texture)?.rgba().iter().map(|c| c[0]).collect())
            };
            let depths = bench.pixels(depth)?.depth().ok_or("depth")?;
            let found = [
                red(color)?.iter().map(|c| c * 16.0).collect::<Vec<_>>(),
                red(whole)?,
                depths.iter().map(|d| d * 16.0).collect(),
            ];
            for (index, found) in found.iter().enumerate() {
                let own = if index > 0 && mode == ResolveMode::Average { ResolveMode::Sample0 } else { mode };
                for other in ResolveMode::ALL {
                    let texels = (0..SIDE * SIDE).map(|at| expected(other, at % SIDE, at / SIDE));
                    let wrong = texels.zip(found).filter(|(e, f)| e != *f).count();
                    // Sixteenths and quarters of them are exact in these formats. Any other mode differs in most
                    // texels.
                    let message = format!("{mode:?}, target {index}: {wrong} texels are not by {other:?}");
                    assert!(if other == own { wrong == 0 } else { wrong > 100 }, "{message}");
                }
            }
        }
        Ok(())
    })
}

/// Formats that WebGPU cannot average in a store operation are averaged by a pass. The device is opened without the
/// adapter's additional format features.
#[test]
fn samples_of_32_bits_are_averaged_by_a_pass() -> TestResult {
    const NAME: &str = "samples_of_32_bits_are_averaged_by_a_pass";
    on_every_device(NAME, |gpu, drawn| {
        let mut bench = Bench::new(gpu, SIDE, SIDE);
        if gpu.info().backend == wgpu::Backend::Gl {
            return Ok(());
        }
        // Compares with a device that averages them in the store operation, if available.
        let in_store = gpu.caps().averages(Format::R32Float);
        let declare = |frame: &mut Frame| {
            let desc = TextureDesc::new(Extent::FRAME, Format::R32Float);
            let samples = frame.graph_mut().texture("samples", desc.samples(4));
            let target = frame.graph_mut().texture("target", desc);
            let declare = |p: &mut framegraph::PassBuilder<'_>| {
                let drawn = p.color(samples, Intent::Clear(ClearValue::BLACK))?;
                p.resolve(drawn, target)
            };
            let resolved = frame.add_fn("paint", declare, |_, (), cx| {
                let corner = Raster { vertex: "corner", ..Raster::new(FILL) };
                fill(cx, &corner, [1.0e9, 0.0, 0.0, 1.0], 0.0)
            })?;
            frame.graph_mut().readback(resolved)?;
            Ok(resolved)
        };
        let resolved = bench.run(declare)?;
        assert_eq!(bench.plan.counts().multisample_resolves, u32::from(in_store));
        assert_eq!(bench.plan.counts().steps, 1 + u32::from(!in_store));
        let formats = gpu.caps().formats.without(Format::R32Float, framegraph::FormatCaps::RESOLVABLE);
        let caps = framegraph::Caps { formats, ..gpu.caps() };
        let mut plan = Plan::new();
        compile(bench.frame.graph(), &caps, &bench.options, &mut Scratch::new(), &mut plan)?;
        let mut executor = Executor::new(gpu);
        executor.execute(&plan, &bench.frame, &(), &Imports::new())?;
        let texture = executor.texture(&plan, resolved).ok_or("no picture")?;
        let by_pass = read_texture(gpu, texture)?;
        if drawn {
            let red: Vec<_> = by_pass.rgba().iter().map(|texel| texel[0]).collect();
            // Along the edge, some of the four samples are covered.
            assert!(
                red.contains(&1.0e9) && red.contains(&0.0) && red.iter().any(|r| *r > 0.0 && *r < 1.0e9),
                "{red:?}"
            );
            assert!(red == bench.pixels(resolved)?.rgba().iter().map(|texel| texel[0]).collect::<Vec<_>>());
        }
        Ok(())
    })
}

/// The plan was compiled for a device that resolves everything in store operations.
#[test]
fn a_plan_of_another_device_is_rejected() -> TestResult {
    let gpu = Gpu::noop()?;
    let mut declared = Frame::new();
    frame(&mut declared, ResolveMode::Min)?;
    let every = framegraph::ResolveModes::of(&ResolveMode::ALL);
    let caps = framegraph::Caps { color_resolves: every, depth_resolves: every, ..gpu.caps() };
    let mut plan = Plan::new();
    compile(declared.graph(), &caps, &Options::for_frame(SIDE, SIDE), &mut Scratch::new(), &mut plan)?;
    let refused = Executor::new(&gpu).execute(&plan, &declared, &(), &Imports::new());
    let message = match refused {
        Err(error @ ExecuteError::StoreResolve { mode: ResolveMode::Min, .. }) => error.to_string(),
        other => panic!("{:?}", other.map(drop)),
    };
    assert!(message.contains("`target`") && message.contains("`Caps`"), "{message}");
    Ok(())
}

/// Read-only depth is resolved too, into a depth format, and later frames reuse the target.
#[test]
fn depth_beside_stencil_is_resolved_by_a_pass_that_draws_nothing() -> TestResult {
    const NAME: &str = "depth_beside_stencil_is_resolved_by_a_pass_that_draws_nothing";
    on_adapter(NAME, |gpu| {
        let mut bench = Bench::new(gpu, SIDE, SIDE);
        for _ in 0..2 {
            let declare = |frame: &mut Frame| {
                let desc = TextureDesc::new(Extent::FRAME, Format::Depth24PlusStencil8);
                let samples = frame.graph_mut().texture("samples", desc.samples(4));
                let target = frame.graph_mut().texture("target", desc.format(Format::Depth24Plus));
                let shown = frame.graph_mut().texture("shown", desc.format(Format::R16Float));
                let clear = Intent::Clear(ClearValue::DepthStencil(0.25, 7));
                let drawn = frame.add_fn("clear", |p| p.depth(samples, clear), |_, _, _| Ok(()))?;
                let resolve = |p: &mut framegraph::PassBuilder<'_>| {
                    p.depth_read_only(drawn)?;
                    p.resolve_as(ResolveMode::Max, drawn, target)
                };
                let target = frame.add_fn("resolve", resolve, |_, _, _| Ok(()))?;
                let show = |p: &mut framegraph::PassBuilder<'_>| {
                    let view = p.sampled(target)?;
                    Ok((view, p.color(shown, Intent::Overwrite)?))
                };
                let draw = |(view, _): &(_, _), (): &(), cx: &mut Cx<'_>| draw_of(cx, &Raster::new(SHOW_DEPTH), *view);
                let (_, shown) = frame.add_fn("show", show, draw)?;
                frame.graph_mut().readback(shown)?;
                Ok(shown)
            };
            if gpu.info().backend == wgpu::Backend::Gl {
                return is_refused(bench.run(declare), "max");
            }
            let resolved = bench.run(declare)?;
            assert_eq!(bench.plan.counts().steps, 3, "what only resolves shares the step that cleared");
            let shown = bench.pixels(resolved)?.rgba();
            // Depth has 24 bits or more, and 0.25 is exact in half floats.
            assert!(shown.iter().all(|c| (c[0] - 0.25).abs() < 1e-6), "{:?}", &shown[..2]);
        }
        Ok(())
    })
}
