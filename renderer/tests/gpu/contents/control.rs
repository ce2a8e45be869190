//! The control: plans with one decision broken must not pass the comparison.

use super::case::{Case, Runner};
use super::options;
use crate::bench::{TestResult, on_adapter};
use framegraph::generate::{self, Entropy, Profile};
use framegraph::{
    AccessKind, Alias, Attachment, Fault, Join, LoadOp, Options, Plan, ResourceId, Role, StepId, StoreOp,
};
use std::collections::BTreeMap;

/// What became of the faults of one kind.
#[derive(Debug, Default)]
struct Tried {
    /// The comparison shows them.
    shown: u64,
    /// They change nothing, for the reasons that [`changes_nothing`] knows.
    without_effect: u64,
}

const KINDS: [&str; 4] = ["load -> clear", "load -> don't care", "store -> discard", "shared place"];

/// Graphs whose faults are all tried.
const GRAPHS: u64 = 100;
/// How many faults of each kind must be shown.
const SHOWN: u64 = 5;

fn kind(fault: Fault) -> &'static str {
    match fault {
        Fault::Load { op: LoadOp::Clear, .. } => KINDS[0],
        Fault::Load { .. } => KINDS[1],
        Fault::Discard { .. } => KINDS[2],
        Fault::Share { .. } => KINDS[3],
    }
}

/// Why a fault may go unnoticed: wgpu has no operations for an attachment that is read only, and contents that passes
/// only draw over, until somebody drops or replaces them, show nowhere.
fn changes_nothing(plan: &Plan, fault: Fault) -> bool {
    let attachment = match fault {
        Fault::Load { attachment, .. } | Fault::Discard { attachment } => attachment,
        Fault::Share { resource, with } => {
            let first = |r: ResourceId| plan.resources()[r.index()].first;
            let (a, b) = if first(resource) <= first(with) { (resource, with) } else { (with, resource) };
            return seen_until(plan, a).is_none_or(|last| last < first(b));
        }
    };
    let holds = |s: &StepId| plan.steps()[s.index()].attachments.range().contains(&attachment);
    let Some(step) = plan.step_ids().find(holds) else { return false };
    let row = &plan.attachments()[attachment];
    let tests_it = matches!(fault, Fault::Load { .. }) && is_tested(plan, step, row.resource);
    row.role == Role::DepthReadOnly || (!tests_it && dies(plan, step, row))
}

/// Whether a pass of the step draws color where depth or stencil of the resource let it.
fn is_tested(plan: &Plan, step: StepId, resource: ResourceId) -> bool {
    let passes = plan.passes_of(step).iter().map(|m| plan.graph().accesses_of(m.pass));
    let mut tested = passes.filter(|accesses| accesses.iter().any(|a| a.kind.is_depth() && a.resource == resource));
    tested.any(|accesses| accesses.iter().any(|a| a.kind == AccessKind::Color))
}

/// The last step in which anything comes of what a resource holds.
fn seen_until(plan: &Plan, resource: ResourceId) -> Option<StepId> {
    plan.step_ids().rev().find(|step| {
        let mut accesses = plan.passes_of(*step).iter().flat_map(|m| plan.graph().accesses_of(m.pass));
        let mut attached = plan.attachments_of(*step).iter().filter(|a| a.resource == resource);
        accesses.any(|a| a.resource == resource && !a.kind.is_attachment())
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
        let attached = plan.attachments_of(later).iter().find(|a| {
            (a.resource, a.mip, a.layer) == (row.resource, row.mip, row.layer) && !matches!(a.role, Role::Resolve(_))
        });
        let members = plan.passes_of(later).iter().filter(|m| m.join != Join::Inlined);
        let mut accesses = members.flat_map(|m| graph.accesses_of(m.pass));
        let touched = accesses.any(|a| a.resource == row.resource && !a.kind.is_attachment());
        match attached {
            _ if touched || is_tested(plan, later, row.resource) => return false,
            Some(next) => return !next.loads() || dies(plan, later, next),
            None => {}
        }
    }
    false
}

/// The case of a seed: culled, so that everything is there for something that is compared, and half of the time with a
/// place for every resource, so that there are places to be mixed up.
fn prepared(runner: &mut Runner, seed: u64) -> Result<Option<Case>, String> {
    let alias = if seed.is_multiple_of(2) { Alias::Off } else { Alias::Pool };
    let options = Options { cull: true, alias, ..options(seed as u32) };
    let profile = Profile { plain: seed >= GRAPHS, ..Profile::default() };
    Ok(runner.prepare(generate::graph(&mut Entropy::seeded(seed), &profile), &options)?.ok())
}

/// Whether wgpu itself would refuse the frame: what is in one place would be read and drawn into by one step.
fn refused(plan: &Plan, fault: Fault) -> bool {
    let Fault::Share { resource, with } = fault else { return false };
    let graph = plan.graph();
    plan.step_ids().any(|step| {
        let members = plan.passes_of(step).iter();
        let touched: Vec<_> = members.flat_map(|m| graph.accesses_of(m.pass)).map(|a| a.resource).collect();
        touched.contains(&resource) && touched.contains(&with)
    })
}

/// Whether the comparison shows a fault, with contents that may be anything made loud.
fn shows(runner: &mut Runner, seed: u64, fault: Fault) -> Result<bool, String> {
    let Some(case) = prepared(runner, seed)? else { return Err("it was prepared before".into()) };
    let verdict = runner.run(&case.broken(fault), true)?;
    verdict.map(|v| !v.differences.is_empty()).map_err(|why| format!("seed {seed}: {fault:?}: {why}"))
}

#[test]
fn a_broken_plan_is_seen() -> TestResult {
    on_adapter("a_broken_plan_is_seen", |gpu| {
        let mut runner = Runner::new(gpu)?;
        let mut tried: BTreeMap<&str, Tried> = KINDS.into_iter().map(|k| (k, Tried::default())).collect();
        for seed in 0..1000 {
            let Some(good) = prepared(&mut runner, seed)? else { continue };
            // Two textures that could be one and are never in one step are rare: they are looked for in more graphs, of
            // textures alone.
            let mut faults = good.plan.faults();
            faults.retain(|f| !refused(&good.plan, *f) && (seed < GRAPHS || matches!(f, Fault::Share { .. })));
            if seed >= GRAPHS && tried[KINDS[3]].shown >= SHOWN {
                break;
            }
            if faults.is_empty() {
                continue;
            }
            let Ok(verdict) = runner.run(&good, true)? else { continue };
            assert_eq!(verdict.differences, Vec::<String>::new(), "seed {seed}");
            // What nobody may rely on, and what no pass shows, cannot tell.
            if verdict.unknown + verdict.unknown_digests + verdict.unobserved > 0 {
                continue;
            }
            for fault in faults {
                let row = tried.entry(kind(fault)).or_default();
                if shows(&mut runner, seed, fault)? {
                    row.shown += 1;
                    continue;
                }
                row.without_effect += 1;
                // What was cleared to zero before is zero when it is cleared again.
                let cleared_twice = match fault {
                    Fault::Load { attachment, op: LoadOp::Clear } => {
                        shows(&mut runner, seed, Fault::Load { attachment, op: LoadOp::DontCare })?
                    }
                    _ => false,
                };
                let plan = &good.plan;
                assert!(
                    cleared_twice || changes_nothing(plan, fault),
                    "seed {seed}: {fault:?} goes unnoticed\n{}",
                    framegraph::dump::text(plan)
                );
            }
        }
        println!("{tried:#?}");
        assert!(tried.values().all(|t| t.shown >= SHOWN), "each kind must be seen a few times");
        Ok(())
    })
}
