//! Phase 2: which passes the frame needs.
//!
//! One backward sweep over the declared passes, the liveness analysis of a compiler: at each moment every part knows who
//! needs what it holds. A pass is kept when it writes a part that somebody needs, or declares a side effect; then what it
//! reads is needed before it, and what it clears or overwrites is not; nor is what it adds to for nobody. Culling so
//! cascades, and a chain of any depth costs one visit for each access.

use super::measure::Measures;
use super::need::{Need, Why, exits};
use super::parts::Parts;
use crate::access::{Access, AccessKind, Range, Usage};
use crate::decision::{Decision, Reason, Subject};
use crate::graph::{PassFlags, Tables};
use crate::id::{PassId, ResourceId};

/// What the sweep carries: one row a part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Who needs what the part holds at this moment.
    need: Need,
    /// In the row that has the number of a resource: the passes that use it and are kept, in declaration order, from the
    /// first one on that was met; none when there is none.
    pub(crate) first: PassId,
    pub(crate) last: PassId,
    /// Their uses, as declared: a same-pixel read samples.
    pub(crate) usage: Usage,
}

impl Seen {
    const NOTHING: Self = Self { need: Need::UNREAD, first: PassId::NONE, last: PassId::NONE, usage: Usage::NONE };

    /// Adds a use in front of those that are known.
    #[inline]
    fn precede(&mut self, pass: PassId, kind: AccessKind) {
        // Which it is cannot be predicted, so it is chosen, not branched on.
        let last = self.last;
        self.last = if last.is_none() { pass } else { last };
        self.first = pass;
        let usage = if kind == AccessKind::SamePixel { Usage::SAMPLED } else { kind.usage() };
        self.usage = self.usage.union(usage);
    }
}

/// What the phase fills, beside the log.
pub(crate) struct Culled<'a> {
    /// The passes that are kept, in declaration order.
    pub(crate) order: &'a mut Vec<PassId>,
    /// For each access of a kept pass, what is needed of the resource after the pass in declaration order. The first of
    /// several accesses of one pass to one resource knows. Filled where every resource has one part.
    pub(crate) after: &'a mut Vec<Need>,
    /// The uses of each resource; rows of parts follow.
    pub(crate) seen: &'a mut Vec<Seen>,
}

/// Finds the passes that are kept, and logs why each was kept or dropped.
#[inline(never)]
pub(crate) fn cull(
    graph: &Tables,
    parts: &Parts,
    measures: &Measures,
    enabled: bool,
    out: Culled<'_>,
    decisions: &mut Vec<Decision>,
) {
    let Culled { order, after, seen } = out;
    order.clear();
    after.resize(graph.accesses.len(), Need::UNREAD);
    seen.clear();
    seen.resize(parts.total(), Seen::NOTHING);
    for (resource, need) in exits(graph, measures) {
        parts.update(seen, resource, Range::ALL, |seen| seen.need = need);
    }
    let first = decisions.len();
    let unknown = Decision { subject: Subject::Pass(PassId::NONE), reason: Reason::CulledNoOutput };
    decisions.resize(first + graph.passes.len(), unknown);
    let decisions = &mut decisions[first..];
    if parts.has_several() {
        sweep::<false>(graph, parts, enabled, order, after, seen, decisions);
    } else {
        sweep::<true>(graph, parts, enabled, order, after, seen, decisions);
    }
    order.reverse();
}

/// The sweep; `WHOLE` says that every resource has one part, so that nothing needs to be asked about parts.
#[inline(never)]
fn sweep<const WHOLE: bool>(
    graph: &Tables,
    parts: &Parts,
    enabled: bool,
    order: &mut Vec<PassId>,
    after: &mut [Need],
    seen: &mut [Seen],
    decisions: &mut [Decision],
) {
    for (index, (declared, decision)) in graph.passes.iter().zip(decisions).enumerate().rev() {
        // Passes were counted when the graph was validated.
        let (pass, span) = (PassId::unchecked(index), declared.accesses.range());
        let accesses = &graph.accesses[span.clone()];
        let (resource, need) = needed::<WHOLE>(parts, seen, accesses);
        // Nearly all passes are kept because a pass reads what they write.
        if let Some(reader) = need.reader_alone()
            && !declared.flags.has(PassFlags::SIDE_EFFECT)
        {
            *decision = Decision { subject: Subject::Pass(pass), reason: Reason::KeptReadBy(resource, reader) };
        } else if let Some(reason) = kept(declared.flags, resource, need, enabled) {
            *decision = Decision { subject: Subject::Pass(pass), reason };
        } else {
            let reason = drop_pass(parts, seen, pass, accesses);
            *decision = Decision { subject: Subject::Pass(pass), reason };
            continue;
        }
        order.push(pass);
        if WHOLE {
            keep_whole_inputs(seen, pass, accesses, &mut after[span]);
        } else {
            keep_inputs(parts, seen, pass, accesses);
        }
    }
}

