//! Properties of the plans of random graphs.
//!
//! `FRAMEGRAPH_PROPERTY_CASES=100000 cargo test --release -p framegraph --test it properties` runs this number of
//! graphs per property. The default takes about a second per property in a debug build.

use framegraph::*;
use framegraph_check::check;
use framegraph_check::generate::{self, Entropy, OPTIONS, Profile, options_of};
use std::collections::BTreeSet;

/// Returns the seeds of one property: the requested number, or a fraction of the default.
fn seeds(default: u64) -> std::ops::Range<u64> {
    let asked = std::env::var("FRAMEGRAPH_PROPERTY_CASES").ok();
    let asked = asked.map(|n| n.parse().expect("FRAMEGRAPH_PROPERTY_CASES is a whole number"));
    0..asked.unwrap_or(default)
}

fn presets() -> [Caps; 3] {
    [Caps::desktop(), Caps::tiler(), Caps::wgpu()].map(generate::capable)
}

fn graph(seed: u64) -> Graph {
    generate::graph(&mut Entropy::seeded(seed), &Profile::default())
}

/// Returns a combination of options. Over all seeds, every preset is combined with every one.
fn options(seed: u64, preset: usize) -> Options {
    options_of((seed as u32 * 3 + preset as u32) % OPTIONS)
}

fn compiled(graph: &Graph, caps: &Caps, options: &Options) -> Plan {
    let mut plan = Plan::new();
    let outcome = compile(graph, caps, options, &mut Scratch::new(), &mut plan);
    outcome.unwrap_or_else(|errors| panic!("a valid graph was rejected: {errors}"));
    plan
}

/// Panics with all findings about the plan, and with the plan.
#[track_caller]
fn assert_clean(plan: &Plan, seed: u64) {
    let report = check::examine(plan);
    assert!(
        report.is_clean(),
        "seed {seed}, {}, {:?}\n{report}\n{}",
        plan.caps().name,
        plan.options(),
        dump::text(plan)
    );
}

/// Returns the whole content of a plan, for comparisons.
fn words(plan: &Plan) -> String {
    let rows = (plan.pass_steps(), plan.steps(), plan.step_passes());
    let places = (plan.attachments(), plan.resources(), plan.slots());
    let rest = (plan.memory(), plan.barriers(), plan.decisions());
    format!("{rows:?}\n{places:?}\n{rest:?}\n{}", dump::text(plan))
}

#[test]
fn plans_are_right_and_waste_nothing() {
    let (mut scratch, mut plan, mut slices) = (Scratch::new(), Plan::new(), 0);
    for seed in seeds(400) {
        let graph = graph(seed);
        slices += graph.accesses().iter().filter(|a| a.range.slice).count();
        for (index, caps) in presets().iter().enumerate() {
            for options in [options_of(0), options(seed, index)] {
                let outcome = compile(&graph, caps, &options, &mut scratch, &mut plan);
                outcome.unwrap_or_else(|e| panic!("seed {seed}: a valid graph was rejected: {e}"));
                assert_clean(&plan, seed);
            }
        }
    }
    assert!(seeds(400).end != 400 || slices > 20, "only {slices} accesses to slices");
}

#[test]
fn forwarded_graphs_get_right_plans() {
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    let profile = Profile { forwards: true, ..Profile::default() };
    let (mut refused, mut forwarded, mut volumes) = (0, 0, 0);
    for seed in seeds(600) {
        let graph = generate::graph(&mut Entropy::seeded(seed), &profile);
        let gone = graph.resource_ids().filter_map(|r| graph.forward_of(r));
        let flat =
            |r: &ResourceId| graph.resources()[r.index()].desc.texture().is_some_and(|t| t.dimension == Dimension::D2);
        let (kept, deep): (Vec<_>, Vec<_>) = gone.partition(flat);
        (forwarded, volumes) = (forwarded + kept.len(), volumes + deep.len());
        let caps = &presets()[seed as usize % 3];
        // A texture with another size may no longer match the other attachments.
        match compile(&graph, caps, &options(seed, 0), &mut scratch, &mut plan) {
            Ok(()) => assert_clean(&plan, seed),
            Err(_) => refused += 1,
        }
    }
    let asked = seeds(600).end;
    let enough = forwarded > 100 && volumes > 5 && refused < 300;
    assert!(asked != 600 || enough, "{forwarded} are forwarded, {volumes} in three dimensions, {refused} rejected");
}

