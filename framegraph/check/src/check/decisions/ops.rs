//! Rows about load and store operations: one of each per attachment, in the order of the attachments.

use super::rows::{judge, number};
use crate::check::memory::StoreRecord;
use crate::check::reference::{Value, Wanted};
use crate::check::resolves::takes_samples;
use crate::check::rule_input::RuleInput;
use crate::check::run::Trace;
use framegraph::decision::Reason;
use framegraph::id::{PassId, ResourceId, StepId};
use framegraph::plan::{Attachment, LoadOp, StoreOp};

/// Examines the rows about one step.
pub(super) fn ops(
    ctx: &RuleInput<'_>,
    trace: &Trace,
    step: StepId,
    loads: &[(ResourceId, Reason)],
    stores: &[(ResourceId, Reason)],
) {
    let rows = ctx.plan.attachments_of(step);
    number(ctx, step, "loads", loads.len(), rows.len());
    number(ctx, step, "stores", stores.len(), rows.len());
    for (index, (at, attachment)) in ctx.attachments(step).enumerate() {
        let place = (step, attachment.resource);
        if let Some(&(resource, reason)) = loads.get(index) {
            let holds = load(attachment, of(&trace.loaded, at, |(a, _)| *a), reason);
            judge(ctx, place, reason, holds && resource == attachment.resource);
        }
        if let Some(&(resource, reason)) = stores.get(index) {
            let holds = store(ctx, step, attachment, of(&trace.records, at, |r| r.attachment), reason);
            judge(ctx, place, reason, holds && resource == attachment.resource);
        }
    }
}

/// Returns the rows about one attachment, from rows sorted by attachment.
fn of<T>(rows: &[T], attachment: usize, key: impl Fn(&T) -> usize) -> &[T] {
    let start = rows.partition_point(|r| key(r) < attachment);
    let end = rows.partition_point(|r| key(r) <= attachment);
    &rows[start..end]
}

/// Returns `true` if the reason of a load operation is correct. Loads take precedence over clears.
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

/// Returns `true` if the reason of a store operation is correct. Stores take precedence.
fn store(ctx: &RuleInput<'_>, step: StepId, attachment: &Attachment, records: &[StoreRecord], reason: Reason) -> bool {
    let of = |op: StoreOp| records.iter().filter(move |r| r.op == op);
    let stored = attachment.stores();
    let resolved = ctx.plan.attachments_of(step).iter().any(|a| takes_samples(a.role, attachment.role));
    // If the pass itself reads the contents before its full-screen resolve, it counts as the reader.
    let by_full_screen = |pass: PassId| {
        let here = ctx.plan.pass_steps()[pass.index()] == step;
        let mut made = ctx.full_screen.iter().filter(|m| m.pass == pass);
        here && made.any(|m| m.samples.resource == attachment.resource)
    };
    let read_by = |pass: PassId| of(StoreOp::Store).any(|r| r.readers.contains(&pass));
    let survived = |why: Wanted| {
        let wanted = ctx.parts.all(attachment.resource);
        let mut wanted = ctx.reference.wanted[wanted].iter();
        let aliased = ctx.graph.has_alias(attachment.resource);
        of(StoreOp::Store).any(|r| r.survived || aliased) && wanted.any(|w| *w == Some(why))
    };
    let dropped = attachment.store == StoreOp::Discard || attachment.stencil_store == StoreOp::Discard;
    let discarded = !stored && dropped;
    match reason {
        Reason::StoreReadBy(pass) => read_by(pass) && !by_full_screen(pass),
        Reason::StoreResolved(pass) => read_by(pass) && by_full_screen(pass),
        Reason::StoreExport => survived(Wanted::Export),
        Reason::StoreImport => survived(Wanted::Import),
        Reason::StoreHistory => survived(Wanted::History),
        Reason::DiscardResolved => discarded && resolved,
        Reason::DiscardOverwritten => discarded && !resolved && of(StoreOp::Discard).any(|r| r.overwritten > 0),
        // Memoryless resources leave no record.
        Reason::DiscardUnread => {
            let unread = of(StoreOp::Discard).any(|r| r.overwritten < r.parts);
            discarded && !resolved && (records.is_empty() || unread)
        }
        Reason::StoreUnchanged => !stored && of(StoreOp::None).next().is_some(),
        _ => false,
    }
}
