//! The control: plans with one decision broken must not pass the comparison.

use super::case::{Case, Runner};
use super::copy::{Copy, copies};
use super::{options, spec};
use crate::bench::{TestResult, on_adapter, skip};
use framegraph::testing::generate::{self, Entropy, Profile};
use framegraph::testing::mutation::mutants;
use framegraph::{
    AccessKind, Alias, Attachment, Desc, Extent, Format, Join, LoadOp, Mode, Options, PassKind, Placement, Plan,
    ResourceId, Role, StepId, StoreOp,
};
use std::collections::BTreeMap;

/// One decision broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// What is loaded is cleared instead.
    LoadToClear,
    /// What is loaded may be anything instead.
    LoadToDontCare,
    /// What is stored is dropped instead.
    StoreToDiscard,
    /// Two resources that are in use at once share a place.
    SharedPlace,
}

const KINDS: [Kind; 4] = [Kind::LoadToClear, Kind::LoadToDontCare, Kind::StoreToDiscard, Kind::SharedPlace];

/// A broken plan.
struct Fault {
    kind: Kind,
    /// The row of the attachment, or of the resource that was moved.
    row: usize,
    field: &'static str,
    plan: Plan,
}

/// What became of the faults of one kind.
#[derive(Debug, Default)]
struct Tried {
    /// The comparison shows them.
    shown: u64,
    /// They change nothing, for the reasons that [`changes_nothing`] knows.
    without_effect: u64,
}

/// The mutants of a plan that this test is about.
fn faults(good: &Plan) -> Vec<Fault> {
    let mut faults = Vec::new();
    mutants(good, &mut |mutant| {
        let (field, row) = (mutant.field, mutant.row);
        // A field of a plane that the format does not have means nothing.
        if field.starts_with("attachment") {
            let format = good.format(good.attachments()[row].resource);
            let has =
                |f: Format| if field.contains("stencil") { f.has_stencil() } else { f.has_depth() || !f.has_stencil() };
            if !format.is_some_and(has) {
                return;
            }
        }
        let kind = match field {
            "attachment.load" => loaded(good.attachments()[row].load, mutant.plan.attachments()[row].load),
            "attachment.stencil_load" => {
                loaded(good.attachments()[row].stencil_load, mutant.plan.attachments()[row].stencil_load)
            }
            "attachment.store" => stored(good.attachments()[row].store, mutant.plan.attachments()[row].store),
            "attachment.stencil_store" => {
                stored(good.attachments()[row].stencil_store, mutant.plan.attachments()[row].stencil_store)
            }
            "resource.placement" => shared(good, row, mutant.plan.resources()[row].placement),
            _ => None,
        };
        faults.extend(kind.map(|kind| Fault { kind, row, field, plan: mutant.plan }));
    });
    faults
}

fn loaded(good: LoadOp, broken: LoadOp) -> Option<Kind> {
    match (good, broken) {
        (LoadOp::Load, LoadOp::Clear) => Some(Kind::LoadToClear),
        (LoadOp::Load, LoadOp::DontCare) => Some(Kind::LoadToDontCare),
        _ => None,
    }
}

fn stored(good: StoreOp, broken: StoreOp) -> Option<Kind> {
    (good == StoreOp::Store && broken == StoreOp::Discard).then_some(Kind::StoreToDiscard)
}

/// Whether a resource moves to the place of another one of its shape that is in use at the same time, and no step uses it
/// together with any that has this place: wgpu itself refuses one texture in two uses of a step.
fn shared(plan: &Plan, row: usize, broken: Placement) -> Option<Kind> {
    let Placement::Slot(slot) = broken else { return None };
    let graph = plan.graph();
    let good = &plan.resources()[row];
    let fits = matches!(good.placement, Placement::Slot(_))
        && solid(plan, graph.resources()[row].desc) == solid(plan, plan.slots()[slot.index()].desc);
    let others: Vec<_> = graph.resource_ids().filter(|r| plan.resources()[r.index()].placement == broken).collect();
    let touches = |step: StepId, resource: usize| {
        let mut accesses = plan.passes_of(step).iter().flat_map(|m| graph.accesses_of(m.pass));
        accesses.any(|a| a.resource.index() == resource)
    };
    let at_once = |other: &ResourceId| {
        let second = &plan.resources()[other.index()];
        good.first <= second.last && second.first <= good.last
    };
    let in_one_step =
        |other: &ResourceId| plan.step_ids().any(|step| touches(step, row) && touches(step, other.index()));
    (fits && others.iter().any(at_once) && !others.iter().any(in_one_step)).then_some(Kind::SharedPlace)
}