#[test]
fn strange_devices_get_right_plans_or_refusals() {
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    let mut refused = 0;
    for seed in seeds(800) {
        let mut entropy = Entropy::seeded(seed);
        let caps = generate::caps(&mut entropy);
        let graph = generate::graph(&mut entropy, &Profile::default());
        let options = options(seed, 0);
        match compile(&graph, &caps, &options, &mut scratch, &mut plan) {
            Ok(()) => assert_clean(&plan, seed),
            Err(_) => refused += 1,
        }
    }
    assert!(refused < seeds(800).end / 10, "{refused} were rejected");
}

#[test]
fn broken_graphs_are_refused_with_reasons_or_right_all_the_same() {
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    let profile = Profile { sloppy: true, ..Profile::default() };
    let mut refused = 0;
    for seed in seeds(1200) {
        let graph = generate::graph(&mut Entropy::seeded(seed), &profile);
        let caps = &presets()[seed as usize % 3];
        let options = options(seed, 0);
        match compile(&graph, caps, &options, &mut scratch, &mut plan) {
            Ok(()) => assert_clean(&plan, seed),
            Err(errors) => {
                refused += 1;
                assert!(!errors.listed.is_empty(), "seed {seed}: rejected without a reason");
                for error in &errors.listed {
                    let sentence = error.to_string();
                    assert!(sentence.len() > 10, "seed {seed}: {sentence}");
                }
                assert!(plan.steps().is_empty(), "seed {seed}: the plan of an invalid graph has steps");
            }
        }
    }
    let asked = seeds(1200).end;
    let some = asked / 5..asked * 4 / 5;
    assert!(asked < 100 || some.contains(&refused), "{refused} were rejected");
}

#[test]
fn a_used_scratch_gives_the_plan_of_a_fresh_one() {
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    for seed in seeds(250) {
        let graph = graph(seed);
        for (index, caps) in presets().iter().enumerate() {
            let options = options(seed, index);
            let fresh = compiled(&graph, caps, &options);
            let outcome = compile(&graph, caps, &options, &mut scratch, &mut plan);
            assert_eq!(outcome, Ok(()));
            assert_eq!(words(&plan), words(&fresh), "seed {seed}, {}", caps.name);
            let again = recompile(&graph.clone(), caps, &options, &mut scratch, &mut plan);
            assert_eq!(again, Ok(false), "seed {seed}: an equal graph is not recognized");
            assert_eq!(words(&plan), words(&fresh), "seed {seed}, {}", caps.name);
        }
    }
}

#[test]
fn immediate_changes_nothing_of_what_was_declared() {
    for seed in seeds(250) {
        let graph = graph(seed);
        for (index, caps) in presets().iter().enumerate() {
            let options = options(seed, index).immediate();
            let plan = compiled(&graph, caps, &options);
            assert_clean(&plan, seed);
            let order: Vec<_> = plan.running().map(|m| m.pass).collect();
            let declared: Vec<_> = graph.pass_ids().collect();
            assert_eq!(order, declared, "seed {seed}");
            let alone = |s: &Step| s.passes.len == 1;
            assert!(plan.steps().iter().all(alone), "seed {seed}: passes share a step");
            let decided = plan.decisions().iter().find(|d| {
                matches!(
                    d.reason,
                    Reason::MergedAttachments(_)
                        | Reason::MergedSamePixel(_)
                        | Reason::MergedInline(_)
                        | Reason::NotInlined(..)
                        | Reason::Memoryless(_)
                        | Reason::SlotAfter(_)
                        | Reason::PlacedAfter(_)
                        | Reason::OrderMerge(_)
                        | Reason::OrderBytes(_)
                )
            });
            assert_eq!(decided, None, "seed {seed}");
        }
    }
}

#[test]
fn merging_never_adds_loads_or_stores() {
    for seed in seeds(300) {
        let graph = graph(seed);
        for (index, caps) in presets().iter().enumerate() {
            let with = Options { merge: true, inline: true, order: Order::Declared, ..options(seed, index) };
            let without = Options { merge: false, inline: false, ..with };
            let counts = |o: &Options| compiled(&graph, caps, o).counts();
            let (with, without) = (counts(&with), counts(&without));
            let less = with.unresolves <= without.unresolves
                && with.resolves <= without.resolves
                && with.steps <= without.steps;
            assert!(less, "seed {seed}, {}: {with:?}, {without:?}", caps.name);
        }
    }
}

