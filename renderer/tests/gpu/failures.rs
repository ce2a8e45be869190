//! Failures: errors name the pass, nothing of the frame is submitted, and the next frame is correct.

use crate::bench::{Bench, RED, TestResult, fill_corner, fill_full, on_adapter, on_every_device};
use framegraph::{DeclareError, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{Cx, DeviceError, ExecuteError, Gpu, Raster, RecordError, Shader};

type Recorder = fn(&mut Cx<'_>) -> Result<(), RecordError>;

fn declare(frame: &mut Frame, recorder: Recorder) -> Result<Texture, DeclareError> {
    let target = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    let target = frame.add_fn("pass", |p| p.color(target, Intent::Overwrite), move |_, (), cx| recorder(cx))?;
    frame.graph_mut().readback(target)?;
    Ok(target)
}

const GOOD: Recorder = |cx| fill_full(cx, RED);

#[test]
fn a_frame_after_a_failed_one_is_correct() -> TestResult {
    let failures: [(Recorder, &str); 5] = [
        (|_| Err(RecordError::custom("no camera")), "pass `pass`: no camera"),
        (|cx| cx.compute_pass().map(|_| ()), "a compute pass was requested in a raster pass"),
        (
            |cx| cx.raster_pipeline(&Raster::new(Shader::new("broken", "fn ("))).map(|_| ()),
            "pass `pass`: shader `broken` does not compile",
        ),
        // A draw without a pipeline: wgpu rejects the commands when they are finished.
        (
            |cx| {
                cx.render_pass()?.draw(0..3, 0..1);
                Ok(())
            },
            "pass `pass`: wgpu rejected its commands",
        ),
        (
            |cx| {
                let huge = wgpu::BufferDescriptor {
                    label: None,
                    size: 1 << 60,
                    usage: wgpu::BufferUsages::VERTEX,
                    mapped_at_creation: false,
                };
                drop(cx.gpu().device.create_buffer(&huge));
                fill_corner(cx, RED)
            },
            "pass `pass`: wgpu rejected its commands",
        ),
    ];
    on_every_device("a_frame_after_a_failed_one_is_correct", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 8, 8);
        for (recorder, message) in failures {
            let report = bench.run(|f| declare(f, recorder)).map_err(|e| e.to_string()).err().unwrap_or_default();
            assert!(report.contains(message) && !report.contains('\n'), "{report}");
            let target = bench.run(|f| declare(f, GOOD))?;
            if drawn {
                assert!(bench.pixels(target)?.bytes.chunks_exact(4).all(|t| t == [255, 0, 0, 255]), "after {message}");
            }
        }
        Ok(())
    })
}

#[test]
fn a_lost_device_is_an_error_and_no_panic() -> TestResult {
    on_every_device("a_lost_device_is_an_error_and_no_panic", |gpu, _| {
        let mut bench = Bench::new(gpu, 8, 8);
        bench.run(|f| declare(f, GOOD))?;
        // wgpu reports a destroyed device once nothing is in flight.
        gpu.wait()?;
        gpu.device.destroy();
        for _ in 0..3 {
            bench.declare(|f| declare(f, GOOD))?;
            let report = bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports);
            assert!(matches!(report, Err(ExecuteError::Device(DeviceError::Lost { .. }))), "{report:?}");
        }
        // A new device on the same machine works.
        if gpu.info().backend == wgpu::Backend::Noop {
            Bench::new(&Gpu::noop()?, 8, 8).run(|f| declare(f, GOOD))?;
        }
        Ok(())
    })
}

#[test]
fn a_plan_of_another_frame_is_rejected() -> TestResult {
    let gpu = Gpu::noop()?;
    let mut bench = Bench::new(&gpu, 8, 8);
    bench.declare(|f| declare(f, GOOD))?;
    bench.frame.reset();
    let report = bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports);
    assert!(matches!(report, Err(ExecuteError::OtherPlan)), "{report:?}");
    Ok(())
}

