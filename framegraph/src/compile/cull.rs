//! Phase 2: culling of passes that the frame does not need.
//!
//! A backward liveness analysis over the declared passes. It tracks the next use of the contents of every subresource.
//! A pass is kept if it writes contents that are used later, or if it declares a side effect.
//!
//! Before a kept pass, the contents it reads are in use. Contents that it clears or overwrites are not, nor are
//! contents that it only blends into without a later use. Chains of unused passes of any length are culled in one
//! sweep. Unused multisample resolves of kept passes are dropped.

use super::liveness::{NextUse, uses_at_exit};
use super::measure::Measures;
use super::parts::Parts;
use crate::access::{Access, AccessKind};
use crate::decision::{Decision, Reason, Subject};
use crate::graph::{PassFlags, Tables};
use crate::id::{AccessId, PassId, ResourceId};

/// Outputs of the phase, apart from the log.
pub(crate) struct Culled<'a> {
    /// The kept passes, in declaration order.
    pub(crate) order: &'a mut Vec<PassId>,
    /// For each access of a kept pass, the next use of the resource after the pass. If a pass has several accesses to a
    /// resource, the first one holds the value. Filled only if every resource has one subresource.
    pub(crate) after: &'a mut Vec<NextUse>,
    /// Next use of each subresource; scratch memory.
    pub(crate) needs: &'a mut Vec<NextUse>,
    /// Dropped multisample resolves of kept passes, in declaration order.
    pub(crate) dropped: &'a mut Vec<(PassId, AccessId)>,
}

/// Determines which passes are kept, and logs the reason for each pass.
#[inline(never)]
pub(crate) fn cull(
    graph: &Tables,
    parts: &Parts,
    measures: &Measures,
    enabled: bool,
    out: Culled<'_>,
    decisions: &mut Vec<Decision>,
) {
    let Culled { order, after, needs, dropped } = out;
    dropped.clear();
    order.resize(graph.passes.len(), PassId::NONE);
    let mut first_kept = order.len();
    after.resize(graph.accesses.len(), NextUse::Unread);
    // Equal lengths, so that one bounds check serves both arrays.
    let after = &mut after[..graph.accesses.len()];
    uses_at_exit(graph, parts, measures, needs);
    let trims = enabled && graph.resolves;
    let first = decisions.len();
    let unknown = Decision { subject: Subject::Pass(PassId::NONE), reason: Reason::CulledNoOutput };
    decisions.resize(first + graph.passes.len(), unknown);
    for (index, (declared, decision)) in graph.passes.iter().zip(&mut decisions[first..]).enumerate().rev() {
        // Validation has checked the number of passes.
        let (pass, span) = (PassId::unchecked(index), declared.accesses.range());
        let accesses = &graph.accesses[span.clone()];
        let (resource, need) = needed(parts, needs, accesses);
        // Fast path: almost all passes are kept because a pass reads their output.
        if let NextUse::Reader(reader) = need
            && !declared.flags.has(PassFlags::SIDE_EFFECT)
        {
            *decision = Decision { subject: Subject::Pass(pass), reason: Reason::KeptReadBy(resource, reader) };
        } else if let Some(reason) = kept(declared.flags, resource, need, enabled) {
            *decision = Decision { subject: Subject::Pass(pass), reason };
        } else {
            let reason = drop_pass(parts, needs, pass, accesses);
            *decision = Decision { subject: Subject::Pass(pass), reason };
            continue;
        }
        first_kept -= 1;
        order[first_kept] = pass;
        if trims && declared.flags.has(PassFlags::RESOLVES) {
            keep_averages(parts, needs, pass, accesses, span.start, after, dropped);
        } else {
            keep_inputs(parts, needs, pass, accesses, &mut after[span]);
        }
    }
    if first_kept != 0 {
        order.drain(..first_kept);
    }
    if !dropped.is_empty() {
        dropped.sort_unstable();
        decisions.extend(dropped.iter().map(|(pass, id)| {
            let reason = Reason::ResolveDropped(graph.accesses[id.index()].resource);
            Decision { subject: Subject::Pass(*pass), reason }
        }));
    }
}

