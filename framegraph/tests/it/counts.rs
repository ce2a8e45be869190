//! Loads and stores of frames, derived by hand.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;

/// Depth prepass, color pass over it, post pass into the screen.
fn prepass_frame(samples: u8, prepass_merges: bool) -> Graph {
    let mut g = Graph::new();
    let screen = screen(&mut g);
    let ms_depth = depth().samples(samples);
    let z = g
        .add_fn("prepass", |p| {
            if !prepass_merges {
                p.never_merge();
            }
            let z = p.texture("depth", ms_depth);
            p.depth(z, FAR)
        })
        .unwrap();
    let color = g
        .add_fn("color", |p| {
            p.depth_read_only(z)?;
            let target = p.texture("hdr", hdr());
            if samples == 1 {
                return p.color(target, BLACK);
            }
            let ms = p.texture("hdr_ms", hdr().samples(samples));
            let ms = p.color(ms, BLACK)?;
            p.resolve(ms, target)
        })
        .unwrap();
    g.add_fn("post", |p| {
        p.sampled(color)?;
        p.color(screen, Intent::Overwrite)
    })
    .unwrap();
    g
}

#[test]
fn unmerged_prepass_stores_and_loads_depth() {
    // - prepass: depth clear -> store, so 1 clear and 1 store.
    // - color: depth load (read-only) -> discard; hdr clear -> store, so 1 load, 1 clear, 1 store and 1 discard.
    // - post: screen dont_care -> store, so 1 store.
    let plan = plan(&prepass_frame(1, false), &wgpu());
    let c = plan.counts();
    assert_eq!((c.unresolves, c.resolves, c.clears, c.discards, c.multisample_resolves), (1, 3, 2, 1, 0));
    assert_eq!((c.steps, c.memoryless, c.culled), (3, 0, 0));
    assert_eq!(ops(&plan, "depth"), [(LoadOp::Clear, StoreOp::Store), (LoadOp::Load, StoreOp::Discard)]);
}

#[test]
fn merged_prepass_keeps_depth_in_the_tile() {
    // prepass + color: depth clear -> discard, hdr clear -> store. post: screen -> store.
    let plan = plan(&prepass_frame(1, true), &wgpu());
    let c = plan.counts();
    assert_eq!((c.unresolves, c.resolves, c.clears, c.discards), (0, 2, 2, 1));
    assert_eq!((c.steps, c.passes, c.memoryless), (2, 3, 1));
    assert_eq!(placement(&plan, "depth"), Placement::Memoryless);
}

#[test]
fn multisampling_resolves_in_the_tile() {
    // prepass + color: depth clear -> discard, hdr_ms clear -> discard, hdr is its resolve target. post: screen ->
    // store.
    let plan = plan(&prepass_frame(4, true), &wgpu());
    let c = plan.counts();
    assert_eq!((c.unresolves, c.resolves, c.clears, c.discards, c.multisample_resolves), (0, 2, 2, 2, 1));
    assert_eq!(c.memoryless, 2);
    let traffic = plan.traffic(FRAME);
    let texels = u64::from(FRAME[0] * FRAME[1]);
    assert_eq!(
        (traffic.loaded_bytes, traffic.stored_bytes, traffic.multisample_resolve_bytes),
        (0, texels * (8 + 4), texels * 8)
    );
    assert_eq!(plan.traffic([FRAME[0] * 2, FRAME[1]]).stored_bytes, 2 * traffic.stored_bytes);
}

#[test]
fn without_memoryless_attachments_they_take_memory() {
    let plan = plan(&prepass_frame(4, true), &Caps::desktop());
    assert_eq!(plan.counts().memoryless, 0);
    assert!(matches!(placement(&plan, "hdr_ms"), Placement::Slot(_)));
}