#[test]
fn tokens_of_other_passes_and_frames_are_rejected() -> TestResult {
    let gpu = Gpu::noop()?;
    let mut bench = Bench::new(&gpu, 8, 8);
    let stale = bench.run(|f| declare(f, GOOD))?;
    let run = |bench: &mut Bench, look: fn(&mut Cx<'_>, Texture) -> Result<(), RecordError>, own: bool| {
        let report = bench.run(|f| {
            let written = declare(f, GOOD)?;
            let handle = if own { written } else { stale };
            let out = f.graph_mut().texture("out", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
            let out = f.add_fn("nosy", |p| p.color(out, Intent::Overwrite), move |_, (), cx| look(cx, handle))?;
            f.graph_mut().export(out)?;
            Ok(())
        });
        report.map_err(|e| e.to_string()).err().unwrap_or_default()
    };
    let view = |cx: &mut Cx<'_>, t| cx.view_of(t).map(|_| ());
    let undeclared = run(&mut bench, view, true);
    assert!(
        undeclared.contains("pass `nosy`: `color` is accessed as `color`, which this pass did not declare"),
        "{undeclared}"
    );
    let foreign = run(&mut bench, view, false);
    assert!(foreign.contains("pass `nosy`: the handle or token belongs to another graph"), "{foreign}");
    Ok(())
}

#[test]
fn unsupported_textures_name_supported_formats() -> TestResult {
    let gpu = Gpu::noop()?;
    let mut bench = Bench::new(&gpu, 8, 8);
    let report = bench.run(|frame| {
        let target = frame.graph_mut().texture("snorm", TextureDesc::new(Extent::FRAME, Format::Rgba8Snorm));
        let target = frame.add_fn("pass", |p| p.color(target, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
        frame.graph_mut().export(target)?;
        Ok(())
    });
    let report = report.map_err(|e| e.to_string()).err().unwrap_or_default();
    assert!(
        report.contains("the device does not support Rgba8Snorm as `color`") && report.contains("`snorm`"),
        "{report}"
    );
    bench.run(|f| declare(f, GOOD))?;
    Ok(())
}

/// Allocates the largest texture that the limits allow, which exceeds any memory.
#[test]
fn out_of_memory_errors_name_the_request() -> TestResult {
    on_adapter("out_of_memory_errors_name_the_request", |gpu| {
        let mut bench = Bench::new(gpu, 8, 8);
        let caps = gpu.caps();
        let side = caps.max_texture_texels;
        let huge = TextureDesc::new(Extent::absolute(side, side), Format::Rgba32Float)
            .layers(caps.max_texture_layers.min(u16::MAX.into()) as u16);
        for _ in 0..2 {
            let report = bench.run(|frame| {
                let target = frame.graph_mut().texture("vast", huge);
                let clear = Intent::Clear(framegraph::ClearValue::BLACK);
                let target = frame.add_fn("pass", |p| p.color(target.layer(0), clear), |_, (), _| Ok(()))?;
                let out = frame.graph_mut().texture("out", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
                let read = |p: &mut framegraph::PassBuilder<'_>| {
                    p.sampled(target.layer(0))?;
                    p.color(out, Intent::Overwrite)
                };
                let out = frame.add_fn("read", read, |_, (), cx| fill_full(cx, RED))?;
                frame.graph_mut().export(out)?;
                Ok(())
            });
            let report = report.map_err(|e| e.to_string()).err().unwrap_or_default();
            assert!(report.contains("the device is out of memory while") && !report.contains('\n'), "{report}");
            let bytes = format!("{:.1} MiB of them for `vast`", huge.bytes([8, 8]) as f64 / f64::from(1 << 20));
            assert!(report.contains(&bytes) && report.contains(&gpu.info().name), "{report}");
            let target = bench.run(|f| declare(f, GOOD))?;
            assert!(bench.pixels(target)?.bytes.chunks_exact(4).all(|t| t == [255, 0, 0, 255]), "the next frame");
        }
        Ok(())
    })
}

/// A lost device is reported by every later use, and errors of the request are kept.
#[test]
fn readbacks_and_inspections_report_a_lost_device() -> TestResult {
    on_every_device("readbacks_and_inspections_report_a_lost_device", |gpu, _| {
        let mut bench = Bench::new(gpu, 8, 8);
        let target = bench.run(|f| declare(f, GOOD))?;
        gpu.wait()?;
        gpu.device.destroy();
        drop(gpu.device.poll(wgpu::PollType::Poll));
        let report = bench.pixels(target).map(|_| ()).map_err(|e| e.to_string()).err().unwrap_or_default();
        assert!(report.contains("the device was lost"), "{report}");
        let Bench { executor, plan, frame, imports, .. } = &bench;
        let mut inspector = framegraph_wgpu::inspect::Inspector::new(gpu);
        let seen = inspector.inspect(executor, plan, frame, &(), imports, &"color".parse()?);
        let report = seen.map(|_| ()).map_err(|e| e.to_string()).err().unwrap_or_default();
        assert!(report.contains("inspecting `color`: the device was lost"), "{report}");
        let report = bench.executor.catch_up().map(|_| ()).map_err(|e| e.to_string());
        assert!(report.is_err_and(|e| e.contains("the device was lost")));
        Ok(())
    })
}
