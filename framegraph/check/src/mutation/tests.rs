//! Mutation tests of random plans and of hand-made plans, and robustness against two changes.

use super::{Mutant, MutationReport, Mutator, difference, examine, log, mutants, places};
use crate::check::{Rule, WasteKind};
use crate::generate::{self, Entropy, Profile};
use framegraph::internals::arrays;
use framegraph::plan::{Placement, Plan};
use framegraph::{
    Alias, Caps, ClearValue, DeclareError, Dimension, Extent, Format, Graph, Intent, Options, Scratch, TextureDesc,
    compile,
};

/// Returns the seeds of mutated plans: a hundredth of `FRAMEGRAPH_PROPERTY_CASES`.
fn seeds(default: u64) -> std::ops::Range<u64> {
    let asked = std::env::var("FRAMEGRAPH_PROPERTY_CASES").ok();
    let asked = asked.and_then(|n| n.parse::<u64>().ok());
    0..asked.map_or(default, |n| n / 100)
}

/// Examines every mutant of a plan and panics if one is wrongly accepted. Returns the number of mutants.
#[track_caller]
fn kill_all(good: &Plan, name: &str) -> usize {
    let report = examine(good);
    assert!(report.is_clean(), "{name}: {report}");
    let mut report = MutationReport::default();
    report.take(good);
    let MutationReport { mutants, alive, .. } = report;
    let text = framegraph::dump::text(good);
    assert!(
        alive.is_empty(),
        "{name}: {} of {mutants} mutants are accepted:\n{}\n{text}",
        alive.len(),
        alive.join("\n")
    );
    mutants
}

fn compiled(graph: &Graph, caps: &Caps, options: &Options) -> Plan {
    let mut plan = Plan::new();
    let outcome = compile(graph, caps, options, &mut Scratch::new(), &mut plan);
    assert_eq!(outcome, Ok(()));
    plan
}

#[test]
fn no_mutant_of_a_random_plan_lives() {
    let mut count = 0;
    let profile = Profile { max_passes: 5, ..Profile::default() };
    for seed in seeds(9) {
        let graph = generate::graph(&mut Entropy::seeded(seed), &profile);
        let caps = generate::capable([Caps::wgpu(), Caps::tiler(), Caps::desktop()][seed as usize % 3].clone());
        let number = if seed % 2 == 0 { 0 } else { seed as u32 * 7 };
        let plan = compiled(&graph, &caps, &generate::options_of(number));
        count += kill_all(&plan, &format!("seed {seed}, options {number}"));
    }
    assert!(seeds(9).end != 9 || count > 5_000, "only {count} mutants");
}

/// Returns a frame with a unique reason for every decision: depth is written, tested and sampled; color is modified,
/// filtered and exported; one pass is culled.
fn plain_frame() -> Graph {
    let texture = |format| TextureDesc::new(Extent::absolute(8, 8), format);
    let mut g = Graph::new();
    let (z, hdr) = (g.texture("z", texture(Format::Depth32Float)), g.texture("hdr", texture(Format::Rgba16Float)));
    let declared = (|| {
        let (z, hdr) = g.add_fn("draw", |p| {
            Ok((p.depth(z, Intent::Clear(ClearValue::FAR))?, p.color(hdr, Intent::Clear(ClearValue::BLACK))?))
        })?;
        let fog = g.texture("fog", texture(Format::R8Unorm).extent(Extent::absolute(4, 4)));
        let fog = g.add_fn("fog", |p| {
            p.sampled(z)?;
            p.color(fog, Intent::Overwrite)
        })?;
        g.add_fn("unused", |p| p.sampled(fog).map(drop))?;
        let hdr = g.add_fn("blend", |p| {
            p.sampled(fog)?;
            p.color(hdr, Intent::Modify)
        })?;
        let ldr = g.texture("ldr", texture(Format::Rgba8Unorm));
        let ldr = g.add_fn("grade", |p| {
            p.sampled(hdr)?;
            p.color(ldr, Intent::Overwrite)
        })?;
        g.export(ldr)?;
        Ok::<(), DeclareError>(())
    })();
    assert_eq!(declared, Ok(()));
    g
}

