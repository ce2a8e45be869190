//! Phase 2: which passes the frame needs.
//!
//! One backward sweep over the declared passes, the liveness analysis of a compiler: at each moment every part knows who
//! needs what it holds. A pass is kept when it writes a part that somebody needs, or declares a side effect; then what it
//! reads is needed before it, and what it clears or overwrites is not. Culling so cascades, and a chain of any depth costs
//! one visit for each access.

use super::need::{Need, Why, needs_at_exit};
use super::parts::Parts;
use crate::decision::{Decision, Reason, Subject};
use crate::graph::{Graph, PassFlags};
use crate::id::PassId;

/// Fills `live` (one flag a declared pass) and logs why each pass was kept or dropped; `needs` is scratch.
pub(crate) fn cull(
    graph: &Graph,
    parts: &Parts,
    enabled: bool,
    needs: &mut Vec<Need>,
    live: &mut Vec<bool>,
    decisions: &mut Vec<Decision>,
) {
    needs_at_exit(graph, parts, needs);
    live.clear();
    live.resize(graph.passes.len(), false);
    let first = decisions.len();
    let unknown = Decision {
        subject: Subject::Pass(PassId::NONE),
        reason: Reason::CulledNoOutput,
    };
    decisions.resize(first + graph.passes.len(), unknown);
    for index in (0..graph.passes.len()).rev() {
        let pass = PassId::at(index);
        let reason = verdict(graph, parts, enabled, needs, pass);
        let keep = !is_culled(reason);
        live[index] = keep;
        decisions[first + index] = Decision {
            subject: Subject::Pass(pass),
            reason,
        };
        propagate(graph, parts, needs, pass, keep);
    }
}

const fn is_culled(reason: Reason) -> bool {
    matches!(
        reason,
        Reason::CulledUnread(_)
            | Reason::CulledReaderCulled(..)
            | Reason::CulledOverwritten(..)
            | Reason::CulledNoOutput
    )
}

/// Keep or drop, and why: the first needed output decides, or the first output when none is needed.
#[inline]
fn verdict(graph: &Graph, parts: &Parts, enabled: bool, needs: &[Need], pass: PassId) -> Reason {
    let declared = &graph.passes[pass.index()];
    if declared.flags.has(PassFlags::SIDE_EFFECT) {
        return Reason::KeptSideEffect;
    }
    let mut dropped = Reason::CulledNoOutput;
    for access in declared.accesses.of(&graph.accesses) {
        if !access.mode.writes() {
            continue;
        }
        if let Some(need) = parts.find(needs, access.resource, access.range, Need::is_needed) {
            return need.why().kept(access.resource);
        }
        if dropped == Reason::CulledNoOutput {
            let why = parts
                .find(needs, access.resource, access.range, |_| true)
                .map_or(Why::Unread, Need::why);
            dropped = why.culled(access.resource);
        }
    }
    if enabled {
        dropped
    } else {
        Reason::KeptCullingOff
    }
}

/// What is needed before the pass, from what is needed after it.
#[inline]
fn propagate(graph: &Graph, parts: &Parts, needs: &mut [Need], pass: PassId, keep: bool) {
    let accesses = graph.passes[pass.index()].accesses.of(&graph.accesses);
    if keep {
        for access in accesses.iter().filter(|a| a.mode.writes()) {
            let need = if access.mode.needs_contents() {
                Need::reader(pass)
            } else {
                Need::overwritten(pass)
            };
            parts.fill(needs, access.resource, access.range, need);
        }
        for access in accesses.iter().filter(|a| !a.mode.writes()) {
            parts.fill(needs, access.resource, access.range, Need::reader(pass));
        }
    } else {
        // Nothing that a culled pass writes is needed behind it.
        for access in accesses.iter().filter(|a| a.mode.writes()) {
            let need = if access.mode.needs_contents() {
                Need::culled_reader(pass)
            } else {
                Need::overwritten(pass)
            };
            parts.fill(needs, access.resource, access.range, need);
        }
        for access in accesses.iter().filter(|a| !a.mode.writes()) {
            parts.runs(access.resource, access.range, |run| {
                for need in needs[run].iter_mut().filter(|n| !n.is_needed()) {
                    *need = Need::culled_reader(pass);
                }
            });
        }
    }
}
