//! Planted faults are detected.

use crate::bench::{FRAME, TestResult, device, frames, planned, run};
use framegraph::{Alias, Options};
use framegraph_queues::{Command, PlanStream};

/// Each barrier is left out alone, of one in three barriers in ordinary runs. Without it, the layers report a hazard or a
/// wrong layout, except between accesses in one state.
#[test]
fn barriers_that_are_left_out_are_reported() -> TestResult {
    let Some(device) = device("barriers_that_are_left_out_are_reported") else { return Ok(()) };
    let (mut all, mut reported, mut layouts) = (0, 0, 0);
    for (name, graph) in frames()? {
        let options = Options { alias: Alias::Off, ..Options::for_frame(FRAME[0], FRAME[1]) };
        let plan = planned(&device, &graph, &options, |_| {})?;
        let commands = plan.stream();
        let silent = run(&device, &plan, None, None, 1)?.messages;
        assert!(silent.is_empty(), "{name}: {}", silent[0]);
        for left in test_report::share(0..plan.barriers().len() as u32) {
            let kept = |c: &&Command| !matches!(c, Command::Barrier { barrier, .. } if *barrier == left);
            let without = commands.iter().filter(kept).copied().collect();
            let ran = run(&device, &plan, None, Some(without), 1)?;
            let row = &plan.barriers()[left as usize];
            // Older layers accept two accesses to storage, or to an attachment, in one layout without a barrier.
            assert!(row.from == row.to || !ran.messages.is_empty(), "{name}: barrier {left} is not missed: {row:?}");
            let of = |text: &str| ran.messages.iter().any(|message| message.contains(text));
            (all, reported) = (all + 1, reported + usize::from(!ran.messages.is_empty()));
            layouts += usize::from(of("layout") || of("Layout"));
        }
    }
    println!("{reported} of {all} missing barriers are reported, {layouts} as wrong layouts");
    assert!(all >= 10 && layouts > 0 && reported > all / 2, "{reported} of {all}, {layouts}");
    Ok(())
}
