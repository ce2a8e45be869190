//! Inspection of random graphs: every listed target can be inspected.

use crate::bench::TestResult;
use framegraph::{Options, Plan, Scratch, compile, dump};
use framegraph_check::generate::{self, Entropy, Profile};
use framegraph_wgpu::inspect::{InspectError, Inspector, all_targets};
use framegraph_wgpu::{ExecuteError, Executor, Gpu};
use framegraph_wgpu::{Frame, mock};

/// Random graphs with mock recorders, on the device that validates all calls.
#[test]
fn every_target_of_random_graphs_can_be_inspected() -> TestResult {
    let gpu = Gpu::noop()?;
    let (mut inspector, mut seen, mut beyond) = (Inspector::new(&gpu), 0, 0);
    for seed in 0..100 {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let options = Options { frame: generate::FRAME, ..generate::options_of(seed as u32) };
        let mut plan = Plan::new();
        if compile(&graph, &gpu.caps(), &options, &mut Scratch::new(), &mut plan).is_err() {
            beyond += 1;
            continue;
        }
        let mut frame = Frame::<()>::from_graph(graph);
        mock::add_recorders(&mut frame);
        let Ok(imported) = mock::imports(&gpu, &plan) else {
            beyond += 1;
            continue;
        };
        let mut executor = Executor::new(&gpu);
        // The device does not support a resource, or wgpu does not support a step of the plan.
        if executor.execute(&plan, &frame, &(), &imported.bound).is_err() {
            beyond += 1;
            continue;
        }
        let text = dump::text(&plan);
        for what in all_targets(&plan) {
            let title = what.title();
            match inspector.inspect_target(&executor, &plan, &frame, &(), &imported.bound, what) {
                Ok(found) => {
                    let [width, height] = found.texels.size;
                    assert_eq!(found.texels.bits.len(), (width * height) as usize, "seed {seed}, {title}");
                    seen += 1;
                }
                // The texture must allow sampling for the inspection, which its format or sample count may not support.
                Err(InspectError::Execute { error, .. }) if matches!(*error, ExecuteError::Unsupported(_)) => {
                    beyond += 1;
                }
                Err(error) => return Err(format!("seed {seed}, {title}: {error}").into()),
            }
        }
        assert_eq!(dump::text(&plan), text);
    }
    println!("{seen} parts were seen, {beyond} graphs or parts ask for more than the device has");
    assert!(seen > 300 && beyond * 4 < seen, "{seen} seen, {beyond} beyond");
    Ok(())
}
