//! Rows on load and store ops: one of each for each attachment, in the order of the attachments.

use super::rows::{judge, number};
use crate::decision::Reason;
use crate::id::{ResourceId, StepId};
use crate::plan::{Attachment, LoadOp, Role, StoreOp};
use crate::testing::check::case::Case;
use crate::testing::check::memory::StoreRecord;
use crate::testing::check::reference::{Value, Wanted};
use crate::testing::check::run::Trace;

/// Examines the rows on one step.
pub(super) fn ops(
    case: &Case<'_>,
    trace: &Trace,
    step: StepId,
    loads: &[(ResourceId, Reason)],
    stores: &[(ResourceId, Reason)],
) {
    let rows = case.plan.attachments_of(step);
    number(case, step, "loads", loads.len(), rows.len());
    number(case, step, "stores", stores.len(), rows.len());
    for (index, (at, attachment)) in case.attachments(step).enumerate() {
        let place = (step, attachment.resource);
        if let Some(&(resource, reason)) = loads.get(index) {
            let holds = load(attachment, of(&trace.loaded, at, |(a, _)| *a), reason);
            judge(case, place, reason, holds && resource == attachment.resource);
        }
        if let Some(&(resource, reason)) = stores.get(index) {
            let holds = store(case, attachment, rows, of(&trace.records, at, |r| r.attachment), reason);
            judge(case, place, reason, holds && resource == attachment.resource);
        }
    }
}

/// The rows about one attachment, among rows that are sorted by attachment.
fn of<T>(rows: &[T], attachment: usize, key: impl Fn(&T) -> usize) -> &[T] {
    let start = rows.partition_point(|r| key(r) < attachment);
    let end = rows.partition_point(|r| key(r) <= attachment);
    &rows[start..end]
}

/// Whether the reason for how an attachment comes into the tile is true; what is loaded counts first, then clears.
fn load(attachment: &Attachment, loaded: &[(usize, Value)], reason: Reason) -> bool {
    let is = |op: LoadOp| attachment.load == op || attachment.stencil_load == op;
    let found = |value: Value| loaded.iter().any(|(_, v)| *v == value);
    match reason {
        Reason::LoadClear => is(LoadOp::Clear) && !is(LoadOp::Load) && attachment.clear != Attachment::ZERO,
        Reason::ClearUnneeded => is(LoadOp::Clear) && attachment.clear == Attachment::ZERO,
        Reason::LoadOverwritten => !is(LoadOp::Clear) && !is(LoadOp::Load),
        Reason::LoadWritten(pass) => found(Value::Written(pass)),
        Reason::LoadEntry => found(Value::Entry),
        _ => false,
    }
}

/// Whether the reason for what becomes of an attachment is true; what is stored counts first.
fn store(
    case: &Case<'_>,
    attachment: &Attachment,
    rows: &[Attachment],
    records: &[StoreRecord],
    reason: Reason,
) -> bool {
    let of = |op: StoreOp| records.iter().filter(move |r| r.op == op);
    let stored = attachment.stores();
    let resolved = match attachment.role {
        Role::Color(slot) => rows.iter().any(|a| a.role == Role::ResolveTarget(slot)),
        _ => false,
    };
    let survived = |why: Wanted| {
        let wanted = case.parts.all(attachment.resource);
        let mut wanted = case.reference.wanted[wanted].iter();
        of(StoreOp::Store).any(|r| r.survived) && wanted.any(|w| *w == Some(why))
    };
    let dropped = attachment.store == StoreOp::Discard || attachment.stencil_store == StoreOp::Discard;
    let discarded = !stored && dropped;
    match reason {
        Reason::StoreReadBy(pass) => of(StoreOp::Store).any(|r| r.readers.contains(&pass)),
        Reason::StoreExport => survived(Wanted::Export),
        Reason::StoreImport => survived(Wanted::Import),
        Reason::StoreHistory => survived(Wanted::History),
        Reason::DiscardResolved => discarded && resolved,
        Reason::DiscardOverwritten => discarded && !resolved && of(StoreOp::Discard).any(|r| r.overwritten > 0),
        // What has no memory leaves no record behind.
        Reason::DiscardUnread => {
            let unread = of(StoreOp::Discard).any(|r| r.overwritten < r.parts);
            discarded && !resolved && (records.is_empty() || unread)
        }
        Reason::StoreUnchanged => !stored && of(StoreOp::None).next().is_some(),
        _ => false,
    }
}