/// Why a pass is kept of which this output has that need.
#[inline(never)]
fn kept(flags: PassFlags, output: ResourceId, need: Need, enabled: bool) -> Option<Reason> {
    if flags.has(PassFlags::SIDE_EFFECT) {
        Some(Reason::KeptSideEffect)
    } else if need.is_needed() {
        Some(need.why().kept(output))
    } else {
        (!enabled).then_some(Reason::KeptCullingOff)
    }
}

/// The first output of the pass that somebody needs, and who does; none and nobody when there is none.
#[inline]
fn needed<const WHOLE: bool>(parts: &Parts, seen: &[Seen], accesses: &[Access]) -> (ResourceId, Need) {
    for access in accesses {
        if !access.mode.writes() {
            continue;
        }
        let need = if WHOLE {
            Some(seen[access.resource.index()].need).filter(|need| need.is_needed())
        } else {
            parts.find(seen, access.resource, access.range, |seen| seen.need.is_needed()).map(|seen| seen.need)
        };
        if let Some(need) = need {
            return (access.resource, need);
        }
    }
    (ResourceId::NONE, Need::UNREAD)
}

/// What is needed before a pass that is kept, from what is needed after it. No two accesses of one pass exclude each
/// other, so they need no order.
fn keep_inputs(parts: &Parts, seen: &mut [Seen], pass: PassId, accesses: &[Access]) {
    for access in accesses {
        let after = || parts.any(seen, access.resource, access.range, |seen| seen.need.is_needed());
        let need = need_before(pass, accesses, access, after);
        parts.update(seen, access.resource, access.range, |seen| seen.need = need);
        seen[access.resource.index()].precede(pass, access.kind);
    }
}

/// The same where every resource has one part; what was needed after the pass is noted.
#[inline]
fn keep_whole_inputs(seen: &mut [Seen], pass: PassId, accesses: &[Access], after: &mut [Need]) {
    for (access, after) in accesses.iter().zip(after) {
        let seen = &mut seen[access.resource.index()];
        *after = seen.need;
        seen.need = need_before(pass, accesses, access, || after.is_needed());
        seen.precede(pass, access.kind);
    }
}

/// What is needed of a resource before a kept pass that makes this access, one of its `accesses`; `after` tells whether
/// what the access leaves is needed.
#[inline]
pub(super) fn need_before(pass: PassId, accesses: &[Access], access: &Access, after: impl FnOnce() -> bool) -> Need {
    if reads(accesses, access, after) { Need::reader(pass) } else { Need::overwritten(pass) }
}

/// Whether anything comes of what was there before this access of a pass. Blending in vain changes nothing: unlike a depth
/// test or a storage buffer, the old contents of a color attachment reach only its new contents, and the resolve target.
#[inline]
pub(super) fn reads(accesses: &[Access], access: &Access, after: impl FnOnce() -> bool) -> bool {
    access.mode.needs_contents()
        && (access.kind != AccessKind::Color || after() || is_resolved_by(accesses, access.slot))
}

/// Whether the pass averages its color attachment of this slot.
#[inline(never)]
fn is_resolved_by(accesses: &[Access], slot: u8) -> bool {
    accesses.iter().any(|a| a.kind == AccessKind::Resolve && a.slot == slot)
}

/// Drops a pass, and says why: what became of its first output. It would have read its inputs; nothing that it writes is
/// needed behind it, and what it reads may be, by others.
#[inline(never)]
fn drop_pass(parts: &Parts, seen: &mut [Seen], pass: PassId, accesses: &[Access]) -> Reason {
    let output = accesses.iter().find(|a| a.mode.writes());
    let reason = output.map_or(Reason::CulledNoOutput, |a| {
        let found = parts.find(seen, a.resource, a.range, |_| true);
        found.map_or(Why::Unread, |seen| seen.need.why()).culled(a.resource)
    });
    for access in accesses {
        let read = access.mode.needs_contents();
        parts.update(seen, access.resource, access.range, |seen| {
            if !seen.need.is_needed() {
                let need = seen.need;
                seen.need = if read { need.or_culled_reader(pass) } else { need.or_culled_writer(pass) };
            }
        });
    }
    reason
}
