//! Rows about passes: kept, culled, moved.

use super::rows::{judge, number, predecessor};
use crate::access::Access;
use crate::decision::Reason;
use crate::graph::PassFlags;
use crate::id::{PassId, ResourceId};
use crate::options::Order;
use crate::testing::check::case::Case;
use crate::testing::check::reference::{Value, Wanted};

/// Checks that there is one correct verdict, and a row about the order if the pass was moved.
pub(super) fn verdict(case: &Case<'_>, pass: PassId, reasons: &[Reason]) {
    let (mut verdicts, mut moves, mut averages, mut full_screen) = (0, 0, 0, 0);
    let by_full_screen = || case.full_screen.iter().filter(|m| m.pass == pass);
    let dropped = || case.accesses_of(pass).filter(|(id, _)| case.dropped[*id]);
    // The number of rows must equal the number of such resolves; a surplus for one target is a lack for another.
    let rows = |reason| reasons.iter().filter(|r| **r == reason).count();
    for &reason in reasons {
        let holds = match reason {
            Reason::OrderMerge(before) | Reason::OrderBytes(before) => {
                moves += 1;
                let steps = case.plan.pass_steps();
                let shares = steps[pass.index()] == steps[before.index()];
                predecessor(case, pass) == Some(before) && shares == matches!(reason, Reason::OrderMerge(_))
            }
            Reason::ResolveDropped(resource) => {
                averages += 1;
                dropped().filter(|(_, a)| a.resource == resource).count() == rows(reason)
            }
            Reason::ResolvePass(resource) => {
                full_screen += 1;
                by_full_screen().filter(|m| m.target.resource == resource).count() == rows(reason)
            }
            // Checked by `merges`.
            Reason::MergedAttachments(_)
            | Reason::MergedSamePixel(_)
            | Reason::MergedInline(_)
            | Reason::Split(..)
            | Reason::NotInlined(..) => true,
            _ => {
                let holds = stands(case, pass, reason);
                verdicts += usize::from(holds.is_some());
                holds.unwrap_or(false)
            }
        };
        judge(case, pass, reason, holds);
    }
    number(case, pass, "its verdict", verdicts, 1);
    number(case, pass, "its averages", averages, dropped().count());
    number(case, pass, "its full-screen resolves", full_screen, by_full_screen().count());
    number(case, pass, "its order", moves, usize::from(was_moved(case, pass)));
}

/// Returns `true` if a pass follows another pass than in declaration order.
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

/// Returns the parts of a resource that a pass writes.
fn written(case: &Case<'_>, pass: PassId, resource: ResourceId) -> Vec<usize> {
    let accesses = case.graph.accesses_of(pass).iter();
    let writes = accesses.filter(|a| a.resource == resource && a.mode.writes());
    writes.flat_map(|a| case.covered(a)).collect()
}

/// Returns if a verdict about a pass is correct; `None` for rows that are not verdicts.
fn stands(case: &Case<'_>, pass: PassId, reason: Reason) -> Option<bool> {
    let reference = &case.reference;
    let runs = |p: PassId| case.position[p.index()].is_some();
    let kept = runs(pass);
    let any = |resource, holds: &dyn Fn(usize) -> bool| written(case, pass, resource).into_iter().any(holds);
    let survives = |resource, why: Wanted| {
        any(resource, &|part| reference.exit[part] == Value::Written(pass) && reference.wanted[part] == Some(why))
    };
    let read_by = |resource, reader| any(resource, &|part| reference.readers(pass, part).any(|p| p == reader));
    let unread = |part| reference.readers(pass, part).next().is_none();
    Some(match reason {
        Reason::KeptSideEffect => kept && case.flag(pass, PassFlags::SIDE_EFFECT),
        Reason::KeptExport(r) => kept && survives(r, Wanted::Export),
        Reason::KeptImport(r) => kept && survives(r, Wanted::Import),
        Reason::KeptHistory(r) => kept && survives(r, Wanted::History),
        Reason::KeptReadBy(r, reader) => kept && runs(reader) && read_by(r, reader),
        Reason::KeptCullingOff => kept && !case.plan.options().cull && !keeps_itself(case, pass),
        Reason::CulledNoOutput => !kept && !case.graph.accesses_of(pass).iter().any(|a| a.mode.writes()),
        // No pass reads or overwrites it.
        Reason::CulledUnread(r) => !kept && any(r, &|part| unread(part) && !overwrites(case, pass, part, |_| true)),
        Reason::CulledReaderCulled(r, reader) => !kept && !runs(reader) && read_by(r, reader),
        Reason::CulledOverwritten(r, writer) => {
            !kept && any(r, &|part| unread(part) && overwrites(case, pass, part, |p| p == writer))
        }
        _ => return None,
    })
}

/// Returns `true` if a pass has a reason to be kept other than disabled culling.
fn keeps_itself(case: &Case<'_>, pass: PassId) -> bool {
    let mut writes = case.graph.accesses_of(pass).iter().filter(|a| a.mode.writes());
    let needed = |a: &Access| case.covered(a).any(|part| case.is_needed(pass, part));
    case.flag(pass, PassFlags::SIDE_EFFECT) || writes.any(needed)
}

/// Returns `true` if a later pass for which `chosen` is true overwrites a part without using its contents.
fn overwrites(case: &Case<'_>, pass: PassId, part: usize, chosen: impl Fn(PassId) -> bool) -> bool {
    let later = (pass.index() + 1..case.graph.passes().len()).map(PassId::at);
    later.filter(|p| chosen(*p)).any(|p| {
        case.accesses_of(p).any(|(id, a)| {
            let adds = a.mode.needs_contents() && !case.reference.in_vain[id];
            a.mode.writes() && !adds && case.covered(a).any(|q| q == part)
        })
    })
}