#[test]
fn a_frame_with_one_answer_to_each_question_leaves_no_other() {
    let plan = compiled(&plain_frame(), &Caps::desktop(), &generate::options_of(0));
    let mut other = Vec::new();
    mutants(&plan, &mut |mutant| {
        if mutant.field == "decision.reason" && examine(&mutant.plan).is_clean() {
            other.push(difference(&plan, &mutant));
        }
    });
    // A stored and sampled depth attachment needs memory for several reasons, and a pass of another size differs in
    // several ways. All other decisions have a unique reason.
    let known = |d: &&String| d.contains("NeedsMemory") || d.contains("Split");
    let unknown: Vec<_> = other.iter().filter(|d| !known(d)).collect();
    assert!(unknown.is_empty(), "{unknown:#?}");
    assert!(other.len() <= 8, "{other:#?}");
    kill_all(&plan, "plain frame");
}

#[test]
fn no_mutant_of_a_plan_with_slices_lives() {
    let mut g = Graph::new();
    let desc = TextureDesc::new(Extent::absolute(8, 8), Format::Rgba8Unorm);
    let volume = g.texture("volume", TextureDesc { dimension: Dimension::D3, ..desc.layers(3) });
    let screen = g.texture("screen", desc);
    let declared = (|| {
        let volume = g.add_fn("first", |p| p.color(volume.layer(0), Intent::Clear(ClearValue::BLACK)))?;
        let volume = g.add_fn("two", |p| {
            let volume = p.color(volume.layer(1), Intent::Overwrite)?;
            p.color(volume.layer(2), Intent::Clear(ClearValue::BLACK))
        })?;
        let volume = g.add_fn("again", |p| p.color(volume.layer(0), Intent::Modify))?;
        let screen = g.add_fn("use", |p| {
            p.sampled(volume)?;
            p.color(screen, Intent::Overwrite)
        })?;
        g.export(screen)?;
        Ok::<(), DeclareError>(())
    })();
    assert_eq!(declared, Ok(()));
    for caps in [Caps::wgpu(), Caps::tiler(), Caps::desktop()] {
        kill_all(&compiled(&g, &caps, &generate::options_of(0)), &caps.name);
    }
}

#[test]
fn the_oracle_survives_any_mutant() {
    // Two changes at the same time: inconsistent arrays must not cause a panic.
    let plan = compiled(&plain_frame(), &Caps::tiler(), &generate::options_of(0));
    let mut firsts = Vec::new();
    mutants(&plan, &mut |mutant| firsts.push(mutant.plan));
    let mut count = 0;
    for plan in firsts.iter().step_by(41) {
        let mut seen = 0;
        let visit = &mut |second: Mutant| {
            seen += 1;
            if seen % 31 == 0 {
                count += usize::from(!examine(&second.plan).is_clean());
            }
        };
        let mut mutator = Mutator { plan, visit };
        places::resources(&mut mutator);
        places::slots(&mut mutator);
        log::decisions(&mut mutator);
        log::barriers(&mut mutator);
    }
    assert!(count > 100, "only {count} broken plans");
}

/// Two textures, with the larger one read first, whose memory a third one reuses.
fn two_make_room() -> Result<Graph, DeclareError> {
    let mut g = Graph::new();
    let texture = |height| TextureDesc::new(Extent::absolute(256, height), Format::Rgba8Unorm);
    let [a, b, c] = [("a", 128), ("b", 64), ("c", 192)].map(|(name, height)| g.texture(name, texture(height)));
    let (a, b) =
        g.add_fn("make", |p| Ok((p.storage_write(a, Intent::Overwrite)?, p.storage_write(b, Intent::Overwrite)?)))?;
    let look = |g: &mut Graph, texture| {
        g.add_fn("look", |p| {
            p.side_effect();
            p.sampled(texture).map(drop)
        })
    };
    look(&mut g, a)?;
    look(&mut g, b)?;
    let c = g.add_fn("large", |p| p.storage_write(c, Intent::Overwrite))?;
    look(&mut g, c)?;
    Ok(g)
}

#[test]
fn the_later_of_two_earlier_tenants_hands_over() {
    let graph = two_make_room().unwrap_or_else(|error| panic!("{error}"));
    let plan = compiled(&graph, &Caps::desktop(), &Options { alias: Alias::Heap, ..Options::default() });
    assert_eq!(plan.memory().bytes, 256 * 192 * 4, "the third overlaps both");
    let offset = |name| graph.find_resource(name).map(|r| plan.resources()[r.index()].placement);
    assert_eq!(offset("a"), Some(Placement::Heap { offset: 0 }), "the one at offset 0 is read first");
    let mut takers = plan.barriers().iter().filter(|b| !b.aliases.is_none());
    assert_eq!(takers.next().map(|b| graph.resource_name(b.aliases)), Some("b"));
    kill_all(&plan, "two tenants");
}

