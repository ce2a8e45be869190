//! Is the oracle awake? Good plans, broken in one place at a time: each mutant must be reported, as a violation or as
//! waste. What it may overlook is listed in [`excuse`], each with the proof that the field does not matter there.

mod log;
mod places;
mod steps;

use super::{Rule, examine};
use crate::generate::{self, Entropy, Profile};
use crate::plan::{LoadOp, Placement, Plan};
use crate::{
    Alias, Caps, ClearValue, Extent, Format, Graph, Intent, Options, Order, Reason, Scratch, TextureDesc, compile,
};

/// One broken plan.
pub(super) struct Mutant {
    /// Which field was changed.
    field: &'static str,
    /// The row of the field's array.
    row: usize,
    plan: Plan,
}

/// A change of one row, with the field's name.
type Edit<T> = (&'static str, fn(&mut T));

/// Makes the mutants of one plan.
pub(super) struct Mutator<'a> {
    plan: &'a Plan,
    visit: &'a mut dyn FnMut(Mutant),
}

impl Mutator<'_> {
    /// The plan with one change.
    fn with(&mut self, field: &'static str, row: usize, edit: impl FnOnce(&mut Plan)) {
        let mut plan = self.plan.clone();
        edit(&mut plan);
        (self.visit)(Mutant { field, row, plan });
    }
}

/// Visits every mutant of a plan.
fn mutants(plan: &Plan, visit: &mut dyn FnMut(Mutant)) {
    let mut mutator = Mutator { plan, visit };
    mutator.with("valid", 0, |p| p.valid = false);
    steps::steps(&mut mutator);
    steps::attachments(&mut mutator);
    places::resources(&mut mutator);
    places::slots(&mut mutator);
    places::memory(&mut mutator);
    log::decisions(&mut mutator);
    log::barriers(&mut mutator);
}

/// Why a mutant that the oracle does not report is as good as the plan; none when it is not.
fn excuse(good: &Plan, mutant: &Mutant) -> Option<&'static str> {
    let Mutant { field, row, plan } = mutant;
    match *field {
        "attachment.clear" => {
            let a = plan.attachments[*row];
            if a.load != LoadOp::Clear && a.stencil_load != LoadOp::Clear {
                return Some("a clear value is read by clear ops only, and neither op clears");
            }
            let value = |p: &Plan| p.graph.clears[p.attachments[*row].clear as usize];
            let same = value(good).same_bits(&value(plan));
            same.then_some("the other index holds the same value, bit for bit")
        }
        "memory.peak" => {
            // Which of several fullest steps is named is free in a heap.
            let heap = good.options.alias == Alias::Heap && good.caps.placed;
            heap.then_some("as many bytes are live in the other step")
        }
        "memory.lower_bound" => {
            // A bound that no packing reached: only a search could tell whether it holds.
            let open = !good.memory.optimal && good.options.alias == Alias::Heap;
            open.then_some("between the peak and the top any bound might hold")
        }
        "resource.offset" => moved_freely(good, plan, *row),
        "step order" => {
            // The run shows that the exchanged steps do not touch each other; the log tells of the old order.
            let free = good.options.order == Order::Optimized;
            let told = !examine(plan).is_clean();
            (free && told).then_some("any order in which every read is right would do")
        }
        "barrier.hand_over" => {
            let named = |p: &Plan| p.resources[p.barriers[*row].hand_over.index()].last;
            let tie = named(good) == named(plan);
            tie.then_some("both tenants had the memory until the same step")
        }
        "decision.reason" => {
            let (from, to) = (good.decisions[*row].reason, plan.decisions[*row].reason);
            may_replace(from, to).then_some("both reasons are true, and one is enough")
        }
        _ => None,
    }
}

/// An offset in a heap that serves as well: aligned, below the same top, over no live neighbour, after the same tenant.
fn moved_freely(good: &Plan, mutant: &Plan, row: usize) -> Option<&'static str> {
    let range = |p: &Plan, r: usize| match p.resources[r].placement {
        Placement::Heap { offset } => Some((offset, offset + p.resources[r].bytes.max(1))),
        _ => None,
    };
    let own = &mutant.resources[row];
    let (start, end) = range(mutant, row)?;
    for (other, neighbour) in good.resources.iter().enumerate() {
        let Some((s, e)) = range(good, other).filter(|_| other != row) else {
            continue;
        };
        let alive = neighbour.first <= own.last && own.first <= neighbour.last;
        if alive && start < e && s < end {
            return None;
        }
    }
    Some("any aligned place below the top that nobody alive has is as good")
}

/// Whether two reasons answer the same question, so that both can be true at once.
fn may_replace(from: Reason, to: Reason) -> bool {
    question(from) == question(to) && question(from) != 0
}

