//! Resolves by mode and of depth: while storing if the device supports it, otherwise with a full-screen pass in the
//! plan.

use super::{clean, usage};
use crate::support::*;
use framegraph::*;
use framegraph_check::check;

/// Returns a graph that draws color and depth with four samples, resolves depth with `mode`, and reads it.
fn resolved_depth(mode: ResolveMode) -> Graph {
    let mut g = Graph::new();
    let [samples, one] =
        [depth().samples(4), depth()].map(|d| g.texture(if d.samples == 4 { "samples" } else { "one" }, d));
    let one = g
        .add_fn("draw", |p| {
            let drawn = p.depth(samples, FAR)?;
            p.resolve_as(mode, drawn, one)
        })
        .unwrap();
    let out = filter(&mut g, "fog", one, Format::Rgba16Float);
    g.export(out).unwrap();
    g
}

/// Returns the joins of the passes of each step.
fn joins(plan: &Plan) -> Vec<Vec<Join>> {
    plan.step_ids().map(|s| plan.passes_of(s).iter().map(|m| m.join).collect()).collect()
}

#[test]
fn depth_is_resolved_in_the_store_and_its_samples_take_no_memory() {
    let plan = clean(&resolved_depth(ResolveMode::Sample0), &Caps::tiler());
    assert_eq!(steps(&plan), [["draw"], ["fog"]]);
    assert_eq!(placement(&plan, "samples"), Placement::Memoryless);
    assert_eq!(ops(&plan, "samples"), [(LoadOp::Clear, StoreOp::Discard)]);
    assert_eq!(ops(&plan, "one"), [(LoadOp::DontCare, StoreOp::Store)]);
    assert_eq!(plan.attachments()[1].role, Role::ResolveDepth(ResolveMode::Sample0));
    let (counts, texels) = (plan.counts(), u64::from(FRAME[0] * FRAME[1]));
    assert_eq!((counts.passes, counts.multisample_resolves), (2, 1));
    assert_eq!(plan.traffic(FRAME).multisample_resolve_bytes, texels * 4);
    // Depth is resolved in the color output stage, so the next use of the samples must wait for it.
    let depth = plan.graph().find_resource("one").unwrap();
    let fog = plan.barriers().iter().find(|b| b.resource == depth && b.to == State::Sampled).unwrap();
    assert_eq!(fog.from_stages, Stages::COLOR);
}

#[test]
fn without_a_resolve_in_the_store_the_plan_has_a_full_screen_pass() {
    let texels = u64::from(FRAME[0] * FRAME[1]);
    for (caps, mode) in [
        (wgpu(), ResolveMode::Sample0),
        (Caps::tiler(), ResolveMode::Max),
        (Caps { depth_resolves: ResolveModes::NONE, ..Caps::desktop() }, ResolveMode::Min),
    ] {
        let plan = clean(&resolved_depth(mode), &caps);
        assert_eq!(joins(&plan), [[Join::First], [Join::Resolve], [Join::First]]);
        assert_eq!(steps(&plan), [["draw"], ["draw"], ["fog"]]);
        let [draw, one] = ["draw", "one"].map(|name| (plan.graph().find_pass(name), plan.graph().find_resource(name)));
        let (draw, one) = (draw.0.unwrap(), one.1.unwrap());
        let first = plan.step_ids().next().unwrap();
        assert_eq!(plan.pass_steps()[draw.index()], first);
        assert!(plan.reasons(Subject::Pass(draw)).any(|r| r == Reason::ResolvePass(one)));
        // The samples are stored, read and need memory; nothing is loaded.
        let samples = plan.graph().find_resource("samples").unwrap();
        let stored: Vec<_> = plan.reasons(Subject::Store(first, samples)).collect();
        assert_eq!(stored, [Reason::StoreResolved(draw)]);
        assert_eq!(ops(&plan, "samples"), [(LoadOp::Clear, StoreOp::Store)]);
        assert_eq!(ops(&plan, "one"), [(LoadOp::DontCare, StoreOp::Store)]);
        assert_eq!(usage(&plan, "samples"), Usage::ATTACHMENT.union(Usage::SAMPLED));
        let (counts, traffic) = (plan.counts(), plan.traffic(FRAME));
        assert_eq!((counts.passes, counts.steps, counts.multisample_resolves), (2, 3, 0));
        assert_eq!((traffic.loaded_bytes, traffic.stored_bytes), (0, texels * (4 * 4 + 4 + 8)));
        let text = dump::text(&plan);
        assert!(text.contains("pass draw (full-screen resolve)\n      read sampled samples\n    depth: one"), "{text}");
    }
}

