//! Draws a small frame on Vulkan at one and at four samples, and prints its cost. Color and post-processing are two
//! subpasses of one render pass. Ambient occlusion runs on a second queue.
//!
//! `cargo run -p framegraph-vulkan --example vulkan_post --features testing`

mod post;

use framegraph_vulkan::testing::{DeviceRequest, TestDevice};
use program::line;

fn main() -> std::process::ExitCode {
    let request = DeviceRequest { layers: false, ..DeviceRequest::default() };
    let drawn = TestDevice::open(request).map_err(|error| -> Box<dyn std::error::Error> { error }).and_then(|device| {
        line(format_args!("{}, {} distinct queues", device.gpu().name(), device.distinct_queues));
        [1, 4].into_iter().try_for_each(|samples| {
            let report = post::run(&device, samples)?;
            line(format_args!(
                "{samples} samples: {} passes in {} steps, {} on the second queue, {} subpasses in the last step",
                report.counts.passes, report.counts.steps, report.moved, report.subpasses
            ));
            let memory = report.memory;
            line(format_args!(
                "  memory: {} B without sharing, {} B allocated, {} B lazily allocated with {} B committed",
                memory.unshared_bytes, memory.allocated_bytes, memory.lazy_bytes, memory.lazy_committed_bytes
            ));
            line(format_args!("  {} loads, {} stores", report.counts.unresolves, report.counts.resolves));
            let [[one, two], [modeled_one, modeled_two]] = report.times_us;
            line(format_args!("  time: {one:.0} µs on one queue, {two:.0} µs on two; simulated {modeled_one:.0} and {modeled_two:.0} µs"));
            line(format_args!("  largest difference from the reference: {} of 255", report.difference));
            if report.difference > 1 || report.counts != report.planned {
                Err("the picture is wrong".into())
            } else {
                Ok(())
            }
        })
    });
    program::ended("vulkan_post", drawn.map_err(|error: Box<dyn std::error::Error>| error.to_string()))
}
