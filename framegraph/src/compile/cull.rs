//! Phase 2: which passes the frame needs.
//!
//! One backward sweep over the declared passes, the liveness analysis of a compiler: at each moment every part knows who
//! needs what it holds. A pass is kept when it writes a part that somebody needs, or declares a side effect; then what it
//! reads is needed before it, and what it clears or overwrites is not. Culling so cascades, and a chain of any depth costs
//! one visit for each access.

use super::measure::Measures;
use super::need::{Need, Why, needs_at_exit};
use super::parts::Parts;
use crate::access::Access;
use crate::decision::{Decision, Reason, Subject};
use crate::graph::{Graph, PassFlags};
use crate::id::{PassId, ResourceId};

/// Fills `live` (one flag a declared pass) and logs why each pass was kept or dropped; `needs` is scratch.
pub(crate) fn cull(
    graph: &Graph,
    parts: &Parts,
    measures: &Measures,
    enabled: bool,
    needs: &mut Vec<Need>,
    live: &mut Vec<bool>,
    decisions: &mut Vec<Decision>,
) {
    needs_at_exit(graph, parts, measures, needs);
    live.clear();
    live.resize(graph.passes.len(), false);
    let first = decisions.len();
    let unknown = Decision { subject: Subject::Pass(PassId::NONE), reason: Reason::CulledNoOutput };
    decisions.resize(first + graph.passes.len(), unknown);
    let rows = graph.passes.iter().zip(&mut decisions[first..]).zip(live);
    for (index, ((declared, decision), keep)) in rows.enumerate().rev() {
        let pass = PassId::at(index);
        let accesses = declared.accesses.of(&graph.accesses);
        let subject = Subject::Pass(pass);
        let mut log = |reason| *decision = Decision { subject, reason };
        *keep = true;
        // Each reason is written where it is found: handing it on through memory costs more than all the rest.
        if declared.flags.has(PassFlags::SIDE_EFFECT) {
            log(Reason::KeptSideEffect);
        } else if let Some((resource, need)) = needed(parts, needs, accesses) {
            match need.why() {
                Why::Reader(reader) => log(Reason::KeptReadBy(resource, reader)),
                why => log(why.kept(resource)),
            }
        } else if !enabled {
            log(Reason::KeptCullingOff);
        } else {
            *keep = false;
            log(drop_inputs(parts, needs, pass, accesses));
            continue;
        }
        keep_inputs(parts, needs, pass, accesses);
    }
}

/// The first output of the pass that somebody needs.
#[inline]
fn needed(parts: &Parts, needs: &[Need], accesses: &[Access]) -> Option<(ResourceId, Need)> {
    for access in accesses.iter().filter(|a| a.mode.writes()) {
        if let Some(need) = parts.find(needs, access.resource, access.range, Need::is_needed) {
            return Some((access.resource, need));
        }
    }
    None
}

/// What is needed before a pass that is kept, from what is needed after it. No two accesses of one pass exclude each
/// other, so they need no order.
#[inline]
fn keep_inputs(parts: &Parts, needs: &mut [Need], pass: PassId, accesses: &[Access]) {
    for access in accesses {
        let need = if access.mode.needs_contents() { Need::reader(pass) } else { Need::overwritten(pass) };
        parts.fill(needs, access.resource, access.range, need);
    }
}

/// Notes that a pass that is dropped would have read its inputs, and returns why it is dropped: what became of its first
/// output.
#[inline(never)]
fn drop_inputs(parts: &Parts, needs: &mut [Need], pass: PassId, accesses: &[Access]) -> Reason {
    let output = accesses.iter().find(|a| a.mode.writes());
    let reason = output.map_or(Reason::CulledNoOutput, |a| {
        let need = parts.find(needs, a.resource, a.range, |_| true);
        need.map_or(Why::Unread, Need::why).culled(a.resource)
    });
    // Nothing that a culled pass writes is needed behind it.
    for access in accesses.iter().filter(|a| a.mode.writes()) {
        let need = if access.mode.needs_contents() { Need::culled_reader(pass) } else { Need::overwritten(pass) };
        parts.fill(needs, access.resource, access.range, need);
    }
    for access in accesses.iter().filter(|a| !a.mode.writes()) {
        parts.runs(access.resource, access.range, |run| {
            for need in needs[run].iter_mut().filter(|n| !n.is_needed()) {
                *need = Need::culled_reader(pass);
            }
        });
    }
    reason
}
