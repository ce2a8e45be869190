//! Culling: the passes that are kept, and the reasons.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

fn verdict(plan: &Plan, pass: &str) -> Reason {
    let id = plan.graph().find_pass(pass).expect("the pass was declared");
    plan.verdict(id).expect("every pass has a verdict")
}

#[test]
fn culling_cascades_and_says_why() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let a = g.add_fn("first", |p| p.color(a, BLACK)).unwrap();
    let b = filter(&mut g, "second", a, Format::R8Unorm);
    let _ = filter(&mut g, "third", b, Format::R8Unorm);
    let kept = filter(&mut g, "kept", a, Format::R8Unorm);
    g.export(kept).unwrap();
    let plan = plan(&g, &wgpu());
    let id = |name| g.find_pass(name).unwrap();
    let res = |name| g.find_resource(name).unwrap();
    assert_eq!(verdict(&plan, "third"), Reason::CulledUnread(res("third_out")));
    assert_eq!(verdict(&plan, "second"), Reason::CulledReaderCulled(res("second_out"), id("third")));
    assert_eq!(verdict(&plan, "kept"), Reason::KeptExport(res("kept_out")));
    assert_eq!(verdict(&plan, "first"), Reason::KeptReadBy(res("a"), id("kept")));
    assert_eq!(placement(&plan, "second_out"), Placement::Unused);
}

#[test]
fn what_is_written_over_is_dropped() {
    let mut g = Graph::new();
    let screen = screen(&mut g);
    let screen = g.add_fn("loading_screen", |p| p.color(screen, BLACK)).unwrap();
    g.add_fn("scene", |p| p.color(screen, BLACK)).unwrap();
    let plan = plan(&g, &wgpu());
    let (scene, screen) = (g.find_pass("scene").unwrap(), g.find_resource("screen").unwrap());
    assert_eq!(verdict(&plan, "loading_screen"), Reason::CulledOverwritten(screen, scene));
    assert_eq!(verdict(&plan, "scene"), Reason::KeptImport(screen));
}

#[test]
fn side_effects_keep_what_they_read_alive_until_they_run() {
    // An error of another render graph: a resource read only by a pass with a side effect was freed before that pass.
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let a = g.add_fn("draw", |p| p.color(a, BLACK)).unwrap();
    let b = g.texture("b", hdr());
    let b = g.add_fn("between", |p| p.color(b, BLACK)).unwrap();
    g.export(b).unwrap();
    g.add_fn("query", |p| {
        p.side_effect();
        p.sampled(a).map(drop)
    })
    .unwrap();
    let plan = plan(&g, &wgpu());
    assert_eq!(verdict(&plan, "query"), Reason::KeptSideEffect);
    let row = plan.resources()[g.find_resource("a").unwrap().index()];
    assert_eq!(row.last, plan.pass_steps()[g.find_pass("query").unwrap().index()]);
}

#[test]
fn a_dead_writer_does_not_hide_a_live_one() {
    // `dead` overwrites only level 1, which no pass reads; level 0 of `base` is still used.
    let mut g = Graph::new();
    let t = g.texture("t", hdr().mips(2));
    let t = g.add_fn("base", |p| p.color(t.mip(0), Intent::Overwrite)).unwrap();
    let t = g.add_fn("dead", |p| p.color(t.mip(1), Intent::Overwrite)).unwrap();
    let out = g
        .add_fn("read", |p| {
            p.sampled(t.mip(0))?;
            let out = p.texture("out", hdr());
            p.color(out, Intent::Overwrite)
        })
        .unwrap();
    g.export(out).unwrap();
    let plan = plan(&g, &wgpu());
    assert!(matches!(verdict(&plan, "dead"), Reason::CulledUnread(_)));
    assert!(matches!(verdict(&plan, "base"), Reason::KeptReadBy(..)));
}

#[test]
fn a_write_into_a_discarded_import_that_nobody_reads_is_culled() {
    // The pass that would read it is disabled; `both` has a second output and is kept.
    let mut g = Graph::new();
    let [a, b] = ["a", "b"].map(|n| g.import_texture(n, hdr(), Entry::Undefined, Exit::Discard));
    g.add_fn("alone", |p| p.color(a, BLACK)).unwrap();
    let out = screen(&mut g);
    g.add_fn("both", |p| {
        p.color(b, BLACK)?;
        p.color(out, BLACK)
    })
    .unwrap();
    let plan = plan(&g, &wgpu());
    assert_eq!(check(&plan), Ok(()));
    let id = g.find_resource("a").unwrap();
    assert_eq!(verdict(&plan, "alone"), Reason::CulledUnread(id));
    assert_eq!(ops(&plan, "b"), [(LoadOp::Clear, StoreOp::Discard)]);
}

#[test]
fn culling_off_keeps_everything() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let _ = g.add_fn("alone", |p| p.color(a, BLACK)).unwrap();
    let plan = plan_with(&g, &wgpu(), &Options { cull: false, ..options() });
    assert_eq!((plan.counts().passes, plan.counts().culled), (1, 0));
    assert_eq!(verdict(&plan, "alone"), Reason::KeptCullingOff);
}

#[test]
fn a_history_keeps_its_writer_and_reads_the_frame_before() {
    let mut g = Graph::new();
    let history = g.history("taa", hdr(), 1);
    let before = g.previous(history, 1).unwrap();
    g.add_fn("taa", |p| {
        p.sampled(before)?;
        p.color(history, Intent::Overwrite)
    })
    .unwrap();
    let plan = plan(&g, &wgpu());
    assert!(matches!(verdict(&plan, "taa"), Reason::KeptHistory(_)));
    assert_eq!(placement(&plan, "taa"), Placement::Own);
    let texels = u64::from(FRAME[0] * FRAME[1]);
    assert_eq!(plan.memory().own_bytes, 2 * 8 * texels, "two history images");
    assert!(g.previous(history, 2).is_err());
}
