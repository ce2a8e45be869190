//! The decision log: each reason occurs, with a correct sentence.

use crate::support::*;
use framegraph::*;
use framegraph_check::check;
use framegraph_check::generate::{self, Entropy, Profile, options_of};
use std::collections::BTreeSet;

/// Returns the sentences of a plan about a pass or resource, in the order of the log.
fn sentences(plan: &Plan, about: &str) -> Vec<String> {
    let g = plan.graph();
    let named = |d: &&Decision| match d.subject {
        Subject::Pass(p) => g.pass_name(p) == about,
        Subject::Resource(r) | Subject::Load(_, r) | Subject::Store(_, r) => g.resource_name(r) == about,
    };
    plan.decisions().iter().filter(named).map(|d| plan.explained(d)).collect()
}

/// `first` and `again` draw into `a`, and a pass between them draws into `b`.
fn interleaved(a: Entry) -> Graph {
    let mut g = Graph::new();
    let (a, b) = (g.import_texture("a", hdr(), a, Exit::Keep), g.texture("b", hdr()));
    let a = g.add_fn("first", |p| p.color(a, Intent::Modify)).unwrap();
    let b = g.add_fn("between", |p| p.color(b, BLACK)).unwrap();
    g.add_fn("again", |p| p.color(a, Intent::Modify)).unwrap();
    g.export(b).unwrap();
    g
}

#[test]
fn what_is_loaded_says_whose_contents_it_holds() {
    let plan = plan(&interleaved(Entry::Defined), &wgpu());
    assert_eq!(check(&plan), Ok(()));
    let loads: Vec<_> = sentences(&plan, "a").into_iter().filter(|s| s.starts_with("load")).collect();
    assert_eq!(
        loads,
        [
            "load of `a` in step 0: loaded because its contents at the start of the frame are needed",
            "load of `a` in step 2: loaded because contents written by `first` are needed"
        ]
    );
}

#[test]
fn a_pass_that_moves_says_behind_which_and_what_for() {
    let optimized = Options { order: Order::Optimized, ..options() };
    let plan = plan_with(&interleaved(Entry::Defined), &wgpu(), &optimized);
    assert_eq!(check(&plan), Ok(()));
    assert_eq!(steps(&plan), [vec!["first", "again"], vec!["between"]]);
    let moved =
        |name| sentences(&plan, name).into_iter().find(|s| s.contains(": moved after") || s.contains(": runs after"));
    assert_eq!(moved("again").as_deref(), Some("pass `again`: moved after `first` to share its step"));
    let bytes = "pass `between`: runs after `again` because the frame needs fewer steps or bytes in this order";
    assert_eq!(moved("between").as_deref(), Some(bytes));
    assert_eq!(moved("first"), None);
}

#[test]
fn what_is_not_shared_says_that_sharing_is_off() {
    let mut g = Graph::new();
    let a = g.texture("a", hdr());
    let a = g.add_fn("draw", |p| p.color(a, BLACK)).unwrap();
    let out = filter(&mut g, "show", a, Format::R8Unorm);
    g.export(out).unwrap();
    let place = |alias| {
        let plan = plan_with(&g, &wgpu(), &Options { alias, ..options() });
        assert_eq!(check(&plan), Ok(()));
        sentences(&plan, "a").into_iter().find(|s| s.starts_with("resource"))
    };
    assert_eq!(place(Alias::Off).as_deref(), Some("resource `a`: not shared because aliasing is disabled"));
    assert_eq!(Alias::Off.word(), "off");
    assert_eq!(place(Alias::Pool).as_deref(), Some("resource `a`: first resource in its slot"));
}