#[test]
fn a_mip_pyramid_is_followed_level_by_level() {
    // Each level is written once and read by the next pass; the last one is read by the consumer.
    let mut g = Graph::new();
    let mut pyramid = g.texture("pyramid", color(Format::R32Float).mips(4));
    pyramid = g.add_fn("base", |p| p.color(pyramid.mip(0), Intent::Overwrite)).unwrap();
    for mip in 1..4 {
        pyramid = g
            .add_fn("down", |p| {
                p.sampled(pyramid.mip(mip - 1))?;
                p.color(pyramid.mip(mip), Intent::Overwrite)
            })
            .unwrap();
    }
    let screen = screen(&mut g);
    g.add_fn("use", |p| {
        p.sampled(pyramid.mip(2))?;
        p.color(screen, Intent::Overwrite)
    })
    .unwrap();
    let plan = plan(&g, &wgpu());
    // No pass reads level 3: its pass is culled, and levels 0, 1, 2 are stored.
    let c = plan.counts();
    assert_eq!((c.unresolves, c.resolves, c.culled), (0, 4, 1));
    let extents: Vec<_> = plan.steps().iter().map(|s| s.extent).collect();
    assert_eq!(extents, [[64, 32], [32, 16], [16, 8], [64, 32]]);
}

#[test]
fn depth_and_stencil_are_decided_apart() {
    // Depth is sampled later and stored; only the mask pass uses stencil, which is discarded.
    let mut g = Graph::new();
    let ds = g.texture("ds", color(Format::Depth32FloatStencil8));
    let ds = g.add_fn("mask", |p| p.depth(ds, FAR)).unwrap();
    let screen = screen(&mut g);
    g.add_fn("fog", |p| {
        p.sampled(ds.aspect(Aspect::Depth))?;
        p.color(screen, Intent::Overwrite)
    })
    .unwrap();
    let plan = plan(&g, &Caps::tiler());
    let a = plan.attachments()[0];
    assert_eq!((a.load, a.store, a.stencil_load, a.stencil_store), {
        (LoadOp::Clear, StoreOp::Store, LoadOp::Clear, StoreOp::Discard)
    });
    let texels = u64::from(FRAME[0] * FRAME[1]);
    assert_eq!(plan.traffic(FRAME).stored_bytes, texels * 4 + texels * 4, "32 depth bits and the screen, no stencil");
}

#[test]
fn modify_loads_what_an_earlier_step_stored() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let a = g.add_fn("draw", |p| p.color(a, BLACK)).unwrap();
    let blurred = filter(&mut g, "blur", a, Format::Rgba16Float);
    let a = g
        .add_fn("glow", |p| {
            p.sampled(blurred)?;
            p.blends();
            p.color(a, Intent::Modify)
        })
        .unwrap();
    g.export(a).unwrap();
    let plan = plan(&g, &wgpu());
    assert_eq!(ops(&plan, "a"), [(LoadOp::Clear, StoreOp::Store), (LoadOp::Load, StoreOp::Store)]);
    let draw = plan.graph().find_pass("draw").unwrap();
    let a = plan.graph().find_resource("a").unwrap();
    let step = plan.pass_steps()[plan.graph().find_pass("glow").unwrap().index()];
    assert_eq!(plan.reasons(Subject::Load(step, a)).next(), Some(Reason::LoadWritten(draw)));
}

#[test]
fn equal_graphs_give_equal_text_whatever_the_scratch_held() {
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    let mut texts = Vec::new();
    for samples in [4, 1, 4] {
        let graph = prepass_frame(samples, samples == 4);
        compile(&graph, &wgpu(), &options(), &mut scratch, &mut plan).unwrap();
        texts.push(dump::text(&plan) + &dump::dot(&plan));
    }
    assert_eq!(texts[0], texts[2]);
    assert_ne!(texts[0], texts[1]);
}