#[test]
fn colors_are_resolved_by_mode() {
    for (mode, format, full_screen) in [
        (ResolveMode::Average, Format::Rgba16Float, false),
        (ResolveMode::Sample0, Format::Rgba16Float, true),
        (ResolveMode::Max, Format::R32Uint, true),
    ] {
        let mut g = Graph::new();
        let (samples, one) = (g.texture("samples", color(format).samples(4)), g.texture("one", color(format)));
        let declare = |p: &mut PassBuilder<'_>| {
            let drawn = p.color_at(2, samples, Intent::Overwrite)?;
            p.resolve_as(mode, drawn, one)
        };
        let one = g.add_fn("draw", declare).unwrap();
        g.export(one).unwrap();
        let plan = clean(&g, &wgpu());
        assert_eq!(plan.counts().steps, 1 + u32::from(full_screen), "{mode:?}");
        let target = plan.attachments().last().unwrap().role;
        assert_eq!(target, if full_screen { Role::Color(2) } else { Role::ResolveTarget(2, mode) });
        let every = ResolveModes::of(&ResolveMode::ALL);
        let plan = clean(&g, &Caps { color_resolves: every, ..wgpu() });
        assert_eq!((plan.counts().steps, placement(&plan, "samples")), (1, Placement::Memoryless));
    }
}

/// WebGPU cannot average 32-bit floats while storing, so a shader does it; this depends on the format, not on the
/// device.
#[test]
fn a_format_that_is_not_averaged_is_resolved_by_a_pass() {
    let formats = wgpu().formats.without(Format::R32Float, FormatCaps::RESOLVABLE);
    let caps = Caps { formats, ..wgpu() };
    for (format, shown, full_screen) in [
        (Format::R32Float, Format::R16Float, true),
        (Format::R16Float, Format::R16Float, false),
        (Format::R16Float, Format::R32Float, false),
    ] {
        let mut g = Graph::new();
        let (samples, one) = (g.texture("samples", color(format).samples(4)), g.texture("one", color(format)));
        let screen = g.import_texture("screen", color(shown), Entry::Undefined, Exit::Keep);
        let declare = |p: &mut PassBuilder<'_>| {
            p.takes_epilogue();
            let drawn = p.color(samples, Intent::Overwrite)?;
            p.resolve(drawn, one)
        };
        let one = g.add_fn("draw", declare).unwrap();
        g.add_fn("post", |p| {
            p.pointwise();
            p.same_pixel(one)?;
            p.color(screen, Intent::Overwrite)
        })
        .unwrap();
        let plan = clean(&g, &Caps { inline: false, ..caps.clone() });
        assert_eq!(plan.counts().steps, 2 + u32::from(full_screen), "{format:?}");
        assert_eq!(plan.counts().multisample_resolves, u32::from(!full_screen));
        // Samples of an inlined image have the format of the target and are averaged while storing.
        let plan = clean(&g, &caps);
        let averaged = [format, shown] == [Format::R16Float; 2];
        assert_eq!(plan.counts().inlined, u32::from(averaged), "{format:?} {shown:?}");
    }
}

