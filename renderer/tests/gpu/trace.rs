//! Traces are valid JSON with tracks for CPU and GPU, nested events, and the names and counts of the plan.

use crate::bench::{Bench, TestResult, fill_full, on_every_device, skip};
use framegraph::{DeclareError, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{Executor, ExecutorOptions};
use serde_json::Value;

const FRAMES: usize = 9;

/// Declares two steps; the name of the second must be escaped.
fn declare(frame: &mut Frame) -> Result<Texture, DeclareError> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
    let (first, second) = (frame.graph_mut().texture("first", desc), frame.graph_mut().texture("second", desc));
    let first = frame.add_fn("draw", |p| p.color(first, Intent::Overwrite), |_, (), cx| fill_full(cx, [0.5; 4]))?;
    let read = |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(first)?, p.color(second, Intent::Overwrite)?));
    let (_, second) = frame.add_fn("say \"hi\"\\\n", read, |_, (), cx| fill_full(cx, [0.5; 4]))?;
    frame.graph_mut().export(second)?;
    Ok(second)
}

/// Returns begin and end in microseconds.
fn span(event: &Value) -> Option<(f64, f64)> {
    let begin = event["ts"].as_f64()?;
    Some((begin, begin + event["dur"].as_f64()?))
}

#[test]
fn a_trace_is_json_with_nested_events_on_both_sides() -> TestResult {
    on_every_device("a_trace_is_json_with_nested_events_on_both_sides", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 64, 64);
        bench.executor = Executor::with(gpu, ExecutorOptions { trace: true, ..ExecutorOptions::default() });
        for _ in 0..FRAMES {
            bench.run(declare)?;
            gpu.wait()?;
        }
        let trace = bench.executor.catch_up()?.trace().ok_or("nothing was written down")?;
        assert_eq!(trace.frames(), FRAMES);
        let json: Value = serde_json::from_str(&trace.chrome_json())?;
        let events = json["traceEvents"].as_array().ok_or("no events")?;
        let of = |pid: u64, tid: u64| {
            let on = move |e: &&Value| e["ph"] == "X" && e["pid"] == pid && e["tid"] == tid;
            events.iter().filter(on).collect::<Vec<_>>()
        };
        let stamps = drawn && gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        for pid in if stamps { 1..=2 } else { 1..=1 } {
            let (frames, steps) = (of(pid, 1), of(pid, 2));
            assert_eq!((frames.len(), steps.len()), (FRAMES, 2 * FRAMES), "process {pid}");
            for (index, frame) in frames.iter().enumerate() {
                assert_eq!(frame["name"], format!("frame {index}"));
                assert_eq!(frame["args"]["resolves"], 2);
                let (begin, end) = span(frame).ok_or("no times")?;
                let names: Vec<_> = steps[2 * index..][..2].iter().map(|s| s["name"].as_str()).collect();
                assert_eq!(names, [Some("draw"), Some("say \"hi\"\\\n")]);
                let mut before = begin;
                for step in &steps[2 * index..][..2] {
                    let (from, to) = span(step).ok_or("no times")?;
                    // Times are printed with three decimals.
                    assert!(before <= from + 0.002 && from <= to && to <= end + 0.002, "{step} in {frame}");
                    assert_eq!(
                        (&step["args"]["stored_bytes"], &step["args"]["frame"]),
                        (&(64 * 64 * 8).into(), &index.into())
                    );
                    before = to;
                }
            }
            let warm = frames.iter().filter(|f| f["args"]["warm_up"] == false).count();
            assert_eq!(warm, FRAMES - 4);
        }
        if drawn && !stamps {
            skip("a_trace_is_json_with_nested_events_on_both_sides", &format!("{} has no timestamps", gpu.describe()))?;
        }
        if stamps {
            for (cpu, on_gpu) in of(1, 1).into_iter().zip(of(2, 1)) {
                let (submitted, begun) = (span(cpu).ok_or("no times")?.1, span(on_gpu).ok_or("no times")?.0);
                assert!(submitted <= begun + 0.002, "no frame begins before it was submitted: {submitted} {begun}");
            }
        }
        let named = events.iter().filter(|e| e["ph"] == "M").count();
        assert_eq!(named, 6, "tracks have names");
        Ok(())
    })
}

#[test]
fn no_trace_is_recorded_by_default() -> TestResult {
    let gpu = framegraph_wgpu::Gpu::noop()?;
    let mut bench = Bench::new(&gpu, 8, 8);
    bench.executor.set_timing(true);
    bench.run(declare)?;
    assert!(bench.executor.timing().trace().is_none());
    assert!(bench.executor.timing().wgpu().is_none(), "the first frames are left out");
    for _ in 0..6 {
        bench.run(declare)?;
    }
    let (inside, whole) = (bench.executor.timing().wgpu(), bench.executor.timing().frame().cpu);
    let (inside, whole) = (inside.ok_or("no share")?, whole.ok_or("no time")?);
    assert!(inside.count == 3 && inside.min_ms > 0.0 && inside.median_ms <= whole.median_ms, "{inside:?} {whole:?}");
    Ok(())
}