/// Questions that can have several true answers; 0 for those that have one.
fn question(reason: Reason) -> u8 {
    use Reason as R;
    match reason {
        // A pass can be needed for several outputs, by several readers.
        R::KeptSideEffect | R::KeptExport(_) | R::KeptImport(_) | R::KeptHistory(_) | R::KeptReadBy(..) => 1,
        // Several outputs and parts can be in vain, each in its way.
        R::CulledUnread(_) | R::CulledReaderCulled(..) | R::CulledOverwritten(..) => 2,
        // Several objections can stand.
        R::Split(..) => 3,
        R::NotInlined(..) => 4,
        R::NeedsMemory(_) => 5,
        // Several parts can be loaded, stored, dropped.
        R::LoadWritten(_) | R::LoadEntry => 6,
        R::StoreReadBy(_) | R::StoreExport | R::StoreImport | R::StoreHistory => 7,
        R::DiscardUnread | R::DiscardOverwritten | R::StoreUnchanged => 8,
        _ => 0,
    }
}

/// How many plans are mutated: the share of what `FRAMEGRAPH_PROPERTY_CASES` asks for, which is made for whole properties.
fn seeds(default: u64) -> std::ops::Range<u64> {
    let asked = std::env::var("FRAMEGRAPH_PROPERTY_CASES").ok();
    let asked = asked.and_then(|n| n.parse::<u64>().ok());
    0..asked.map_or(default, |n| n / 100)
}

/// Whether the oracle reports a mutant. The decision log is full of echoes of the plan, so where the log itself is not what
/// was changed, something else than its truth must be reported.
fn is_caught(mutant: &Mutant) -> bool {
    let report = examine(&mutant.plan);
    let log = mutant.field.starts_with("decision");
    let mut violations = report.violations.iter();
    violations.any(|v| log || v.rule != Rule::Decision) || !report.wastes.is_empty()
}

/// Examines every mutant of a plan and panics with those that live without an excuse. Returns how many there were.
#[track_caller]
fn kill_all(good: &Plan, name: &str) -> usize {
    let report = examine(good);
    assert!(report.is_clean(), "{name}: {report}");
    let (mut count, mut alive) = (0, Vec::new());
    mutants(good, &mut |mutant| {
        count += 1;
        if !is_caught(&mutant) && excuse(good, &mutant).is_none() {
            alive.push(format!("{} of row {}: {}", mutant.field, mutant.row, difference(good, &mutant)));
        }
    });
    if std::env::var("STAT").is_ok() {
        for a in &alive {
            println!("ALIVE {name} {} {} {a}", good.caps.name, good.options.alias as u8);
        }
        return count;
    }
    assert!(
        alive.is_empty(),
        "{name}: {} of {count} mutants live:\n{}\n{}",
        alive.len(),
        alive.join("\n"),
        crate::dump::text(good)
    );
    count
}

/// What was changed, in words.
fn difference(good: &Plan, mutant: &Mutant) -> String {
    let rows = |p: &Plan| {
        let Plan { pass_steps, steps, step_passes, attachments, resources, slots, barriers, memory, decisions, .. } =
            p.clone();
        let mut words: Vec<String> = vec![format!("{pass_steps:?}"), format!("{memory:?}")];
        words.extend(steps.iter().map(|r| format!("{r:?}")));
        words.extend(step_passes.iter().map(|r| format!("{r:?}")));
        words.extend(attachments.iter().map(|r| format!("{r:?}")));
        words.extend(resources.iter().map(|r| format!("{r:?}")));
        words.extend(slots.iter().map(|r| format!("{r:?}")));
        words.extend(barriers.iter().map(|r| format!("{r:?}")));
        words.extend(decisions.iter().map(|r| format!("{r:?}")));
        words
    };
    let (before, after) = (rows(good), rows(&mutant.plan));
    let changed = before.iter().zip(&after).find(|(a, b)| a != b);
    changed.map_or_else(String::new, |(a, b)| format!("{a} became {b}"))
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
        let caps = [Caps::wgpu(), Caps::tiler(), Caps::desktop()][seed as usize % 3].clone();
        let number = if seed % 2 == 0 { 0 } else { seed as u32 * 7 };
        let plan = compiled(&graph, &caps, &generate::options_of(number));
        count += kill_all(&plan, &format!("seed {seed}, options {number}"));
    }
    assert!(seeds(9).end != 9 || count > 5_000, "only {count} mutants");
}

/// A frame in which every question of the log has one answer: depth is laid down, tested and sampled, color is modified
/// once, filtered, and exported; one pass is culled.
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
        g.export(ldr);
        Ok::<(), crate::DeclareError>(())
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
    // A depth attachment that is stored and sampled has memory for several reasons, a pass of another size differs in
    // more than that; nothing else has a second answer.
    let known = |d: &&String| d.contains("NeedsMemory") || d.contains("Split");
    let unknown: Vec<_> = other.iter().filter(|d| !known(d)).collect();
    assert!(unknown.is_empty(), "{unknown:#?}");
    assert!(other.len() <= 8, "{other:#?}");
    kill_all(&plan, "plain frame");
}

#[test]
fn the_oracle_survives_any_mutant() {
    // Two changes at once: arrays that fit each other nowhere must not make it panic.
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
