//! Executors after frames and preparations that fail.

use crate::bench::{FRAME, TestResult, device, frames, planned};
use framegraph::Options;
use framegraph_vulkan::Executor;
use framegraph_vulkan::testing::{self, Mock};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A recorder that panics leaves an executor that can execute and prepare.
#[test]
fn executors_recover_from_recorders_that_panic() -> TestResult {
    let Some(device) = device("executors_recover_from_recorders_that_panic") else { return Ok(()) };
    let (_, graph) = frames()?.swap_remove(0);
    let plan = planned(&device, &graph, &Options::for_frame(FRAME[0], FRAME[1]), |_| {})?;
    for prepares in [false, true] {
        let (mut executor, mut mock) = (Executor::new(device.gpu())?, Mock { kit: testing::Kit::new(device.gpu()) });
        let imports = testing::imports(&mut mock.kit, &plan)?;
        executor.execute(&plan, &imports, |cx| mock.record(cx))?;
        let mut passes = 0;
        let frame = AssertUnwindSafe(|| {
            executor.execute(&plan, &imports, |cx| {
                passes += 1;
                assert!(passes < 2, "planted");
                mock.record(cx)
            })
        });
        assert!(catch_unwind(frame).is_err());
        // The pipelines belong to render passes of the earlier preparation.
        mock.kit.reset();
        if prepares {
            executor.prepare(&plan, None)?;
        }
        let imports = testing::imports(&mut mock.kit, &plan)?;
        for _ in 0..3 {
            executor.execute(&plan, &imports, |cx| mock.record(cx))?;
        }
        executor.wait()?;
        assert_eq!(executor.executed(), plan.counts());
        assert_eq!(device.messages(), [""; 0]);
    }
    Ok(())
}

/// The error of the recorder is returned, and the next frame is complete.
#[test]
fn executors_recover_from_recorders_that_fail() -> TestResult {
    let Some(device) = device("executors_recover_from_recorders_that_fail") else { return Ok(()) };
    let (_, graph) = frames()?.swap_remove(0);
    let plan = planned(&device, &graph, &Options::for_frame(FRAME[0], FRAME[1]), |_| {})?;
    let (mut executor, mut mock) = (Executor::new(device.gpu())?, Mock { kit: testing::Kit::new(device.gpu()) });
    let imports = testing::imports(&mut mock.kit, &plan)?;
    let failed = executor.execute(&plan, &imports, |_| Err("planted".into()));
    assert!(failed.is_err_and(|error| error.to_string().contains("planted")));
    executor.execute(&plan, &imports, |cx| mock.record(cx))?;
    executor.wait()?;
    assert_eq!(executor.executed(), plan.counts());
    assert_eq!(device.messages(), [""; 0]);
    Ok(())
}
