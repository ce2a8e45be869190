//! Whole frames: validation is silent, counts are those of the plan, and contents do not depend on the plan.

use crate::bench::{FRAME, TestResult, assert_contents, device, device_with, frames, planned, run};
use framegraph::{Alias, Caps, Options};
use framegraph_vulkan::Synchronization;

#[test]
fn frames_are_executed_silently_with_the_counts_of_their_plans() -> TestResult {
    let Some(device) = device("frames_are_executed_silently_with_the_counts_of_their_plans") else { return Ok(()) };
    for (name, graph) in frames()? {
        let options = Options::for_frame(FRAME[0], FRAME[1]);
        let plain = planned(&device, &graph, &options.immediate(), |_| {})?;
        let expected = run(&device, &plain, None, None, 3)?;
        assert!(expected.messages.is_empty(), "{name}, immediate: {}", expected.messages[0]);
        assert!(!expected.contents.is_empty(), "{name}");
        for alias in [Alias::Heap, Alias::Pool, Alias::Off] {
            // Transient attachments are used even if the device has no lazily allocated memory.
            let memoryless = |caps: &mut Caps| (caps.memoryless, caps.memoryless_layers) = (true, true);
            let plan = planned(&device, &graph, &Options { alias, ..options }, memoryless)?;
            let ran = run(&device, &plan, None, None, 3)?;
            assert!(ran.messages.is_empty(), "{name}, {alias:?}: {}", ran.messages[0]);
            assert_eq!(ran.executor.executed(), plan.counts(), "{name}, {alias:?}");
            assert_eq!(ran.executor.barriers(), plan.barriers().len() as u64, "{name}, {alias:?}");
            assert_eq!(ran.executor.step_times_us().len(), plan.steps().len(), "{name}, {alias:?}");
            assert_contents(&expected, &ran, 1, &format!("{name}, {alias:?}"));
            let memory = ran.executor.memory();
            // Other frames keep nearly everything in the tile or in shadow maps.
            assert!(
                alias == Alias::Off || name != "deferred" || memory.saved_bytes() > 0,
                "{name}, {alias:?}: {memory:?}"
            );
            println!(
                "{name}, {alias:?}: {} steps, {} passes; {} of {} KiB saved",
                plan.steps().len(),
                plan.counts().passes,
                memory.saved_bytes() >> 10,
                memory.unshared_bytes >> 10
            );
        }
    }
    Ok(())
}

#[test]
fn barriers_of_vulkan_1_0_are_enough() -> TestResult {
    let test = "barriers_of_vulkan_1_0_are_enough";
    let Some(device) = device_with(test, Synchronization::Legacy) else { return Ok(()) };
    for (name, graph) in frames()? {
        let options = Options { alias: Alias::Heap, ..Options::for_frame(FRAME[0], FRAME[1]) };
        let plan = planned(&device, &graph, &options, |_| {})?;
        let ran = run(&device, &plan, None, None, 2)?;
        assert!(ran.messages.is_empty(), "{name}: {}", ran.messages[0]);
    }
    Ok(())
}