/// Updates the next uses before a kept pass that resolves, and drops its unused resolves.
///
/// A dropped resolve writes nothing, and does not make blended contents used. `first` is the index of the pass's first
/// access.
#[inline(never)]
fn keep_averages(
    parts: &Parts,
    needs: &mut [NextUse],
    pass: PassId,
    accesses: &[Access],
    first: usize,
    after: &mut [NextUse],
    dropped: &mut Vec<(PassId, AccessId)>,
) {
    let needed = |needs: &[NextUse], a: &Access| parts.any(needs, a.resource, a.range, NextUse::is_needed);
    let resolves = accesses.iter().filter(|a| a.kind == AccessKind::Resolve && needed(needs, a));
    let averaged: u16 = resolves.fold(0, |slots, a| slots | 1 << a.slot);
    for (at, access) in accesses.iter().enumerate() {
        let &Access { resource, range, kind, slot, .. } = access;
        let in_vain = !needed(needs, access);
        if in_vain && kind == AccessKind::Resolve {
            parts.update(needs, resource, range, |need| *need = need.or_culled_writer(pass));
            after[first + at] = NextUse::Unread;
            dropped.push((pass, AccessId::at(first + at)));
        } else {
            after[first + at] = keep_input(parts, needs, pass, accesses, access);
            if in_vain && kind == AccessKind::Color && averaged & 1 << slot == 0 {
                parts.fill(needs, resource, range, NextUse::Overwritten(pass));
            }
        }
    }
}

/// Returns the reason to keep a pass with this next use of an output, if any.
#[inline(never)]
fn kept(flags: PassFlags, output: ResourceId, need: NextUse, enabled: bool) -> Option<Reason> {
    if flags.has(PassFlags::SIDE_EFFECT) {
        Some(Reason::KeptSideEffect)
    } else if need.is_needed() {
        Some(need.kept(output))
    } else {
        (!enabled).then_some(Reason::KeptCullingOff)
    }
}

/// Returns the first output of the pass that is used, and its next use; none and [`NextUse::Unread`] if there is none.
#[inline]
fn needed(parts: &Parts, needs: &[NextUse], accesses: &[Access]) -> (ResourceId, NextUse) {
    for access in accesses {
        if !access.mode.writes() {
            continue;
        }
        let need = parts.find(needs, access.resource, access.range, NextUse::is_needed);
        if let Some(need) = need {
            return (access.resource, need);
        }
    }
    (ResourceId::NONE, NextUse::Unread)
}

/// Updates the next uses from after a kept pass to before it, and stores the former in `after`. Accesses of one pass do
/// not conflict, so their order does not matter.
#[inline]
fn keep_inputs(parts: &Parts, needs: &mut [NextUse], pass: PassId, accesses: &[Access], after: &mut [NextUse]) {
    for (access, after) in accesses.iter().zip(after) {
        *after = keep_input(parts, needs, pass, accesses, access);
    }
}

/// Updates the next use before one access of a kept pass. Returns the next use after it.
#[inline(always)]
fn keep_input(parts: &Parts, needs: &mut [NextUse], pass: PassId, accesses: &[Access], access: &Access) -> NextUse {
    parts.replace(needs, access.resource, access.range, NextUse::is_needed, |need| {
        use_before(pass, accesses, access, need)
    })
}

/// Returns the next use of a resource before an access of a kept pass, from the next use after it. A slice does not
/// overwrite the other slices of its level, so it changes an unneeded use only if it reads.
#[inline]
pub(super) fn use_before(pass: PassId, accesses: &[Access], access: &Access, after: NextUse) -> NextUse {
    if after == NextUse::Alias {
        return after;
    }
    match reads(accesses, access, || after.is_needed()) {
        true => NextUse::Reader(pass),
        false if access.range.slice => after,
        false => NextUse::Overwritten(pass),
    }
}

/// Returns `true` if the previous contents influence any result of an access.
///
/// Previous contents of a color attachment influence only its new contents and its resolve target. Blending without a
/// use of these is therefore no read. This does not hold for depth tests and storage buffers.
#[inline]
pub(super) fn reads(accesses: &[Access], access: &Access, after: impl FnOnce() -> bool) -> bool {
    access.needs_contents() && (access.kind != AccessKind::Color || after() || is_resolved_by(accesses, access.slot))
}

/// Returns `true` if the pass resolves its color attachment in this slot.
#[inline(never)]
fn is_resolved_by(accesses: &[Access], slot: u8) -> bool {
    accesses.iter().any(|a| a.kind == AccessKind::Resolve && a.slot == slot)
}

/// Culls a pass and returns the reason, which is the next use of its first output.
#[inline(never)]
fn drop_pass(parts: &Parts, needs: &mut [NextUse], pass: PassId, accesses: &[Access]) -> Reason {
    let output = accesses.iter().find(|a| a.mode.writes());
    let reason = output.map_or(Reason::CulledNoOutput, |a| {
        let found = parts.find(needs, a.resource, a.range, |_| true);
        found.unwrap_or(NextUse::Unread).culled(a.resource)
    });
    for access in accesses {
        let read = access.needs_contents();
        parts.update(needs, access.resource, access.range, |need| {
            if !need.is_needed() {
                *need = if read { need.or_culled_reader(pass) } else { need.or_culled_writer(pass) };
            }
        });
    }
    reason
}
