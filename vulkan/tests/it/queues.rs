//! Frames on two queues.

use crate::bench::{FRAME, TestResult, assert_contents, device, frames, planned, run};
use framegraph::{Alias, Options, Plan};
use framegraph_queues::{Command, PlanStream, QueueId, QueueLayout, Schedule, schedule};
use framegraph_vulkan::testing::TestDevice;

/// Returns a plan without aliasing and its schedule on two queues.
fn scheduled(device: &TestDevice, graph: &framegraph::Graph) -> TestResult<(Plan, Schedule)> {
    let options = Options { alias: Alias::Off, ..Options::for_frame(FRAME[0], FRAME[1]) };
    let plan = planned(device, graph, &options, |_| {})?;
    let costs: Vec<f64> = (0..plan.steps().len()).map(|step| (step * 101) as f64 % 400.0).collect();
    let found = schedule(&plan, &QueueLayout::async_compute(), &costs)?;
    Ok((plan, found))
}

#[test]
fn frames_on_two_queues_are_silent_and_have_the_contents_of_one() -> TestResult {
    let Some(device) = device("frames_on_two_queues_are_silent_and_have_the_contents_of_one") else { return Ok(()) };
    let mut elsewhere = 0;
    for (name, graph) in frames()? {
        let (plan, found) = scheduled(&device, &graph)?;
        let expected = run(&device, &plan, None, None, 3)?;
        let memory = device.gpu().share_memory(&plan, &found)?;
        assert_eq!(framegraph_queues::check_memory(&plan, &found, &memory), []);
        for commands in [plan.stream_on(&found), plan.stream_in(&found, &memory)] {
            let ran = run(&device, &plan, Some(&found), Some(commands), 3)?;
            assert!(ran.messages.is_empty(), "{name}: {}", ran.messages[0]);
            assert_contents(&expected, &ran, 0, name);
            let moved = found.lanes.iter().filter(|lane| **lane != QueueId::MAIN).count();
            println!("{name}: {moved} steps on the second queue, {} submissions", ran.executor.submissions());
            assert!(moved == 0 || ran.executor.submissions() > 3, "{name}");
            elsewhere += moved;
        }
    }
    assert!(elsewhere > 4, "{elsewhere}");
    Ok(())
}

/// A missing ownership transfer is an error when the plan is prepared. Missing aliasing barriers are reported by the
/// layers.
#[test]
fn missing_transfers_and_aliasing_barriers_are_detected() -> TestResult {
    let Some(device) = device("missing_transfers_and_aliasing_barriers_are_detected") else { return Ok(()) };
    let (mut transfers, mut aliasing) = (0, 0);
    for (_, graph) in frames()? {
        let (plan, found) = scheduled(&device, &graph)?;
        let commands = plan.stream_on(&found);
        for left in 0..found.transfers.len() as u32 {
            let kept = |c: &&Command| !matches!(c, Command::Acquire { transfer, .. } if *transfer == left);
            let without = commands.iter().filter(kept).copied().collect();
            // The last owner is not asked again in this frame.
            if found.transfers[left as usize].to.1.is_none() {
                continue;
            }
            let refused = run(&device, &plan, Some(&found), Some(without), 1).err().map(|error| error.to_string());
            assert!(refused.is_some_and(|text| text.contains("owns it")), "transfer {left}");
            transfers += 1;
        }
        let memory = device.gpu().share_memory(&plan, &found)?;
        let is_first = |barrier: u32| plan.barriers()[barrier as usize].after.is_none();
        let alone = |command: &Command| match *command {
            Command::AliasingBarrier { .. } => None,
            Command::Barrier { queue, barrier, .. } if is_first(barrier) => {
                Some(Command::Barrier { queue, barrier, behind_semaphore: false })
            }
            other => Some(other),
        };
        let all = plan.stream_in(&found, &memory);
        let alone: Vec<_> = all.iter().filter_map(alone).collect();
        let ran = run(&device, &plan, Some(&found), Some(alone), 1)?;
        aliasing += usize::from(ran.messages.iter().any(|message| message.contains("SYNC-HAZARD")));
    }
    println!("{transfers} missing transfers refused; {aliasing} frames without aliasing barriers reported");
    assert!(aliasing > 0);
    Ok(())
}
