//! Rows on passes: kept, culled, moved.

use super::{number, predecessor, untrue};
use crate::check::case::Case;
use crate::check::finding::{Findings, Place};
use crate::check::reference::{Value, Wanted};
use crate::decision::Reason;
use crate::graph::PassFlags;
use crate::id::{PassId, ResourceId};
use crate::options::Order;

/// One verdict, and a row on the order when the pass was moved.
pub(super) fn verdict(case: &Case<'_>, pass: PassId, reasons: &[Reason], findings: &mut Findings<'_>) {
    let place = Place::pass(pass);
    let culled = case.position[pass.index()].is_none();
    let (mut verdicts, mut moves) = (0, 0);
    for &reason in reasons {
        let holds = match reason {
            Reason::KeptSideEffect
            | Reason::KeptExport(_)
            | Reason::KeptImport(_)
            | Reason::KeptHistory(_)
            | Reason::KeptReadBy(..)
            | Reason::KeptCullingOff => {
                verdicts += 1;
                !culled && kept(case, pass, reason)
            }
            Reason::CulledUnread(_)
            | Reason::CulledReaderCulled(..)
            | Reason::CulledOverwritten(..)
            | Reason::CulledNoOutput => {
                verdicts += 1;
                culled && dropped(case, pass, reason)
            }
            Reason::OrderMerge(before) | Reason::OrderBytes(before) => {
                moves += 1;
                let steps = case.plan.pass_steps();
                let shares = steps[pass.index()] == steps[before.index()];
                predecessor(case, pass) == Some(before) && shares == matches!(reason, Reason::OrderMerge(_))
            }
            // Judged by `merges`.
            Reason::MergedAttachments(_)
            | Reason::MergedSamePixel(_)
            | Reason::MergedInline(_)
            | Reason::Split(..)
            | Reason::NotInlined(..) => true,
            _ => false,
        };
        if !holds {
            untrue(findings, case, place, reason);
        }
    }
    number(findings, place, "its verdict", verdicts, 1);
    number(findings, place, "its order", moves, usize::from(was_moved(case, pass)));
}

/// Whether a pass runs after another one than in declaration order.
fn was_moved(case: &Case<'_>, pass: PassId) -> bool {
    if case.plan.options().order == Order::Declared {
        return false;
    }
    let Some(before) = predecessor(case, pass) else {
        return false;
    };
    let earlier = (0..pass.index()).rev().map(PassId::at);
    let declared = earlier.into_iter().find(|p| case.position[p.index()].is_some());
    declared != Some(before)
}

/// The parts that a pass writes of a resource.
fn written(case: &Case<'_>, pass: PassId, resource: ResourceId) -> Vec<usize> {
    let accesses = case.graph.accesses_of(pass).iter();
    let writes = accesses.filter(|a| a.resource == resource && a.mode.writes());
    writes.flat_map(|a| case.parts.covered(a.resource, a.range)).collect()
}

/// Whether something that `pass` wrote into `resource` must survive the frame for that reason.
fn survives(case: &Case<'_>, pass: PassId, resource: ResourceId, why: Wanted) -> bool {
    written(case, pass, resource)
        .iter()
        .any(|part| case.reference.exit[*part] == Value::Written(pass) && case.reference.wanted[*part] == Some(why))
}

fn kept(case: &Case<'_>, pass: PassId, reason: Reason) -> bool {
    let flags = case.graph.passes()[pass.index()].flags;
    match reason {
        Reason::KeptSideEffect => flags.has(PassFlags::SIDE_EFFECT),
        Reason::KeptExport(r) => survives(case, pass, r, Wanted::Export),
        Reason::KeptImport(r) => survives(case, pass, r, Wanted::Import),
        Reason::KeptHistory(r) => survives(case, pass, r, Wanted::History),
        Reason::KeptReadBy(r, reader) => {
            case.position[reader.index()].is_some()
                && written(case, pass, r).iter().any(|part| case.reference.readers(pass, *part).any(|p| p == reader))
        }
        Reason::KeptCullingOff => !case.plan.options().cull && !keeps_itself(case, pass),
        _ => false,
    }
}

/// Whether a pass has a better reason to be kept than that culling is off.
fn keeps_itself(case: &Case<'_>, pass: PassId) -> bool {
    let reads = |part| {
        let mut readers = case.reference.readers(pass, part);
        readers.any(|p| case.position[p.index()].is_some())
    };
    let exit = |part: usize| case.reference.exit[part] == Value::Written(pass) && case.reference.wanted[part].is_some();
    let accesses = case.graph.accesses_of(pass).iter();
    let mut writes = accesses.filter(|a| a.mode.writes());
    case.graph.passes()[pass.index()].flags.has(PassFlags::SIDE_EFFECT)
        || writes.any(|a| {
            let mut parts = case.parts.covered(a.resource, a.range);
            parts.any(|part| reads(part) || exit(part))
        })
}

fn dropped(case: &Case<'_>, pass: PassId, reason: Reason) -> bool {
    let unread = |part: &usize| case.reference.readers(pass, *part).next().is_none();
    match reason {
        Reason::CulledNoOutput => {
            let mut accesses = case.graph.accesses_of(pass).iter();
            !accesses.any(|a| a.mode.writes())
        }
        // Nobody reads it, and nobody writes over it either.
        Reason::CulledUnread(r) => {
            written(case, pass, r).iter().any(|part| unread(part) && !overwrites(case, pass, *part, |_| true))
        }
        Reason::CulledReaderCulled(r, reader) => {
            case.position[reader.index()].is_none()
                && written(case, pass, r).iter().any(|part| case.reference.readers(pass, *part).any(|p| p == reader))
        }
        Reason::CulledOverwritten(r, writer) => {
            written(case, pass, r).iter().any(|part| unread(part) && overwrites(case, pass, *part, |p| p == writer))
        }
        _ => false,
    }
}

/// Whether a later pass of which `chosen` is true writes over a part without need of what it held.
fn overwrites(case: &Case<'_>, pass: PassId, part: usize, chosen: impl Fn(PassId) -> bool) -> bool {
    let later = (pass.index() + 1..case.graph.passes().len()).map(PassId::at);
    later.filter(|p| chosen(*p)).any(|p| {
        let mut accesses = case.accesses_of(p);
        accesses.any(|(id, a)| {
            let adds = a.mode.needs_contents() && !case.reference.in_vain[id];
            a.mode.writes() && !adds && case.parts.covered(a.resource, a.range).any(|q| q == part)
        })
    })
}
