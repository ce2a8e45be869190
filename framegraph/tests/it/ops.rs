//! Loads and stores of contents that are not used: blending without a use of the result, and depth that is sampled
//! while tested.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

/// Use of the second attachment of a pass that blends into it.
#[derive(Clone, Copy, PartialEq)]
enum After {
    Nothing,
    Exported,
    Averaged,
    AveragedInVain,
}

/// Returns a frame where `velocity` draws into a texture. `particles` blends into it and draws the exported texture.
fn blending(after: After, samples: u8) -> Graph {
    let mut g = Graph::new();
    let screen = g.texture("screen", color(Format::Rgba8Unorm).samples(samples));
    let flow = g.texture("flow", color(Format::Rg16Float).samples(samples));
    let flow = g.add_fn("velocity", |p| p.color(flow, BLACK)).unwrap();
    let (screen, flow, average) = g
        .add_fn("particles", |p| {
            p.blends();
            let screen = p.color(screen, BLACK)?;
            let flow = p.color(flow, Intent::Modify)?;
            let average = p.texture("average", color(Format::Rg16Float));
            let resolves = matches!(after, After::Averaged | After::AveragedInVain);
            let average = if resolves { p.resolve(flow, average)? } else { average };
            Ok((screen, flow, average))
        })
        .unwrap();
    g.export(screen).unwrap();
    if after == After::Averaged {
        g.export(average).unwrap();
    }
    if after == After::Exported {
        g.export(flow).unwrap();
    }
    g
}

fn orders() -> [Options; 2] {
    [Order::Declared, Order::Optimized].map(|order| Options { order, ..options() })
}

#[test]
fn blending_in_vain_keeps_nobody_alive_and_loads_nothing() {
    for options in orders() {
        let graphs = [blending(After::Nothing, 1), blending(After::AveragedInVain, 4)];
        for (graph, caps) in graphs.iter().flat_map(|g| [(g, wgpu()), (g, Caps::tiler())]) {
            let plan = plan_with(graph, &caps, &options);
            let (flow, velocity, particles) = {
                let g = plan.graph();
                let pass = |name| g.find_pass(name).unwrap();
                (g.find_resource("flow").unwrap(), pass("velocity"), pass("particles"))
            };
            assert_eq!(plan.verdict(velocity), Some(Reason::CulledOverwritten(flow, particles)));
            assert_eq!(ops(&plan, "flow"), [(LoadOp::Clear, StoreOp::Discard)], "{}", dump::text(&plan));
            let attachment = plan.attachments().iter().find(|a| a.resource == flow).unwrap();
            assert_eq!(attachment.clear, Attachment::ZERO);
            let step = plan.pass_steps()[particles.index()];
            assert_eq!(plan.reasons(Subject::Load(step, flow)).next(), Some(Reason::ClearUnneeded));
            assert_eq!((plan.counts().clears, plan.counts().unresolves), (2, 0));
            let report = check::examine(&plan);
            assert!(report.is_clean(), "{report}");
        }
    }
}

#[test]
fn what_is_blended_for_somebody_is_loaded() {
    for options in orders() {
        // Devices that merge the two passes are excluded, because they load nothing.
        let apart = Options { merge: false, ..options };
        for (after, samples) in [(After::Exported, 1), (After::Averaged, 4)] {
            let plan = plan_with(&blending(after, samples), &wgpu(), &apart);
            let (load, _) = ops(&plan, "flow")[1];
            assert_eq!((plan.counts().culled, load), (0, LoadOp::Load), "{}", dump::text(&plan));
            assert!(check::examine(&plan).is_clean());
        }
    }
}

/// Depth influences what is drawn, so it is loaded although no later pass reads it.
#[test]
fn depth_that_is_tested_in_vain_is_loaded() {
    let mut g = Graph::new();
    let (screen, z) = (screen(&mut g), g.texture("z", depth()));
    let z = g.add_fn("prepass", |p| p.depth(z, FAR)).unwrap();
    g.add_fn("draw", |p| {
        p.color(screen, BLACK)?;
        p.depth(z, Intent::Modify).map(drop)
    })
    .unwrap();
    let plan = plan_with(&g, &wgpu(), &Options { merge: false, ..options() });
    assert_eq!(ops(&plan, "z"), [(LoadOp::Clear, StoreOp::Store), (LoadOp::Load, StoreOp::Discard)]);
}

/// Returns a frame where the last user of depth tests it and, if `sampled`, also samples it.
fn soft_particles(sampled: bool) -> Graph {
    let mut g = Graph::new();
    let (screen, z) = (screen(&mut g), g.texture("z", depth()));
    let (screen, z) = g.add_fn("draw", |p| Ok((p.color(screen, BLACK)?, p.depth(z, FAR)?))).unwrap();
    g.add_fn("particles", |p| {
        p.depth_read_only(z)?;
        if sampled {
            p.sampled(z)?;
        }
        p.color(screen, Intent::Modify)
    })
    .unwrap();
    g
}

#[test]
fn what_is_read_beside_the_depth_test_is_left_in_memory() {
    for options in orders() {
        let apart = Options { merge: false, ..options };
        for (sampled, store, discards) in [(true, StoreOp::None, 0), (false, StoreOp::Discard, 1)] {
            let plan = plan_with(&soft_particles(sampled), &wgpu(), &apart);
            assert_eq!(ops(&plan, "z"), [(LoadOp::Clear, StoreOp::Store), (LoadOp::Load, store)]);
            assert_eq!(plan.counts().discards, discards);
            let z = plan.graph().find_resource("z").unwrap();
            let step = plan.step_ids().nth(1).unwrap();
            let reason = if sampled { Reason::StoreUnchanged } else { Reason::DiscardUnread };
            assert_eq!(plan.reasons(Subject::Store(step, z)).next(), Some(reason));
            assert!(check::examine(&plan).is_clean());
        }
    }
}