#[test]
fn a_resolve_that_nobody_reads_is_dropped() {
    let mut g = Graph::new();
    let screen = screen(&mut g);
    let (samples, one) = (g.texture("samples", depth().samples(4)), g.texture("one", depth()));
    let (hdr, gone) = (g.texture("hdr", hdr().samples(4)), g.texture("gone", color(Format::Rgba8UnormSrgb)));
    let out = g
        .add_fn("draw", |p| {
            let drawn = p.depth(samples, FAR)?;
            p.resolve_as(ResolveMode::Min, drawn, one)?;
            p.color(hdr, BLACK)
        })
        .unwrap();
    g.export(out).unwrap();
    // Forwarded textures are logged even if resolves were dropped.
    let gone = g.add_fn("post", |p| p.color(gone, Intent::Overwrite)).unwrap();
    g.forward(gone, screen).unwrap();
    let plan = clean(&g, &wgpu());
    let one = g.find_resource("one").unwrap();
    assert!(plan.reasons(Subject::Pass(g.find_pass("draw").unwrap())).any(|r| r == Reason::ResolveDropped(one)));
    assert_eq!((plan.counts().steps, placement(&plan, "samples")), (2, Placement::Memoryless));
    let kept = plan_with(&g, &wgpu(), &Options { cull: false, ..options() });
    assert!(check::examine(&kept).is_clean());
    assert_eq!(kept.counts().steps, 3);
}

/// A pass that only resolves shares the step that drew depth; later passes share it as long as they do not change
/// depth.
#[test]
fn what_only_resolves_shares_the_step_and_what_changes_the_samples_does_not() {
    for caps in [Caps::tiler(), wgpu()] {
        for changes in [false, true] {
            let mut g = Graph::new();
            let (samples, one) = (g.texture("samples", depth().samples(4)), g.texture("one", depth()));
            let drawn = g.add_fn("draw", |p| p.depth(samples, FAR)).unwrap();
            let resolve = |p: &mut PassBuilder<'_>| {
                p.depth_read_only(drawn)?;
                p.resolve_as(ResolveMode::Sample0, drawn, one)
            };
            let one = g.add_fn("resolve", resolve).unwrap();
            let hdr = g.texture("hdr", hdr().samples(4));
            let hdr = g
                .add_fn("color", |p| {
                    if changes {
                        p.depth(drawn, Intent::Modify).map(drop)?;
                    } else {
                        p.depth_read_only(drawn).map(drop)?;
                    }
                    p.color(hdr, BLACK)
                })
                .unwrap();
            g.export(one).unwrap();
            g.export(hdr).unwrap();
            let plan = clean(&g, &caps);
            let first = &steps(&plan)[0];
            assert_eq!(first.len(), if changes { 2 } else { 3 }, "{}", dump::text(&plan));
            assert_eq!(split_reason(&plan, "color"), changes.then_some(Refusal::ResolveBetween));
            assert_eq!(plan.counts().unresolves, u32::from(changes));
        }
    }
}

#[test]
fn only_averages_are_graded_sample_by_sample() {
    for (mode, every, inlined) in [
        (ResolveMode::Average, false, true),
        (ResolveMode::Average, true, true),
        (ResolveMode::Max, false, false),
        (ResolveMode::Max, true, false),
    ] {
        let mut g = Graph::new();
        let (samples, one) = (g.texture("samples", hdr().samples(4)), g.texture("one", hdr()));
        let scene = |p: &mut PassBuilder<'_>| {
            p.takes_epilogue();
            let drawn = p.color(samples, BLACK)?;
            p.resolve_as(mode, drawn, one)
        };
        let one = g.add_fn("scene", scene).unwrap();
        let out = screen(&mut g);
        g.add_fn("grade", |p| {
            p.pointwise();
            p.same_pixel(one)?;
            p.color(out, Intent::Overwrite)
        })
        .unwrap();
        let modes = if every { ResolveModes::of(&ResolveMode::ALL) } else { wgpu().color_resolves };
        let plan = clean(&g, &Caps { color_resolves: modes, ..wgpu() });
        assert_eq!(plan.counts().inlined, u32::from(inlined), "{mode:?}");
        let grade = Subject::Pass(g.find_pass("grade").unwrap());
        let refused = plan.reasons(grade).any(|r| matches!(r, Reason::NotInlined(_, Refusal::ResolveMode)));
        assert_eq!(refused, !inlined);
    }
}

