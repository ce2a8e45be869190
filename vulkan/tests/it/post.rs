//! The example `vulkan_post`: its picture, counts, subpasses and queues.

#[path = "../../examples/vulkan_post/post.rs"]
mod frame;

use crate::bench::{TestResult, device};

#[test]
fn post_processing_is_a_subpass_and_its_picture_is_the_reference() -> TestResult {
    let Some(device) = device("post_processing_is_a_subpass_and_its_picture_is_the_reference") else { return Ok(()) };
    for samples in [1, 4] {
        let report = frame::run(&device, samples)?;
        let messages = device.messages();
        assert!(messages.is_empty(), "{samples}: {}", messages[0]);
        assert!(report.difference <= 1, "{samples}: {}", report.difference);
        assert_eq!(report.counts, report.planned, "{samples}");
        assert!(report.times_us.iter().flatten().all(|time| *time > 0.0), "{samples}: {:?}", report.times_us);
        assert_eq!((report.counts.passes, report.counts.steps, report.subpasses), (5, 4, 2), "{samples}");
        assert_eq!(report.moved, 1, "ambient occlusion runs on the second queue");
        let memory = report.memory;
        assert!(memory.allocated_bytes <= memory.unshared_bytes && memory.unshared_bytes > 0, "{samples}: {memory:?}");
        // Depth, shadow and the picture are stored; color never leaves the tile.
        assert_eq!((report.counts.unresolves, report.counts.resolves), (0, 3), "{samples}");
    }
    Ok(())
}
