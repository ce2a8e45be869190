//! Negative control: plans with one broken decision must fail the comparison.

use super::case::{Case, Runner};
use super::copy::{Copy, copies};
use super::{options, spec};
use crate::bench::{TestResult, on_adapter, skip};
use framegraph::{
    AccessKind, Alias, Attachment, Desc, Extent, Format, Join, LoadOp, Mode, Options, PassKind, Placement, Plan,
    ResourceId, Role, StepId, StoreOp,
};
use framegraph_check::generate::{self, Entropy, Profile};
use framegraph_check::mutation::mutants;
use std::collections::BTreeMap;

/// A kind of broken decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// A load becomes a clear.
    LoadToClear,
    /// A load becomes don't-care.
    LoadToDontCare,
    /// A store becomes a discard.
    StoreToDiscard,
    /// Two resources with overlapping lifetimes share a slot.
    SharedPlace,
}

const KINDS: [Kind; 4] = [Kind::LoadToClear, Kind::LoadToDontCare, Kind::StoreToDiscard, Kind::SharedPlace];

/// A plan with one broken decision.
struct Fault {
    kind: Kind,
    /// Row of the changed attachment or resource.
    row: usize,
    field: &'static str,
    plan: Plan,
}

/// Results of the faults of one kind.
#[derive(Debug, Default)]
struct Tried {
    /// Number of faults that the comparison detects.
    shown: u64,
    /// Number of faults without effect, according to [`changes_nothing`].
    without_effect: u64,
}

/// Returns the mutants of a plan that this test covers.
fn faults(good: &Plan) -> Vec<Fault> {
    let mut faults = Vec::new();
    mutants(good, &mut |mutant| {
        let (field, row) = (mutant.field, mutant.row);
        // Fields of planes that the format does not have are ignored.
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

/// Returns whether a resource moves to the slot of another one with overlapping lifetime. No step may use it together
/// with a resource of that slot, which wgpu would reject.
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

/// Returns a description with its size in texels.
fn solid(plan: &Plan, desc: Desc) -> Desc {
    let Desc::Texture(texture) = desc else { return desc };
    let [width, height] = texture.extent.texels(plan.frame());
    let mips = texture.mip_count(plan.frame()) as u8;
    Desc::Texture(texture.extent(Extent::absolute(width, height)).mips(mips))
}

/// Returns whether a fault cannot be detected. Read-only attachments have no operations in wgpu. Contents that passes
/// only draw over, until they are discarded or replaced, are never read.
fn changes_nothing(plan: &Plan, fault: &Fault) -> bool {
    if fault.kind == Kind::SharedPlace {
        let placement = fault.plan.resources()[fault.row].placement;
        let rows: Vec<_> = plan.graph().resource_ids().zip(plan.resources()).collect();
        let others = rows.iter().filter(|(_, row)| row.placement == placement);
        // The earlier resource is no longer read when the later one begins.
        return others.into_iter().all(|other| done_before(plan, rows[fault.row], *other));
    }
    let holds = |s: &StepId| plan.steps()[s.index()].attachments.range().contains(&fault.row);
    let Some(step) = plan.step_ids().find(holds) else { return false };
    let row = &plan.attachments()[fault.row];
    let tests_it = fault.kind != Kind::StoreToDiscard && is_tested(plan, step, row.resource);
    row.role == Role::DepthReadOnly || (!tests_it && dies(plan, step, row))
}

type Row<'p> = (ResourceId, &'p framegraph::Planned);

/// Returns whether the earlier of two resources is no longer read when the later one begins.
fn done_before(plan: &Plan, a: Row<'_>, b: Row<'_>) -> bool {
    let (earlier, later) = if a.1.first <= b.1.first { (a, b) } else { (b, a) };
    seen_until(plan, earlier.0).is_none_or(|last| last < later.1.first)
}

/// Returns whether a pass of the step draws color depending on the depth or stencil of the resource.
fn is_tested(plan: &Plan, step: StepId, resource: ResourceId) -> bool {
    let drawn = plan.passes_of(step).iter().filter(|m| m.join != Join::Resolve);
    let passes = drawn.map(|m| plan.graph().accesses_of(m.pass));
    let mut tested = passes.filter(|accesses| accesses.iter().any(|a| a.kind.is_depth() && a.resource == resource));
    tested.any(|accesses| accesses.iter().any(|a| a.kind == AccessKind::Color))
}

/// Returns the last step in which the contents of a resource have an effect.
fn seen_until(plan: &Plan, resource: ResourceId) -> Option<StepId> {
    plan.step_ids().rev().find(|step| {
        let mut accesses = plan.passes_of(*step).iter().flat_map(|m| plan.graph().accesses_of(m.pass));
        let mut attached = plan.attachments_of(*step).iter().filter(|a| a.resource == resource);
        accesses.any(|a| a.resource == resource && !a.kind.is_attachment())
            || plan.full_screen_resolves(*step).any(|(samples, _)| samples.resource == resource)
            || attached.any(|a| is_tested(plan, *step, a.resource) || !dies(plan, *step, a))
    })
}

/// Returns whether the contents of an attachment after a step are discarded or replaced before other passes read them.
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
        // Partial writes do not depend on the older contents.
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

/// Returns whether a copy overwrites the whole attachment.
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

/// Number of graphs whose faults are all tried.
const GRAPHS: u64 = 100;
/// Minimum number of detected faults of each kind.
const SHOWN: u64 = 5;

/// Creates the case of a seed. The graph is culled, so that everything influences a compared result. Half of the seeds
/// give every resource its own slot, so that slots can be mixed up. Later seeds contain only textures, where two
/// textures that could share memory are more common.
fn prepared(runner: &mut Runner, seed: u64) -> Result<Option<Case>, String> {
    let alias = if seed.is_multiple_of(2) { Alias::Off } else { Alias::Pool };
    let options = Options { cull: true, alias, ..options(seed as u32) };
    let profile = Profile { plain: seed >= GRAPHS, volumes: false, plain_accesses: true, ..Profile::default() };
    Ok(runner.prepare(generate::graph(&mut Entropy::seeded(seed), &profile), &options)?.ok())
}

/// Returns whether the comparison detects a broken plan, with poisoning.
fn shows(runner: &mut Runner, seed: u64, fault: &Fault) -> Result<bool, String> {
    let Some(case) = prepared(runner, seed)? else { return Err("it was prepared before".into()) };
    let Fault { kind, row, field, .. } = fault;
    let verdict = runner.run(&case.planned(fault.plan.clone()), true)?;
    verdict.map(|v| !v.differences.is_empty()).map_err(|why| format!("seed {seed}: {kind:?}, {field} {row}: {why}"))
}

#[test]
fn a_broken_plan_is_detected() -> TestResult {
    const NAME: &str = "a_broken_plan_is_detected";
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
            // Graphs with undefined or unobserved contents are not conclusive.
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
                // A clear to zero of zero-filled contents has no effect; poisoning makes don't-care contents visible
                // instead.
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