#[test]
fn an_average_that_is_not_made_says_so() {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let draw = |p: &mut PassBuilder<'_>| {
        let (ms, average) = (p.texture("ms", hdr().samples(4)), p.texture("average", hdr()));
        let ms = p.color(ms, BLACK)?;
        p.resolve(ms, average)?;
        Ok(ms)
    };
    let ms = g.add_fn("draw", draw).unwrap();
    let ms = g.add_fn("more", |p| p.color(ms, Intent::Modify)).unwrap();
    g.add_fn("look", |p| {
        p.sampled(ms)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    let plan = plan(&g, &wgpu());
    assert!(check::examine(&plan).is_clean());
    let said = "pass `draw`: does not resolve into `average` because no pass reads it".to_owned();
    assert!(sentences(&plan, "draw").contains(&said), "{}", dump::text(&plan));
    // It needs no memory and no longer prevents the merge.
    assert_eq!(placement(&plan, "average"), Placement::Unused);
    assert_eq!(steps(&plan), [vec!["draw", "more"], vec!["look"]]);
    assert_eq!((plan.attachments().len(), plan.counts().multisample_resolves), (2, 0));
    // Without culling it is performed as declared.
    let plan = plan_with(&g, &wgpu(), &Options { cull: false, ..options() });
    assert_eq!(check(&plan), Ok(()));
    assert_eq!((plan.counts().steps, split_reason(&plan, "more")), (3, Some(Refusal::ResolveBetween)));
}

/// `draw` writes a texture or two, `look` reads them at the same pixel. The hint must be something that is possible.
#[test]
fn hints_are_true_of_device_options_and_passes() {
    #[derive(Clone, Copy, Default)]
    struct Case {
        inputs: usize,
        outputs: usize,
        samples: bool,
        pointwise: bool,
        side_effect: bool,
        modifies: bool,
    }
    let graph = |case: Case| {
        let mut g = Graph::new();
        let inputs: Vec<Texture> = (0..case.inputs).map(|i| g.texture(&format!("in{i}"), hdr())).collect();
        let lut = g.import_texture("lut", hdr(), Entry::Defined, Exit::Keep);
        let outputs: Vec<Texture> = (0..case.outputs)
            .map(|i| g.import_texture(&format!("out{i}"), hdr(), Entry::Defined, Exit::Keep))
            .collect();
        let mut drawn = Vec::new();
        g.add_fn("draw", |p| {
            for input in &inputs {
                drawn.push(p.color(*input, BLACK)?);
            }
            Ok(())
        })
        .unwrap();
        g.add_fn("look", |p| {
            for input in &drawn {
                p.same_pixel(*input)?;
            }
            if case.samples {
                p.sampled(lut)?;
            }
            if case.pointwise {
                p.pointwise();
            }
            if case.side_effect {
                p.side_effect();
            }
            for output in &outputs {
                p.color(*output, if case.modifies { Intent::Modify } else { Intent::Overwrite })?;
            }
            Ok(())
        })
        .unwrap();
        g
    };
    let hint = |case: Case, caps: &Caps, options: &Options| {
        let plan = plan_with(&graph(case), caps, options);
        let split = |d: &&Decision| matches!(d.reason, Reason::Split(_, Refusal::SamePixelUnsupported));
        plan.hint(plan.decisions().iter().find(split).expect("the read is not in the tile"))
    };
    let one = Case { inputs: 1, outputs: 1, ..Case::default() };
    let (declare, choose) =
        ("declare the pass as point-wise if it is, so that it can be inlined", "use a device that supports it");
    let mend = "use a device that supports it, or fix what prevents inlining of the pass";
    let off = Options { inline: false, ..options() };
    let cases = [
        (one, wgpu(), options(), declare),
        // Without inlining.
        (one, Caps::desktop(), options(), choose),
        (one, wgpu(), off, choose),
        (Case { pointwise: true, ..one }, Caps::desktop(), options(), choose),
        (Case { pointwise: true, ..one }, wgpu(), off, choose),
        // Passes that would not be inlined if they were point-wise.
        (Case { inputs: 2, ..one }, wgpu(), options(), choose),
        (Case { outputs: 2, ..one }, wgpu(), options(), choose),
        (Case { samples: true, ..one }, wgpu(), options(), choose),
        (Case { side_effect: true, ..one }, wgpu(), options(), choose),
        (Case { modifies: true, ..one }, wgpu(), options(), choose),
        // Point-wise, but the producer does not accept an epilogue.
        (Case { pointwise: true, ..one }, wgpu(), options(), mend),
    ];
    for (index, (case, caps, options, expected)) in cases.iter().enumerate() {
        assert_eq!(hint(*case, caps, options), *expected, "case {index}");
    }
}

/// Hints about stores for a reader: how the contents could stay in the tile.
#[test]
fn hints_of_stores_are_true_of_device_options_and_reader() {
    let hint = |kind: AccessKind, caps: &Caps, options: &Options| {
        let mut g = Graph::new();
        let (a, between) = (g.texture("a", hdr()), g.texture("between", color(Format::Rgba8Unorm)));
        let a = g.add_fn("draw", |p| p.color(a, BLACK)).unwrap();
        let between = g
            .add_fn("fill", |p| {
                p.kind(PassKind::Compute)?;
                p.storage_write(between, Intent::Overwrite)
            })
            .unwrap();
        g.export(between).unwrap();
        if kind == AccessKind::StorageRead {
            let compute = |p: &mut PassBuilder<'_>| {
                p.kind(PassKind::Compute)?;
                p.side_effect();
                p.sampled(a).map(drop)
            };
            g.add_fn("look", compute).unwrap();
        } else {
            let out = screen(&mut g);
            let look = |p: &mut PassBuilder<'_>| {
                let read = if kind == AccessKind::Sampled { p.sampled(a) } else { p.same_pixel(a) };
                read?;
                p.color(out, Intent::Overwrite)
            };
            g.add_fn("look", look).unwrap();
        }
        let plan = plan_with(&g, caps, options);
        let stored = |d: &&Decision| matches!(d.reason, Reason::StoreReadBy(_));
        plan.hint(plan.decisions().iter().find(stored).expect("it is stored"))
    };
    let device = "use a device that keeps same-pixel reads in the tile, and enable merging";
    let general = "to keep it in the tile, read it at the same pixel if the reader needs only its own texel, or let the \
                   reader share the step";
    let raster = "to keep it in the tile, read it in a raster pass of the same step";
    let share = "to keep it in the tile, let the reader share the step";
    let apart = Options { merge: false, ..options() };
    let cases = [
        (AccessKind::Sampled, Caps::desktop(), options(), device),
        (AccessKind::Sampled, Caps::tiler(), apart, device),
        (AccessKind::Sampled, Caps::tiler(), options(), general),
        (AccessKind::Sampled, wgpu(), options(), general),
        (AccessKind::SamePixel, Caps::tiler(), options(), share),
        (AccessKind::StorageRead, Caps::tiler(), options(), raster),
    ];
    for (index, (kind, caps, options, expected)) in cases.iter().enumerate() {
        assert_eq!(hint(*kind, caps, options), *expected, "case {index}");
    }
}

