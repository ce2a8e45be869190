//! Rows about passes: kept, culled, moved.

use super::rows::{judge, number, predecessor};
use crate::check::reference::{Value, Wanted};
use crate::check::rule_input::RuleInput;
use framegraph::access::Access;
use framegraph::decision::Reason;
use framegraph::graph::PassFlags;
use framegraph::id::{PassId, ResourceId};
use framegraph::options::Order;
use framegraph::resource::Dimension;

/// Checks that there is one correct verdict, and a row about the order if the pass was moved.
pub(super) fn verdict(ctx: &RuleInput<'_>, pass: PassId, reasons: &[Reason]) {
    let (mut verdicts, mut moves, mut averages, mut full_screen) = (0, 0, 0, 0);
    let by_full_screen = || ctx.full_screen.iter().filter(|m| m.pass == pass);
    let dropped = || ctx.accesses_of(pass).filter(|(id, _)| ctx.dropped[*id]);
    // The number of rows must equal the number of such resolves; a surplus for one target is a lack for another.
    let rows = |reason| reasons.iter().filter(|r| **r == reason).count();
    for &reason in reasons {
        let holds = match reason {
            Reason::OrderMerge(before) | Reason::OrderBytes(before) => {
                moves += 1;
                let steps = ctx.plan.pass_steps();
                let shares = steps[pass.index()] == steps[before.index()];
                predecessor(ctx, pass) == Some(before) && shares == matches!(reason, Reason::OrderMerge(_))
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
                let holds = stands(ctx, pass, reason);
                verdicts += usize::from(holds.is_some());
                holds.unwrap_or(false)
            }
        };
        judge(ctx, pass, reason, holds);
    }
    number(ctx, pass, "its verdict", verdicts, 1);
    number(ctx, pass, "its averages", averages, dropped().count());
    number(ctx, pass, "its full-screen resolves", full_screen, by_full_screen().count());
    number(ctx, pass, "its order", moves, usize::from(was_moved(ctx, pass)));
}

/// Returns `true` if a pass follows another pass than in declaration order.
fn was_moved(ctx: &RuleInput<'_>, pass: PassId) -> bool {
    if ctx.plan.options().order == Order::Declared {
        return false;
    }
    let Some(before) = predecessor(ctx, pass) else {
        return false;
    };
    let earlier = (0..pass.index()).rev().map(PassId::at);
    let declared = earlier.into_iter().find(|p| ctx.position[p.index()].is_some());
    declared != Some(before)
}

/// Returns the parts of a resource that a pass writes.
fn written(ctx: &RuleInput<'_>, pass: PassId, resource: ResourceId) -> Vec<usize> {
    let accesses = ctx.graph.accesses_of(pass).iter();
    let writes = accesses.filter(|a| a.resource == resource && a.mode.writes());
    writes.flat_map(|a| ctx.covered(a)).collect()
}

/// Returns if a verdict about a pass is correct; `None` for rows that are not verdicts.
fn stands(ctx: &RuleInput<'_>, pass: PassId, reason: Reason) -> Option<bool> {
    let reference = &ctx.reference;
    let runs = |p: PassId| ctx.position[p.index()].is_some();
    let kept = runs(pass);
    let any = |resource, holds: &dyn Fn(usize) -> bool| written(ctx, pass, resource).into_iter().any(holds);
    let survives = |resource, why: Wanted| {
        any(resource, &|part| reference.exit[part] == Value::Written(pass) && reference.wanted[part] == Some(why))
    };
    let read_by = |resource, reader| any(resource, &|part| reference.readers(pass, part).any(|p| p == reader));
    // The log names the next reader of a level, even if a pass in between replaces the slice.
    let level_read_by = |resource, reader: PassId| {
        let volume = ctx.texture(resource).is_some_and(|t| t.dimension == Dimension::D3);
        let reads =
            |part| ctx.accesses_of(reader).any(|(_, a)| a.needs_contents() && ctx.parts.kept(a).any(|p| p == part));
        volume && reader > pass && any(resource, &reads)
    };
    let unread = |part| reference.readers(pass, part).next().is_none();
    Some(match reason {
        Reason::KeptSideEffect => kept && ctx.flag(pass, PassFlags::SIDE_EFFECT),
        Reason::KeptExport(r) => kept && survives(r, Wanted::Export),
        Reason::KeptImport(r) => kept && survives(r, Wanted::Import),
        Reason::KeptHistory(r) => kept && survives(r, Wanted::History),
        Reason::KeptReadBy(r, reader) => kept && runs(reader) && read_by(r, reader),
        Reason::KeptCullingOff => kept && !ctx.plan.options().cull && !keeps_itself(ctx, pass),
        Reason::CulledNoOutput => !kept && !ctx.graph.accesses_of(pass).iter().any(|a| a.mode.writes()),
        // No pass reads or overwrites it.
        Reason::CulledUnread(r) => !kept && any(r, &|part| unread(part) && !overwrites(ctx, pass, part, |_| true)),
        Reason::CulledReaderCulled(r, reader) => {
            !kept && !runs(reader) && (read_by(r, reader) || level_read_by(r, reader))
        }
        Reason::CulledOverwritten(r, writer) => {
            !kept && any(r, &|part| unread(part) && overwrites(ctx, pass, part, |p| p == writer))
        }
        _ => return None,
    })
}

/// Returns `true` if a pass has a reason to be kept other than disabled culling.
fn keeps_itself(ctx: &RuleInput<'_>, pass: PassId) -> bool {
    let mut writes = ctx.graph.accesses_of(pass).iter().filter(|a| a.mode.writes());
    let needed = |a: &Access| ctx.covered(a).any(|part| ctx.is_needed(pass, part));
    ctx.flag(pass, PassFlags::SIDE_EFFECT) || writes.any(needed)
}

/// Returns `true` if a later pass for which `chosen` is true overwrites a part without using its contents. One slice
/// overwrites no level.
fn overwrites(ctx: &RuleInput<'_>, pass: PassId, part: usize, chosen: impl Fn(PassId) -> bool) -> bool {
    let later = (pass.index() + 1..ctx.graph.passes().len()).map(PassId::at);
    later.filter(|p| chosen(*p)).any(|p| {
        ctx.accesses_of(p).any(|(id, a)| {
            let adds = a.range.slice || a.needs_contents() && !ctx.reference.in_vain[id];
            a.mode.writes() && !adds && ctx.covered(a).any(|q| q == part)
        })
    })
}
