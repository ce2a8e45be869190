//! Step times arrive without waiting, after the warm-up, and only for the current plan.

use crate::bench::{Bench, TestResult, fill_full, on_adapter, skip};
use framegraph::{DeclareError, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::{Frame, Times};

fn declare(frame: &mut Frame, name: &str) -> Result<Texture, DeclareError> {
    let target = frame.graph_mut().texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
    let target = frame.add_fn(name, |p| p.color(target, Intent::Overwrite), |_, (), cx| fill_full(cx, [0.5; 4]))?;
    frame.graph_mut().export(target)?;
    Ok(target)
}

#[test]
fn steps_are_timed_on_cpu_and_gpu() -> TestResult {
    on_adapter("steps_are_timed_on_cpu_and_gpu", |gpu| {
        let mut bench = Bench::new(gpu, 256, 256);
        bench.run(|f| declare(f, "fill"))?;
        let step = bench.plan.step_ids().next().ok_or("no step")?;
        assert_eq!(bench.executor.timing().step(step), Times::default(), "off by default");
        bench.executor.set_timing(true);
        for _ in 0..20 {
            bench.run(|f| declare(f, "fill"))?;
        }
        gpu.wait()?;
        let times = bench.executor.catch_up()?.step(step);
        let cpu = times.cpu.ok_or("no CPU time")?;
        assert_eq!(cpu.count, 16, "the first four frames are left out");
        assert!(cpu.min_ms > 0.0 && cpu.min_ms <= cpu.p25_ms && cpu.p25_ms <= cpu.median_ms, "{cpu:?}");
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return skip("steps_are_timed_on_cpu_and_gpu", &format!("{} has no timestamps", gpu.describe()));
        }
        let on_gpu = times.gpu.ok_or("no GPU time")?;
        assert!(on_gpu.count > 0 && on_gpu.min_ms > 0.0 && on_gpu.median_ms < 10_000.0, "{on_gpu:?}");
        let whole = bench.executor.timing().frame().gpu.ok_or("no time of the frame")?;
        assert!(whole.min_ms >= on_gpu.min_ms, "one step is the frame: {whole:?} {on_gpu:?}");
        bench.run(|f| declare(f, "another name"))?;
        let after = bench.executor.timing().step(step);
        assert_eq!((after.gpu, after.cpu), (None, None), "another plan starts anew");
        Ok(())
    })
}