/// Every reason occurs, by its name, in the logs of random plans, which the oracle checks.
#[test]
fn every_reason_comes_up() {
    let mut found = BTreeSet::new();
    for seed in 0..4000 {
        let mut entropy = Entropy::seeded(seed);
        let mut caps = generate::caps(&mut entropy);
        let graph = generate::graph(&mut entropy, &Profile::default());
        if seed % 4 == 0 {
            // A step is full if it has as many attachments as one pass.
            let colors = |pass| graph.accesses_of(pass).iter().filter(|a| a.kind == AccessKind::Color).count() as u8;
            caps.max_color_attachments = graph.pass_ids().map(colors).max().unwrap_or(0).max(1);
        }
        let mut plan = Plan::new();
        // The graph may exceed the limits of the device.
        let _ = compile(&graph, &caps, &options_of(seed as u32), &mut Scratch::new(), &mut plan);
        found.extend(plan.decisions().iter().map(|d| d.reason.word()));
        found.extend(plan.decisions().iter().filter_map(|d| match d.reason {
            Reason::Split(_, why) | Reason::NotInlined(_, why) => Some(why.word()),
            Reason::NeedsMemory(why) => Some(why.word()),
            _ => None,
        }));
    }
    let causes = Refusal::ALL.iter().map(|r| r.word()).chain(MemoryNeed::ALL.iter().map(|n| n.word()));
    let missing: Vec<_> = REASONS.into_iter().chain(causes).filter(|word| !found.contains(word)).collect();
    // So rare that tests in `device` and `counts` construct them.
    assert_eq!(missing, [Refusal::TooManyBindings.word(), MemoryNeed::OtherUse.word()]);
}

/// The names of all reasons.
const REASONS: [&str; 44] = [
    "kept_side_effect",
    "kept_export",
    "kept_import",
    "kept_history",
    "kept_read_by",
    "kept_culling_off",
    "culled_unread",
    "culled_reader_culled",
    "culled_overwritten",
    "culled_no_output",
    "resolve_dropped",
    "resolve_pass",
    "order_merge",
    "order_bytes",
    "merged_attachments",
    "merged_same_pixel",
    "merged_inline",
    "split",
    "not_inlined",
    "load_clear",
    "clear_unneeded",
    "load_overwritten",
    "load_written",
    "load_entry",
    "store_read_by",
    "store_resolved",
    "store_export",
    "store_import",
    "store_history",
    "discard_unread",
    "discard_overwritten",
    "discard_resolved",
    "store_unchanged",
    "memoryless",
    "needs_memory",
    "inlined",
    "slot_first",
    "slot_after",
    "placed",
    "placed_after",
    "external",
    "persistent",
    "aliasing_off",
    "unused",
];
