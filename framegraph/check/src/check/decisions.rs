//! Checks the decision log: required rows are present, and every row is true.
//!
//! Rows are checked against the reference semantics and the results of the run, not against the compiler's reasoning. A
//! row that explains why something was *not* done must name an objection that really exists.

mod epilogues;
mod merges;
mod ops;
mod places;
mod rows;
mod verdicts;

use super::rule_input::RuleInput;
use super::run::Trace;
use super::tenants::EarlierTenants;
use framegraph::decision::Subject;

/// Examines the decision log.
pub(super) fn decisions(ctx: &RuleInput<'_>, trace: &Trace, earlier: &EarlierTenants) {
    let steps = ctx.plan.steps().len();
    let mut passes = vec![Vec::new(); ctx.graph.passes().len()];
    let mut resources = vec![Vec::new(); ctx.graph.resources().len()];
    let (mut loads, mut stores) = (vec![Vec::new(); steps], vec![Vec::new(); steps]);
    for decision in ctx.plan.decisions() {
        match decision.subject {
            Subject::Pass(p) => passes[p.index()].push(decision.reason),
            Subject::Resource(r) => resources[r.index()].push(decision.reason),
            Subject::Load(s, r) => loads[s.index()].push((r, decision.reason)),
            Subject::Store(s, r) => stores[s.index()].push((r, decision.reason)),
        }
    }
    for (pass, reasons) in ctx.graph.pass_ids().zip(&passes) {
        verdicts::verdict(ctx, pass, reasons);
        merges::merges(ctx, pass, reasons);
    }
    for (step, (loads, stores)) in ctx.plan.step_ids().zip(loads.iter().zip(&stores)) {
        ops::ops(ctx, trace, step, loads, stores);
    }
    for (resource, reasons) in ctx.graph.resource_ids().zip(&resources) {
        places::places(ctx, resource, &earlier[resource.index()], reasons);
    }
}