/// A shape with its size counted out.
fn solid(plan: &Plan, desc: Desc) -> Desc {
    let Desc::Texture(texture) = desc else { return desc };
    let [width, height] = texture.extent.texels(plan.frame());
    let mips = texture.mip_count(plan.frame()) as u8;
    Desc::Texture(texture.extent(Extent::absolute(width, height)).mips(mips))
}

/// Why a fault may go unnoticed: wgpu has no operations for an attachment that is read only, and contents that passes
/// only draw over, until somebody drops or replaces them, show nowhere.
fn changes_nothing(plan: &Plan, fault: &Fault) -> bool {
    if fault.kind == Kind::SharedPlace {
        let placement = fault.plan.resources()[fault.row].placement;
        let rows: Vec<_> = plan.graph().resource_ids().zip(plan.resources()).collect();
        let others = rows.iter().filter(|(_, row)| row.placement == placement);
        // Nothing comes any more of the earlier one when the later one begins, whoever has the place.
        return others.into_iter().all(|other| done_before(plan, rows[fault.row], *other));
    }
    let holds = |s: &StepId| plan.steps()[s.index()].attachments.range().contains(&fault.row);
    let Some(step) = plan.step_ids().find(holds) else { return false };
    let row = &plan.attachments()[fault.row];
    let tests_it = fault.kind != Kind::StoreToDiscard && is_tested(plan, step, row.resource);
    row.role == Role::DepthReadOnly || (!tests_it && dies(plan, step, row))
}

type Row<'p> = (ResourceId, &'p framegraph::Planned);

/// Whether nothing comes any more of what the earlier of two resources holds when the later one begins.
fn done_before(plan: &Plan, a: Row<'_>, b: Row<'_>) -> bool {
    let (earlier, later) = if a.1.first <= b.1.first { (a, b) } else { (b, a) };
    seen_until(plan, earlier.0).is_none_or(|last| last < later.1.first)
}

/// Whether a pass of the step draws color where depth or stencil of the resource let it.
fn is_tested(plan: &Plan, step: StepId, resource: ResourceId) -> bool {
    let drawn = plan.passes_of(step).iter().filter(|m| m.join != Join::Resolve);
    let passes = drawn.map(|m| plan.graph().accesses_of(m.pass));
    let mut tested = passes.filter(|accesses| accesses.iter().any(|a| a.kind.is_depth() && a.resource == resource));
    tested.any(|accesses| accesses.iter().any(|a| a.kind == AccessKind::Color))
}

/// The last step in which anything comes of what a resource holds.
fn seen_until(plan: &Plan, resource: ResourceId) -> Option<StepId> {
    plan.step_ids().rev().find(|step| {
        let mut accesses = plan.passes_of(*step).iter().flat_map(|m| plan.graph().accesses_of(m.pass));
        let mut attached = plan.attachments_of(*step).iter().filter(|a| a.resource == resource);
        accesses.any(|a| a.resource == resource && !a.kind.is_attachment())
            || plan.full_screen_resolves(*step).any(|(samples, _)| samples.resource == resource)
            || attached.any(|a| is_tested(plan, *step, a.resource) || !dies(plan, *step, a))
    })
}

/// Whether what an attachment holds after a step is dropped or replaced before anybody but its own passes sees it.
fn dies(plan: &Plan, step: StepId, row: &Attachment) -> bool {
    if !row.stores() {
        return row.store == StoreOp::Discard;
    }
    let graph = plan.graph();
    for later in plan.step_ids().filter(|s| *s > step) {
        let attached = plan
            .attachments_of(later)
            .iter()
            .find(|a| (a.resource, a.mip, a.layer) == (row.resource, row.mip, row.layer) && !a.role.is_resolve());
        let members = plan.passes_of(later).iter().filter(|m| !matches!(m.join, Join::Inlined | Join::Resolve));
        let mut accesses = members.flat_map(|m| graph.accesses_of(m.pass));
        // What is only written over in memory, in part, depends on nothing that was there.
        let touched = accesses.any(|a| a.resource == row.resource && !a.kind.is_attachment() && a.mode == Mode::Read)
            || plan.full_screen_resolves(later).any(|(samples, _)| samples.resource == row.resource);
        match attached {
            _ if is_copied_over(plan, later, row) => return true,
            _ if touched || is_tested(plan, later, row.resource) => return false,
            Some(next) => return !next.loads() || dies(plan, later, next),
            None => {}
        }
    }
    let exported = graph.exports().iter().any(|e| e.resource == row.resource);
    graph.resources()[row.resource.index()].kind == framegraph::Kind::Transient && !exported
}

