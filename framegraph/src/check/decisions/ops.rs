//! Rows on load and store ops: one of each for each attachment, in the order of the attachments.

use super::{at, number, untrue};
use crate::check::case::Case;
use crate::check::finding::Findings;
use crate::check::machine::Trace;
use crate::check::memory::{Deed, DeedKind};
use crate::check::reference::{Value, Wanted};
use crate::decision::Reason;
use crate::id::{ResourceId, StepId};
use crate::plan::{Attachment, LoadOp, Role, StoreOp};

/// Examines the rows on one step.
pub(super) fn ops(
    case: &Case<'_>,
    trace: &Trace,
    step: StepId,
    loads: &[(ResourceId, Reason)],
    stores: &[(ResourceId, Reason)],
    findings: &mut Findings<'_>,
) {
    let start = case.plan.steps()[step.index()].attachments.start as usize;
    let rows = case.plan.attachments_of(step);
    let whole = at(step, ResourceId::NONE);
    number(findings, whole, "loads", loads.len(), rows.len());
    number(findings, whole, "stores", stores.len(), rows.len());
    for (index, attachment) in rows.iter().enumerate() {
        let place = at(step, attachment.resource);
        if let Some(&(resource, reason)) = loads.get(index) {
            let of_row = of(&trace.loaded, start + index, |(a, _)| *a);
            let values: Vec<Value> = of_row.iter().map(|(_, value)| *value).collect();
            if resource != attachment.resource || !load(attachment, &values, reason) {
                untrue(findings, case, place, reason);
            }
        }
        if let Some(&(resource, reason)) = stores.get(index) {
            let deeds = of(&trace.deeds, start + index, |d| d.attachment);
            let holds = store(case, attachment, rows, deeds, reason);
            if resource != attachment.resource || !holds {
                untrue(findings, case, place, reason);
            }
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
fn load(attachment: &Attachment, loaded: &[Value], reason: Reason) -> bool {
    let is = |op: LoadOp| attachment.load == op || attachment.stencil_load == op;
    match reason {
        Reason::LoadClear => is(LoadOp::Clear) && !is(LoadOp::Load) && attachment.clear != Attachment::ZERO,
        Reason::ClearUnneeded => is(LoadOp::Clear) && attachment.clear == Attachment::ZERO,
        Reason::LoadOverwritten => !is(LoadOp::Clear) && !is(LoadOp::Load),
        Reason::LoadWritten(pass) => loaded.contains(&Value::Written(pass)),
        Reason::LoadEntry => loaded.contains(&Value::Entry),
        _ => false,
    }
}

/// Whether the reason for what becomes of an attachment is true; what is stored counts first.
fn store(case: &Case<'_>, attachment: &Attachment, rows: &[Attachment], deeds: &[Deed], reason: Reason) -> bool {
    let of = |kind: DeedKind| deeds.iter().filter(move |d| d.kind == kind);
    let stored = attachment.stores();
    let resolved = match attachment.role {
        Role::Color(slot) => rows.iter().any(|a| a.role == Role::Resolve(slot)),
        _ => false,
    };
    let survived = |why: Wanted| {
        let wanted = case.parts.all(attachment.resource);
        let mut wanted = case.reference.wanted[wanted].iter();
        of(DeedKind::Stored).any(|d| d.survived) && wanted.any(|w| *w == Some(why))
    };
    let dropped = |op: StoreOp| op == StoreOp::Discard;
    let discarded = !stored && (dropped(attachment.store) || dropped(attachment.stencil_store));
    match reason {
        Reason::StoreReadBy(pass) => of(DeedKind::Stored).any(|d| d.readers.contains(&pass)),
        Reason::StoreExport => survived(Wanted::Export),
        Reason::StoreImport => survived(Wanted::Import),
        Reason::StoreHistory => survived(Wanted::History),
        Reason::DiscardResolved => discarded && resolved,
        Reason::DiscardOverwritten => discarded && !resolved && of(DeedKind::Discarded).any(|d| d.overwritten > 0),
        // What has no memory leaves no deed behind.
        Reason::DiscardUnread => {
            let unread = of(DeedKind::Discarded).any(|d| d.overwritten < d.parts);
            discarded && !resolved && (deeds.is_empty() || unread)
        }
        Reason::StoreUnchanged => !stored && of(DeedKind::Left).next().is_some(),
        _ => false,
    }
}
