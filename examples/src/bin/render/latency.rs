//! Latency from input to picture by the number of queued frames.

use crate::args::Args;
use crate::run::{Failure, Prepared, WARM_UP, device, executed};
use crate::table::aligned;
use framegraph::Plan;
use framegraph_passes::{FrameIndex, ViewId};
use framegraph_wgpu::{Executor, FramesInFlight};
use std::num::NonZeroU32;
use std::time::Instant;

/// Renders the frame with at most one, two and three queued frames, and formats latencies and frame times.
///
/// Latency is the time from the start of a frame until the device has completed it.
///
/// # Errors
/// One line with the error of the device.
pub fn table(args: &Args, prepared: &mut Prepared, plan: &Plan, executor: &mut Executor) -> Result<String, Failure> {
    let mut rows = vec![["frames queued", "latency p25", "median", "frame to frame"].map(String::from)];
    for max in (1..=3).filter_map(NonZeroU32::new) {
        let mut flight = FramesInFlight::new(&prepared.gpu);
        flight.set_max(max);
        let begun = Instant::now();
        for index in 0..args.frames {
            flight.begin().map_err(device)?;
            prepared.world.frame_index = FrameIndex(WARM_UP + index);
            if let Some(taa) = &prepared.settings.taa {
                prepared.world.views.again(ViewId::MAIN, taa.jitter_px(index)).map_err(device)?;
            }
            let drawn = executor.execute(plan, &prepared.frame, &prepared.world, &prepared.imports);
            flight.submitted(drawn.map_err(executed)?);
        }
        prepared.gpu.wait().map_err(device)?;
        let each_ms = begun.elapsed().as_secs_f64() * 1e3 / f64::from(args.frames.max(1));
        flight.begin().map_err(device)?;
        let [p25, median] = match flight.latency() {
            Some(latency) => [latency.p25_ms, latency.median_ms].map(|ms| format!("{ms:.3}")),
            None => ["-"; 2].map(String::from),
        };
        rows.push([max.to_string(), p25, median, format!("{each_ms:.3}")]);
    }
    Ok(format!("\nmilliseconds, from the start of a frame until the device has completed it\n{}", aligned(&rows, 1)))
}
