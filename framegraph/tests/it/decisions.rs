//! The log: each reason comes up, and says in words what was decided.

use crate::support::*;
use framegraph::testing::generate::{self, Entropy, Profile, options_of};
use framegraph::*;
use std::collections::BTreeSet;

/// The sentences that a plan has about a pass or resource, in the order of the log.
fn sentences(plan: &Plan, about: &str) -> Vec<String> {
    let g = plan.graph();
    let named = |d: &&Decision| match d.subject {
        Subject::Pass(p) => g.pass_name(p) == about,
        Subject::Resource(r) | Subject::Load(_, r) | Subject::Store(_, r) => g.resource_name(r) == about,
    };
    plan.decisions().iter().filter(named).map(|d| plan.explained(d)).collect()
}

/// `first` and `again` draw into `a`, a pass that draws into `b` stands between them.
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
    let plan = plan(&interleaved(Entry::Defined), &Caps::wgpu());
    assert_eq!(check(&plan), Ok(()));
    let loads: Vec<_> = sentences(&plan, "a").into_iter().filter(|s| s.starts_with("load")).collect();
    assert_eq!(
        loads,
        [
            "load of `a` in step 0: loaded, the contents on entry are needed",
            "load of `a` in step 2: loaded, `first` wrote contents that are needed"
        ]
    );
}

#[test]
fn a_pass_that_moves_says_behind_which_and_what_for() {
    let optimized = Options { order: Order::Optimized, ..options() };
    let plan = plan_with(&interleaved(Entry::Defined), &Caps::wgpu(), &optimized);
    assert_eq!(check(&plan), Ok(()));
    assert_eq!(steps(&plan), [vec!["first", "again"], vec!["between"]]);
    let moved = |name| sentences(&plan, name).into_iter().find(|s| s.contains("behind"));
    assert_eq!(moved("again").as_deref(), Some("pass `again`: moved behind `first`, to share its step"));
    let bytes = "pass `between`: runs behind `again`, the frame takes fewer steps or bytes in this order";
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
        let plan = plan_with(&g, &Caps::wgpu(), &Options { alias, ..options() });
        assert_eq!(check(&plan), Ok(()));
        sentences(&plan, "a").into_iter().find(|s| s.starts_with("resource"))
    };
    assert_eq!(place(Alias::Off).as_deref(), Some("resource `a`: not shared, sharing is switched off"));
    assert_eq!(place(Alias::Pool).as_deref(), Some("resource `a`: first tenant of its slot"));
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
    let plan = plan(&g, &Caps::wgpu());
    assert!(check::examine(&plan).is_clean());
    let said = "pass `draw`: does not resolve into `average`, no pass reads it".to_owned();
    assert!(sentences(&plan, "draw").contains(&said), "{}", dump::text(&plan));
    // It takes no memory, and stands between the passes no more.
    assert_eq!(placement(&plan, "average"), Placement::Unused);
    assert_eq!(steps(&plan), [vec!["draw", "more"], vec!["look"]]);
    assert_eq!((plan.attachments().len(), plan.counts().multisample_resolves), (2, 0));
    // Without culling it is made as it was declared.
    let plan = plan_with(&g, &Caps::wgpu(), &Options { cull: false, ..options() });
    assert_eq!(check(&plan), Ok(()));
    assert_eq!((plan.counts().steps, split_reason(&plan, "more")), (3, Some(Refusal::ResolveBetween)));
}

/// `draw` makes a texture or two, `look` reads them at the same pixel: what it is told it could do is something it can.
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
        plan.hint(plan.decisions().iter().find(split).expect("the read cannot stay in the tile"))
    };
    let one = Case { inputs: 1, outputs: 1, ..Case::default() };
    let (declare, choose) =
        ("declare the pass point-wise if it is, so that it can be inlined", "choose a device that can");
    let mend = "choose a device that can, or mend what keeps the pass from being inlined";
    let off = Options { inline: false, ..options() };
    let cases = [
        (one, Caps::wgpu(), options(), declare),
        // Where nothing is inlined.
        (one, Caps::desktop(), options(), choose),
        (one, Caps::wgpu(), off, choose),
        (Case { pointwise: true, ..one }, Caps::desktop(), options(), choose),
        (Case { pointwise: true, ..one }, Caps::wgpu(), off, choose),
        // What would not be inlined if it were point-wise.
        (Case { inputs: 2, ..one }, Caps::wgpu(), options(), choose),
        (Case { outputs: 2, ..one }, Caps::wgpu(), options(), choose),
        (Case { samples: true, ..one }, Caps::wgpu(), options(), choose),
        (Case { side_effect: true, ..one }, Caps::wgpu(), options(), choose),
        (Case { modifies: true, ..one }, Caps::wgpu(), options(), choose),
        // Point-wise, and the producer takes no epilogue.
        (Case { pointwise: true, ..one }, Caps::wgpu(), options(), mend),
    ];
    for (index, (case, caps, options, expected)) in cases.iter().enumerate() {
        assert_eq!(hint(*case, caps, options), *expected, "case {index}");
    }
}

/// What is stored for a reader: how it could stay in the tile, where it can.
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
    let device = "choose a device that keeps same-pixel reads in the tile, and leave merging on";
    let general = "read it at the same pixel if the reader needs its own texel alone, or let the reader share the step, to keep \
                   it in the tile";
    let raster = "read it in a raster pass that shares the step, to keep it in the tile";
    let share = "let the reader share the step, to keep it in the tile";
    let apart = Options { merge: false, ..options() };
    let cases = [
        (AccessKind::Sampled, Caps::desktop(), options(), device),
        (AccessKind::Sampled, Caps::tiler(), apart, device),
        (AccessKind::Sampled, Caps::tiler(), options(), general),
        (AccessKind::Sampled, Caps::wgpu(), options(), general),
        (AccessKind::SamePixel, Caps::tiler(), options(), share),
        (AccessKind::StorageRead, Caps::tiler(), options(), raster),
    ];
    for (index, (kind, caps, options, expected)) in cases.iter().enumerate() {
        assert_eq!(hint(*kind, caps, options), *expected, "case {index}");
    }
}

/// Every reason that there is, by its word: nothing of the list is left over, and random plans, whose logs the oracle judges,
/// come to each.
#[test]
fn every_reason_comes_up() {
    let mut found = BTreeSet::new();
    for seed in 0..4000 {
        let mut entropy = Entropy::seeded(seed);
        let mut caps = generate::caps(&mut entropy);
        let graph = generate::graph(&mut entropy, &Profile::default());
        if seed % 4 == 0 {
            // Steps of as many attachments as one pass has are full.
            let colors = |pass| graph.accesses_of(pass).iter().filter(|a| a.kind == AccessKind::Color).count() as u8;
            caps.max_color_attachments = graph.pass_ids().map(colors).max().unwrap_or(0).max(1);
        }
        let mut plan = Plan::new();
        // A device can be too small for the graph.
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
    // So rare that a test in `counts` builds it.
    assert_eq!(missing, [MemoryNeed::OtherUse.word()]);
}

/// The words of all reasons.
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