#[test]
fn what_cannot_be_resolved_so_is_refused() {
    let refused = |format: Format, mode, aspect| {
        let mut g = Graph::new();
        let samples = g.texture("samples", color(format).samples(4));
        let one = g.texture("one", color(format.depth_alone()));
        let declared = g.add_fn("draw", |p| {
            let drawn = match format.is_depth_stencil() {
                true => p.depth(samples.aspect(aspect), Intent::Overwrite)?,
                false => p.color(samples, Intent::Overwrite)?,
            };
            p.resolve_as(mode, drawn, one)
        });
        declared.map(drop).map_err(|e| e.reason)
    };
    use {Aspect::*, DeclareReason as D, ResolveMode::*};
    let depth = Format::Depth32Float;
    assert_eq!(refused(depth, Average, All), Err(D::ResolveMode { mode: Average, format: depth }));
    assert!(refused(Format::R32Uint, Average, All).is_err());
    assert_eq!(refused(Format::R32Uint, Min, All), Ok(()));
    let both = Format::Depth32FloatStencil8;
    assert_eq!(refused(both, Max, All), Ok(()));
    assert_eq!(refused(both, Max, Stencil), Err(D::NothingToResolve));

    // Formats, samples and sizes must match, which is checked when compiling.
    let compiled = |from: TextureDesc, into: TextureDesc| {
        let mut g = Graph::new();
        let (samples, one) = (g.texture("samples", from), g.texture("one", into));
        let declare = |p: &mut PassBuilder<'_>| {
            let drawn = p.depth(samples, FAR)?;
            p.resolve_as(Sample0, drawn, one)
        };
        let one = g.add_fn("draw", declare).unwrap();
        g.export(one).unwrap();
        errors(&g).remove(0).reason
    };
    let four = color(both).samples(4);
    let (expected, found) = (depth, Format::Depth16Unorm);
    assert_eq!(compiled(four, color(found)), CompileReason::Format { expected, found });
    assert_eq!(compiled(color(depth), color(depth)), CompileReason::Samples { expected: 0, found: 1 });
    assert_eq!(compiled(four, color(depth).samples(4)), CompileReason::Samples { expected: 1, found: 4 });
    let [w, h] = FRAME;
    let reason = CompileReason::Extent { expected: [w, h, 1], found: [w / 2, h / 2, 1] };
    assert_eq!(compiled(four, color(depth).extent(Extent::fraction(2))), reason);
}

#[cfg(feature = "files")]
#[test]
fn files_say_depth_and_mode() {
    use framegraph::file::{self, GraphFile, Registry};
    let graph = resolved_depth(ResolveMode::Min);
    let text = file::to_ron(&graph, "frame", FRAME);
    assert!(text.contains(r#"Resolve(to: "one", of: Depth, mode: Min)"#), "{text}");
    let mut again = Graph::new();
    GraphFile::parse("frame.ron", &text).unwrap().declare(&[], &Registry::new(), &mut again).unwrap();
    assert_eq!(file::to_ron(&again, "frame", FRAME), text);
    assert_eq!(dump::text(&clean(&again, &Caps::tiler())), dump::text(&clean(&graph, &Caps::tiler())));
    let slot = text.replace("of: Depth", "slot: 15");
    let refused = GraphFile::parse("frame.ron", &slot).unwrap().declare(&[], &Registry::new(), &mut Graph::new());
    let message = refused.expect_err("no color attachment has this slot").to_string();
    assert!(message.contains("`of: Depth`"), "{message}");
    let caps = file::caps("caps.ron", "(version: 1, like: \"desktop\", depth_resolves: [Sample0, Min])").unwrap();
    assert_eq!(clean(&graph, &caps).counts().steps, 2);
}