/// Whether a copy goes over all that an attachment held.
fn is_copied_over(plan: &Plan, step: StepId, row: &Attachment) -> bool {
    let graph = plan.graph();
    let all = spec::texels(graph, row.resource, row.mip);
    plan.passes_of(step).iter().filter(|m| plan.graph().passes()[m.pass.index()].kind == PassKind::Copy).any(|m| {
        let made = copies(graph, m.pass).unwrap_or_default();
        made.into_iter().any(|copy| {
            let Copy::Texture { into, texels, .. } = copy else { return false };
            let resource = graph.accesses_of(m.pass)[into.access].resource;
            (resource, into.mip, into.layer, texels) == (row.resource, row.mip, row.layer, all)
        })
    })
}

/// Graphs whose faults are all tried.
const GRAPHS: u64 = 100;
/// How many faults of each kind must be shown.
const SHOWN: u64 = 5;

/// The case of a seed: culled, so that everything is there for something that is compared, and half of the time with a
/// place for every resource, so that there are places to be mixed up. Two textures that could be one and are never in one
/// step are rare: later seeds make graphs of textures alone, where they are not.
fn prepared(runner: &mut Runner, seed: u64) -> Result<Option<Case>, String> {
    let alias = if seed.is_multiple_of(2) { Alias::Off } else { Alias::Pool };
    let options = Options { cull: true, alias, ..options(seed as u32) };
    let profile = Profile { plain: seed >= GRAPHS, volumes: false, plain_accesses: true, ..Profile::default() };
    Ok(runner.prepare(generate::graph(&mut Entropy::seeded(seed), &profile), &options)?.ok())
}

/// Whether the comparison shows a broken plan, with contents that may be anything made loud.
fn shows(runner: &mut Runner, seed: u64, fault: &Fault) -> Result<bool, String> {
    let Some(case) = prepared(runner, seed)? else { return Err("it was prepared before".into()) };
    let Fault { kind, row, field, .. } = fault;
    let verdict = runner.run(&case.planned(fault.plan.clone()), true)?;
    verdict.map(|v| !v.differences.is_empty()).map_err(|why| format!("seed {seed}: {kind:?}, {field} {row}: {why}"))
}

#[test]
fn a_broken_plan_is_seen() -> TestResult {
    const NAME: &str = "a_broken_plan_is_seen";
    on_adapter(NAME, |gpu| {
        if let Some(why) = Runner::unfit(gpu) {
            return skip(NAME, why);
        }
        let mut runner = Runner::new(gpu)?;
        let mut tried: BTreeMap<Kind, Tried> = KINDS.into_iter().map(|k| (k, Tried::default())).collect();
        for seed in 0..1000 {
            if seed >= GRAPHS && tried[&Kind::SharedPlace].shown >= SHOWN {
                break;
            }
            let Some(good) = prepared(&mut runner, seed)? else { continue };
            let mut faults = faults(&good.plan);
            faults.retain(|f| seed < GRAPHS || f.kind == Kind::SharedPlace);
            if faults.is_empty() {
                continue;
            }
            let Ok(verdict) = runner.run(&good, true)? else { continue };
            assert_eq!(verdict.differences, Vec::<String>::new(), "seed {seed}");
            // What nobody may rely on, and what no pass shows, cannot tell.
            if verdict.unknown + verdict.unknown_digests + verdict.unobserved > 0 {
                continue;
            }
            for fault in &faults {
                let row = tried.entry(fault.kind).or_default();
                if shows(&mut runner, seed, fault)? {
                    row.shown += 1;
                    continue;
                }
                row.without_effect += 1;
                // What was cleared to zero before is zero when it is cleared again: it is loud when it may be anything.
                let twin = |f: &&Fault| (f.field, f.row, f.kind) == (fault.field, fault.row, Kind::LoadToDontCare);
                let loud = match fault.kind {
                    Kind::LoadToClear => faults.iter().find(twin),
                    _ => None,
                };
                let cleared_twice = loud.map_or(Ok(false), |f| shows(&mut runner, seed, f))?;
                assert!(
                    cleared_twice || changes_nothing(&good.plan, fault),
                    "seed {seed}: {:?}, {} {} goes unnoticed\n{}",
                    fault.kind,
                    fault.field,
                    fault.row,
                    framegraph::dump::text(&good.plan)
                );
            }
        }
        println!("{tried:#?}");
        assert!(tried.values().all(|t| t.shown >= SHOWN), "each kind must be seen a few times");
        Ok(())
    })
}