#[test]
fn an_equal_graph_is_recognised() {
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    let caps = wgpu();
    let mut again = |g: &Graph, o: &Options| recompile(g, &caps, o, &mut scratch, &mut plan).unwrap();
    assert!(again(&prepass_frame(4, true), &options()));
    assert!(!again(&prepass_frame(4, true), &options()));
    assert!(again(&prepass_frame(4, false), &options()));
    assert!(again(&prepass_frame(4, false), &Options { frame: [8, 8], ..options() }));
}

/// The samples are read individually and their average by no pass: it is not computed and not counted.
#[test]
fn an_average_that_nobody_reads_is_not_made() {
    let mut g = Graph::new();
    let screen = screen(&mut g);
    let samples = g
        .add_fn("color", |p| {
            let (target, ms) = (p.texture("hdr", hdr()), p.texture("hdr_ms", hdr().samples(4)));
            let ms = p.color(ms, BLACK)?;
            p.resolve(ms, target)?;
            Ok(ms)
        })
        .unwrap();
    g.add_fn("look", |p| {
        p.sampled(samples)?;
        p.color(screen, Intent::Overwrite)
    })
    .unwrap();
    let plan = plan(&g, &wgpu());
    let counts = plan.counts();
    assert_eq!((counts.multisample_resolves, counts.discards, counts.resolves), (0, 0, 2), "{}", dump::text(&plan));
}

#[test]
fn layers_go_without_memory_where_the_device_says_so() {
    // Depth has two layers, is drawn and discarded; `a` has two attachments of one layer each. If `kept`, one of them
    // is read.
    let frame = |kept: bool| {
        let mut g = Graph::new();
        let out = g.texture("out", hdr().layers(2));
        let z = g.texture("z", depth().layers(2));
        let out = g
            .add_fn("views", |p| {
                p.depth(z, FAR)?;
                p.color(out, BLACK)
            })
            .unwrap();
        g.export(out).unwrap();
        let (a, b) = (g.texture("a", hdr().layers(2)), g.texture("b", hdr()));
        let (a, b) = g
            .add_fn("apart", |p| {
                let a = p.color(a.layer(0), BLACK)?;
                Ok((p.color(a.layer(1), BLACK)?, p.color(b, BLACK)?))
            })
            .unwrap();
        g.export(b).unwrap();
        if kept {
            let shown = g.texture("shown", hdr());
            let shown = g
                .add_fn("show", |p| {
                    p.sampled(a.layer(1))?;
                    p.color(shown, Intent::Overwrite)
                })
                .unwrap();
            g.export(shown).unwrap();
        }
        g
    };
    let one = Caps { memoryless_layers: false, ..Caps::tiler() };
    for (caps, memoryless) in [(Caps::tiler(), true), (one, false)] {
        for kept in [false, true] {
            let plan = plan(&frame(kept), &caps);
            let report = check::examine(&plan);
            assert!(report.is_clean(), "{report}");
            let without = |name: &str| placement(&plan, name) == Placement::Memoryless;
            assert_eq!((without("z"), without("a")), (memoryless, memoryless && !kept));
        }
    }
}

/// A texture with one layer written as storage and another one drawn needs memory for both, even if no pass reads them.
#[test]
fn what_is_storage_too_is_not_memoryless() {
    let mut g = Graph::new();
    let (t, out) = (g.texture("t", hdr().layers(2)), g.texture("out", hdr()));
    let out = g
        .add_fn("draw", |p| {
            let t = p.color(t.layer(1), Intent::Overwrite)?;
            p.storage_write(t.layer(0), Intent::Overwrite)?;
            p.color(out, BLACK)
        })
        .unwrap();
    g.export(out).unwrap();
    let plan = plan(&g, &Caps::tiler());
    assert_eq!(plan.counts().memoryless, 0);
    let causes = plan.decisions().iter().filter_map(|d| match d.reason {
        Reason::NeedsMemory(need) => Some(need),
        _ => None,
    });
    assert_eq!(causes.collect::<Vec<_>>(), [MemoryNeed::OtherUse, MemoryNeed::LoadedOrStored]);
    assert_eq!(check(&plan), Ok(()));
}