/// Compares steps, stores and traffic. Memory may grow, as with any merge: textures that are dead before the second
/// step of two live next to its attachments in a common step.
#[test]
fn reading_at_the_same_pixel_is_never_worse_than_sampling() {
    let (mut merged, mut cut) = (0, 0);
    for seed in seeds(6000) {
        let mut entropy = Entropy::seeded(seed);
        let profile = Profile { max_passes: 8, plain_accesses: true, ..Profile::default() };
        let narrow = Caps { tile_bytes_per_pixel: 16 + 8 * (seed as u32 % 4), ..Caps::tiler() };
        let caps = if seed % 2 == 0 { narrow } else { generate::caps(&mut entropy) };
        let graph = generate::graph(&mut entropy, &profile);
        let options = Options { order: Order::Declared, merge: true, ..options(seed, 0) };
        let cost = |graph: &Graph| {
            let mut plan = Plan::new();
            compile(graph, &caps, &options, &mut Scratch::new(), &mut plan).ok()?;
            let (c, t) = (plan.counts(), plan.traffic(plan.frame()));
            let room = |d: &&Decision| matches!(d.reason, Reason::Split(_, Refusal::RoomForLater));
            let cuts = plan.decisions().iter().filter(room).count();
            Some(([c.steps.into(), c.unresolves.into(), c.resolves.into(), t.loaded_bytes, t.stored_bytes], cuts))
        };
        if let (Some((same_pixel, cuts)), Some((sampled, _))) = (cost(&graph), cost(&generate::sampling(&graph))) {
            let better = same_pixel.iter().zip(&sampled).all(|(a, b)| a <= b);
            assert!(better, "seed {seed}, {caps:?}, {options:?}: {same_pixel:?}, {sampled:?}");
            merged += usize::from(same_pixel != sampled);
            cut += cuts;
        }
    }
    assert!(seeds(6000).end < 6000 || merged > 300 && cut > 0, "{merged} differ, {cut} steps are cut");
}

#[test]
fn the_optimising_order_is_never_worse() {
    for seed in seeds(250) {
        let graph = graph(seed);
        for (index, caps) in presets().iter().enumerate() {
            let with = Options { order: Order::Optimized, ..options(seed, index) };
            let without = Options { order: Order::Declared, ..with };
            let cost = |o: &Options| {
                let plan = compiled(&graph, caps, o);
                (plan.counts().steps, plan.memory().bytes, plan.traffic(plan.frame()).total_bytes())
            };
            assert!(cost(&with) <= cost(&without), "seed {seed}, {}", caps.name);
        }
    }
}

#[test]
fn the_generator_reaches_what_it_is_meant_to_reach() {
    // Checks that the random graphs cover the relevant features.
    let mut sum = Counts::default();
    let (mut shared, mut full_screen, mut roles, mut kinds) = (0, 0, BTreeSet::new(), BTreeSet::new());
    for seed in 0..800 {
        let graph = graph(seed);
        let plan = compiled(&graph, &presets()[1 + seed as usize % 2], &options_of(0));
        let c = plan.counts();
        sum.inlined += c.inlined;
        sum.memoryless += c.memoryless;
        sum.multisample_resolves += c.multisample_resolves;
        sum.culled += c.culled;
        sum.unresolves += c.unresolves;
        sum.passes += (plan.step_passes().len() - plan.steps().len()) as u32;
        full_screen += plan.step_passes().iter().filter(|m| m.join == Join::Resolve).count();
        let reuse = |r: &Decision| matches!(r.reason, Reason::SlotAfter(_));
        shared += plan.decisions().iter().filter(|d| reuse(d)).count();
        roles.extend(plan.attachments().iter().filter_map(|a| match a.role {
            Role::ResolveDepth(mode) => Some(mode),
            _ => None,
        }));
        kinds.extend(graph.accesses().iter().map(|a| a.kind));
    }
    let enough =
        [sum.inlined, sum.memoryless, sum.multisample_resolves, sum.culled, sum.unresolves, sum.passes, shared as u32];
    assert!(enough.iter().all(|n| *n >= 10) && full_screen >= 10, "{enough:?}, {full_screen}");
    assert_eq!(roles.len(), 1, "depth in the store of the presets: {roles:?}");
    assert_eq!(kinds.len(), 12, "all kinds but vertex and index: {kinds:?}");
}
