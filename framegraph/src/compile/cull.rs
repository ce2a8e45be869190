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
use crate::graph::{PassFlags, Tables};
use crate::id::{PassId, ResourceId};

/// What the phase fills, beside the log.
pub(crate) struct Culled<'a> {
    /// One flag a declared pass: it is kept.
    pub(crate) live: &'a mut Vec<bool>,
    /// For each access of a kept pass, what is needed of the resource after the pass in declaration order. The first of
    /// several accesses of one pass to one resource knows. Filled where every resource has one part.
    pub(crate) after: &'a mut Vec<Need>,
}

/// Finds the passes that are kept, and logs why each was kept or dropped; `needs` is scratch.
pub(crate) fn cull(
    graph: &Tables,
    parts: &Parts,
    measures: &Measures,
    enabled: bool,
    needs: &mut Vec<Need>,
    out: Culled<'_>,
    decisions: &mut Vec<Decision>,
) {
    needs_at_exit(graph, parts, measures, needs);
    let count = graph.passes.len();
    let Culled { live, after } = out;
    live.clear();
    live.resize(count, true);
    after.resize(graph.accesses.len(), Need::UNREAD);
    let first = decisions.len();
    let unknown = Decision { subject: Subject::Pass(PassId::NONE), reason: Reason::CulledNoOutput };
    decisions.resize(first + count, unknown);
    let (passes, live, decisions) = (&graph.passes[..count], &mut live[..count], &mut decisions[first..first + count]);
    for index in (0..count).rev() {
        let (declared, pass) = (&passes[index], PassId::at(index));
        let accesses = declared.accesses.of(&graph.accesses);
        let need = needed(parts, needs, accesses);
        // Nearly all passes are kept because a pass reads what they write.
        let reason = match need.and_then(|(resource, need)| Some((resource, need.reader_alone()?))) {
            Some((resource, reader)) if !declared.flags.has(PassFlags::SIDE_EFFECT) => {
                Reason::KeptReadBy(resource, reader)
            }
            _ => kept(declared.flags, need, enabled).unwrap_or_else(|| {
                live[index] = false;
                why_dropped(parts, needs, accesses)
            }),
        };
        decisions[index] = Decision { subject: Subject::Pass(pass), reason };
        if !live[index] {
            drop_inputs(parts, needs, pass, accesses);
        } else if parts.has_several() {
            keep_inputs(parts, needs, pass, accesses);
        } else {
            keep_whole_inputs(needs, pass, accesses, &mut after[declared.accesses.range()]);
        }
    }
}

/// Why a pass is kept of which this output, if any, is needed.
#[inline(never)]
fn kept(flags: PassFlags, need: Option<(ResourceId, Need)>, enabled: bool) -> Option<Reason> {
    if flags.has(PassFlags::SIDE_EFFECT) {
        Some(Reason::KeptSideEffect)
    } else if let Some((resource, need)) = need {
        Some(need.why().kept(resource))
    } else {
        (!enabled).then_some(Reason::KeptCullingOff)
    }
}

/// The first output of the pass that somebody needs.
#[inline]
fn needed(parts: &Parts, needs: &[Need], accesses: &[Access]) -> Option<(ResourceId, Need)> {
    for access in accesses {
        if access.mode.writes()
            && let Some(need) = parts.find(needs, access.resource, access.range, Need::is_needed)
        {
            return Some((access.resource, need));
        }
    }
    None
}

/// What is needed before a pass that is kept, from what is needed after it. No two accesses of one pass exclude each
/// other, so they need no order.
fn keep_inputs(parts: &Parts, needs: &mut [Need], pass: PassId, accesses: &[Access]) {
    for access in accesses {
        parts.fill(needs, access.resource, access.range, need_before(pass, access));
    }
}

/// The same where every resource has one part; what was needed after the pass is noted.
#[inline]
fn keep_whole_inputs(needs: &mut [Need], pass: PassId, accesses: &[Access], after: &mut [Need]) {
    for (access, after) in accesses.iter().zip(after) {
        *after = std::mem::replace(&mut needs[access.resource.index()], need_before(pass, access));
    }
}

/// What is needed of a resource before a kept pass that makes this access.
#[inline]
pub(super) fn need_before(pass: PassId, access: &Access) -> Need {
    if access.mode.needs_contents() { Need::reader(pass) } else { Need::overwritten(pass) }
}

/// Why a pass is dropped: what became of its first output.
#[inline(never)]
fn why_dropped(parts: &Parts, needs: &[Need], accesses: &[Access]) -> Reason {
    let output = accesses.iter().find(|a| a.mode.writes());
    output.map_or(Reason::CulledNoOutput, |a| {
        let need = parts.find(needs, a.resource, a.range, |_| true);
        need.map_or(Why::Unread, Need::why).culled(a.resource)
    })
}

/// Notes that a pass that is dropped would have read its inputs. Nothing that it writes is needed behind it; what it reads
/// may be, by others.
#[inline(never)]
fn drop_inputs(parts: &Parts, needs: &mut [Need], pass: PassId, accesses: &[Access]) {
    for access in accesses {
        let read = access.mode.needs_contents();
        parts.runs(access.resource, access.range, |run| {
            for need in needs[run].iter_mut().filter(|n| !n.is_needed()) {
                *need = if read { need.or_culled_reader(pass) } else { need.or_culled_writer(pass) };
            }
        });
    }
}