/// Returns the violated rules, except for the log, and the kinds of waste.
fn objections(plan: &Plan) -> (Vec<Rule>, Vec<WasteKind>) {
    let report = examine(plan);
    let rules = report.violations.iter().map(|v| v.rule).filter(|rule| *rule != Rule::Decision);
    (rules.collect(), report.wastes.iter().map(|w| w.kind).collect())
}

#[test]
fn an_offset_that_is_not_aligned_is_reported_though_nothing_overlaps() {
    // The small resource ends before the large one, which reuses its memory, begins.
    let mut graph = Graph::new();
    for (name, height) in [("small", 64), ("large", 512)] {
        let texture = graph.texture(name, TextureDesc::new(Extent::absolute(256, height), Format::Rgba8Unorm));
        let made = graph.add_fn(name, |p| {
            p.side_effect();
            p.storage_write(texture, Intent::Overwrite)
        });
        graph.add_fn("look", |p| p.sampled(made.clone()?).map(drop)).unwrap_or_else(|error| panic!("{error}"));
    }
    let good = compiled(&graph, &Caps::desktop(), &Options { alias: Alias::Heap, ..Options::default() });
    assert_eq!(objections(&good), (vec![], vec![]));
    let small = graph.find_resource("small").expect("the resource was declared").index();
    assert_eq!(good.resources()[small].placement, Placement::Heap { offset: 0 });
    for (offset, rules) in [(256, vec![Rule::Placement]), (1 << 16, vec![])] {
        let mut moved = good.clone();
        arrays(&mut moved).resources[small].placement = Placement::Heap { offset };
        assert_eq!(objections(&moved), (rules, vec![]), "{offset}");
    }
}

#[test]
fn memory_for_what_never_leaves_the_tile_is_waste() {
    let mut graph = Graph::new();
    let texture = |format| TextureDesc::new(Extent::absolute(8, 8), format);
    let (z, out) = (graph.texture("z", texture(Format::Depth32Float)), graph.texture("out", texture(Format::R8Unorm)));
    let out = graph.add_fn("draw", |p| {
        p.depth(z, Intent::Clear(ClearValue::FAR))?;
        p.color(out, Intent::Clear(ClearValue::BLACK))
    });
    graph.export(out.unwrap_or_else(|error| panic!("{error}"))).expect("the handle is the newest version");
    let mut plan = compiled(&graph, &Caps::tiler(), &Options { memoryless: false, ..Options::default() });
    assert_eq!(objections(&plan), (vec![], vec![]));
    arrays(&mut plan).options.memoryless = true;
    assert_eq!(objections(&plan), (vec![], vec![WasteKind::Memory]));
}

#[test]
fn an_average_that_nothing_needs_is_waste() {
    let mut graph = Graph::new();
    let texture = |samples| TextureDesc::new(Extent::absolute(8, 8), Format::Rgba8Unorm).samples(samples);
    let (ms, average) = (graph.texture("ms", texture(4)), graph.texture("average", texture(1)));
    let drawn = graph.add_fn("draw", |p| {
        let ms = p.color(ms, Intent::Clear(ClearValue::BLACK))?;
        p.resolve(ms, average)?;
        Ok(ms)
    });
    graph.export(drawn.unwrap_or_else(|error| panic!("{error}"))).expect("the handle is the newest version");
    let mut plan = compiled(&graph, &Caps::tiler(), &Options { cull: false, ..Options::default() });
    assert_eq!(objections(&plan), (vec![], vec![]));
    arrays(&mut plan).options.cull = true;
    assert_eq!(objections(&plan), (vec![], vec![WasteKind::Resolve]));
    // With culling disabled, no declared resolve is dropped.
    let mut plan = compiled(&graph, &Caps::tiler(), &Options::default());
    assert_eq!(objections(&plan), (vec![], vec![]));
    arrays(&mut plan).options.cull = false;
    assert_eq!(objections(&plan), (vec![Rule::Attachments], vec![]));
}
