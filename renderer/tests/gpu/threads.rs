//! Multithreaded recording: contents, counts, objects and errors are those of one thread.

use crate::bench::{Bench, RED, TestResult, draw_of, fill_full, on_every_device};
use framegraph::{DeclareError, Extent, Format, Intent, PassBuilder, Texture, TextureDesc, View};
use framegraph_wgpu::{Cx, ExecuteError, Executor, ExecutorOptions, Frame, Raster, RecordError, Shader, Workers};

const LENGTH: u32 = 11;

/// Adds a small constant to an image.
const ADD: Shader<'static> = Shader::new(
    "add",
    "@group(0) @binding(0) var image: texture_2d<f32>;
     @group(0) @binding(1) var<uniform> more: vec4f;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
     }
     @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
       return textureLoad(image, vec2u(at.yx), 0) * 0.5 + more;
     }",
);

fn add(at: u32, image: View, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let pipeline = cx.raster_pipeline(&Raster::new(ADD))?;
    let bindings = [(0, cx.view(image)?.into()), (1, cx.uniform(&[at as f32 / 64.0, 0.1, 1.0 / (at + 1) as f32, 1.0]))];
    let group = cx.bind_group(pipeline.group(0), &bindings);
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    Ok(())
}

/// Declares a chain of steps in which two passes may fail: one in its recorder, one in wgpu.
fn chain(frame: &mut Frame, wrong: [Option<u32>; 2]) -> Result<Texture, DeclareError> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let first = frame.graph_mut().texture("link 0", desc);
    let mut last = frame.add_fn("fill", |p| p.color(first, Intent::Overwrite), |_, _, cx| fill_full(cx, RED))?;
    for at in 1..=LENGTH {
        let next = frame.graph_mut().texture(&format!("link {at}"), desc);
        let declare = |p: &mut PassBuilder<'_>| Ok((p.sampled(last)?, p.color(next, Intent::Overwrite)?));
        let record = move |(view, _): &(View, Texture), (): &(), cx: &mut Cx<'_>| match wrong.map(|w| w == Some(at)) {
            [true, _] => draw_of(cx, &Raster::new(Shader::new("no shader", "no shader")), *view),
            [_, true] => {
                let pipeline = cx.raster_pipeline(&Raster::new(ADD))?;
                let pass = cx.render_pass()?;
                // A draw without its bind group.
                pass.set_pipeline(&pipeline);
                pass.draw(0..3, 0..1);
                Ok(())
            }
            _ => add(at, *view, cx),
        };
        (_, last) = frame.add_fn(&format!("add {at}"), declare, record)?;
    }
    frame.graph_mut().readback(last)?;
    Ok(last)
}

fn bench(gpu: &framegraph_wgpu::Gpu, threads: usize) -> Result<Bench, Box<dyn std::error::Error>> {
    let mut bench = Bench::new(gpu, 16, 16);
    bench.executor =
        Executor::with(gpu, ExecutorOptions { timing: threads.is_multiple_of(2), ..ExecutorOptions::default() });
    bench.frame.allow_threads();
    bench.executor.force_record_on(Workers::with_threads(threads)?);
    Ok(bench)
}

#[test]
fn threads_record_the_same_commands() -> TestResult {
    on_every_device("threads_record_the_same_commands", |gpu, pixels| {
        let mut alone = Bench::new(gpu, 16, 16);
        let expected = alone.run(|frame| chain(frame, [None; 2]))?;
        for threads in [1, 2, 3, 40] {
            let mut many = bench(gpu, threads)?;
            for frame in 0..4 {
                let drawn = many.run(|frame| chain(frame, [None; 2]))?;
                assert_eq!(many.executor.recording_threads(), threads.min(LENGTH as usize + 1), "frame {frame}");
                if pixels {
                    assert!(many.pixels(drawn)? == alone.pixels(expected)?, "{threads} threads, frame {frame}");
                }
            }
            let (made, of_one) = (many.executor.objects(), alone.executor.objects());
            assert_eq!(
                (made.pipelines, made.bind_groups, made.views),
                (of_one.pipelines, of_one.bind_groups, of_one.views)
            );
            assert!(made.uniform_buffers <= threads as u64, "{made:?}");
            if threads == 2 {
                let times = many.executor.timing();
                assert!(
                    (0..=LENGTH).all(|step| times.step(framegraph::StepId::at(step as usize)).cpu.is_none()),
                    "warming up"
                );
            }
        }
        Ok(())
    })
}

/// The first error in the order of the frame is reported, independent of thread timing, and the next frame is correct.
#[test]
fn errors_are_those_of_one_thread() -> TestResult {
    on_every_device("errors_are_those_of_one_thread", |gpu, pixels| {
        for wrong in [
            [Some(9), None],
            [None, Some(9)],
            [None, Some(1)],
            [Some(3), None],
            [Some(10), Some(2)],
            [Some(2), Some(10)],
        ] {
            let message = |bench: &mut Bench| -> Result<String, Box<dyn std::error::Error>> {
                bench.declare(|frame| chain(frame, wrong))?;
                let error = bench.execute().err().ok_or("the frame is wrong")?;
                Ok(error.downcast::<ExecuteError>()?.to_string())
            };
            let (mut alone, mut many) = (Bench::new(gpu, 16, 16), bench(gpu, 3)?);
            let expected = message(&mut alone)?;
            assert_eq!(message(&mut many)?, expected);
            assert_eq!(message(&mut many)?, expected, "the second time");
            let drawn = [&mut alone, &mut many].map(|bench| bench.run(|frame| chain(frame, [None; 2])));
            let [one, two] = drawn;
            if pixels {
                assert!(alone.pixels(one?)? == many.pixels(two?)?, "after an error");
            }
        }
        Ok(())
    })
}

/// With one thread, frames are never split.
#[test]
fn one_thread_never_splits_frames() -> TestResult {
    on_every_device("one_thread_never_splits_frames", |gpu, _| {
        let mut bench = Bench::new(gpu, 16, 16);
        bench.frame.allow_threads();
        bench.executor.record_on(Some(Workers::with_threads(1)?));
        for _ in 0..40 {
            bench.run(|frame| chain(frame, [None; 2]))?;
            assert_eq!(bench.executor.recording_threads(), 1, "there is one thread");
        }
        bench.executor.record_on(None);
        bench.execute()
    })
}
