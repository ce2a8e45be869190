//! Phase 2: which passes the frame needs.
//!
//! One backward sweep over the declared passes, the liveness analysis of a compiler: at each moment every part knows what
//! its contents are needed for. A pass is kept when it writes a part that is needed, or declares a side effect; then what
//! it reads is needed before it, and what it clears or overwrites is not, nor what it blends with in vain. Culling so
//! cascades, and a chain of any depth costs one visit for each access. Within a pass that is kept, a multisample resolve
//! that is not needed is dropped.

use super::measure::Measures;
use super::need::{Need, needs_at_exit};
use super::parts::Parts;
use crate::access::{Access, AccessKind};
use crate::decision::{Decision, Reason, Subject};
use crate::graph::{PassFlags, Tables};
use crate::id::{AccessId, PassId, ResourceId};

/// What the phase fills, beside the log.
pub(crate) struct Culled<'a> {
    /// The passes that are kept, in declaration order.
    pub(crate) order: &'a mut Vec<PassId>,
    /// For each access of a kept pass, what is needed of the resource after the pass in declaration order. The first of
    /// several accesses of one pass to one resource knows. Filled where every resource has one part.
    pub(crate) after: &'a mut Vec<Need>,
    /// What is needed of each part: scratch.
    pub(crate) needs: &'a mut Vec<Need>,
    /// The multisample resolves of kept passes that are dropped, in declaration order.
    pub(crate) dropped: &'a mut Vec<(PassId, AccessId)>,
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
    let Culled { order, after, needs, dropped } = out;
    dropped.clear();
    order.resize(graph.passes.len(), PassId::NONE);
    let mut first_kept = order.len();
    after.resize(graph.accesses.len(), Need::Unread);
    // One row an access: one check of its number serves for both.
    let after = &mut after[..graph.accesses.len()];
    needs_at_exit(graph, parts, measures, needs);
    let trims = enabled && graph.resolves;
    let first = decisions.len();
    let unknown = Decision { subject: Subject::Pass(PassId::NONE), reason: Reason::CulledNoOutput };
    decisions.resize(first + graph.passes.len(), unknown);
    for (index, (declared, decision)) in graph.passes.iter().zip(&mut decisions[first..]).enumerate().rev() {
        // Passes were counted when the graph was validated.
        let (pass, span) = (PassId::unchecked(index), declared.accesses.range());
        let accesses = &graph.accesses[span.clone()];
        let (resource, need) = needed(parts, needs, accesses);
        // Nearly all passes are kept because a pass reads what they write.
        if let Need::Reader(reader) = need
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

/// As [`keep_inputs`], where passes resolve: those resolves of which nothing is needed are dropped. They write nothing, and
/// what the pass blends with is not read for them. The pass's accesses begin at `first`.
#[inline(never)]
fn keep_averages(
    parts: &Parts,
    needs: &mut [Need],
    pass: PassId,
    accesses: &[Access],
    first: usize,
    after: &mut [Need],
    dropped: &mut Vec<(PassId, AccessId)>,
) {
    let needed = |needs: &[Need], a: &Access| parts.any(needs, a.resource, a.range, Need::is_needed);
    let resolves = accesses.iter().filter(|a| a.kind == AccessKind::Resolve && needed(needs, a));
    let averaged: u16 = resolves.fold(0, |slots, a| slots | 1 << a.slot);
    for (at, access) in accesses.iter().enumerate() {
        let &Access { resource, range, kind, slot, .. } = access;
        let in_vain = !needed(needs, access);
        if in_vain && kind == AccessKind::Resolve {
            parts.update(needs, resource, range, |need| *need = need.or_culled_writer(pass));
            after[first + at] = Need::Unread;
            dropped.push((pass, AccessId::at(first + at)));
        } else {
            after[first + at] = keep_input(parts, needs, pass, accesses, access);
            if in_vain && kind == AccessKind::Color && averaged & 1 << slot == 0 {
                parts.fill(needs, resource, range, Need::Overwritten(pass));
            }
        }
    }
}

/// Why a pass is kept of which this output has that need.
#[inline(never)]
fn kept(flags: PassFlags, output: ResourceId, need: Need, enabled: bool) -> Option<Reason> {
    if flags.has(PassFlags::SIDE_EFFECT) {
        Some(Reason::KeptSideEffect)
    } else if need.is_needed() {
        Some(need.kept(output))
    } else {
        (!enabled).then_some(Reason::KeptCullingOff)
    }
}

/// The first output of the pass that is needed, and what for; none and [`Need::Unread`] when there is none.
#[inline]
fn needed(parts: &Parts, needs: &[Need], accesses: &[Access]) -> (ResourceId, Need) {
    for access in accesses {
        if !access.mode.writes() {
            continue;
        }
        let need = parts.find(needs, access.resource, access.range, Need::is_needed);
        if let Some(need) = need {
            return (access.resource, need);
        }
    }
    (ResourceId::NONE, Need::Unread)
}

/// What is needed before a pass that is kept, from what is needed after it, which is noted. No two accesses of one pass
/// exclude each other, so they need no order.
#[inline]
fn keep_inputs(parts: &Parts, needs: &mut [Need], pass: PassId, accesses: &[Access], after: &mut [Need]) {
    for (access, after) in accesses.iter().zip(after) {
        *after = keep_input(parts, needs, pass, accesses, access);
    }
}

/// What is needed before one access of a pass that is kept; returns what is needed after it.
#[inline(always)]
fn keep_input(parts: &Parts, needs: &mut [Need], pass: PassId, accesses: &[Access], access: &Access) -> Need {
    parts.replace(needs, access.resource, access.range, Need::is_needed, |need| {
        need_before(pass, accesses, access, || need.is_needed())
    })
}

/// What is needed of a resource before a kept pass that makes this access, one of its `accesses`; `after` tells whether
/// what the access leaves is needed.
#[inline]
pub(super) fn need_before(pass: PassId, accesses: &[Access], access: &Access, after: impl FnOnce() -> bool) -> Need {
    if reads(accesses, access, after) { Need::Reader(pass) } else { Need::Overwritten(pass) }
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
fn drop_pass(parts: &Parts, needs: &mut [Need], pass: PassId, accesses: &[Access]) -> Reason {
    let output = accesses.iter().find(|a| a.mode.writes());
    let reason = output.map_or(Reason::CulledNoOutput, |a| {
        let found = parts.find(needs, a.resource, a.range, |_| true);
        found.unwrap_or(Need::Unread).culled(a.resource)
    });
    for access in accesses {
        let read = access.mode.needs_contents();
        parts.update(needs, access.resource, access.range, |need| {
            if !need.is_needed() {
                *need = if read { need.or_culled_reader(pass) } else { need.or_culled_writer(pass) };
            }
        });
    }
    reason
}
