//! The end of a raster step: its store ops, and whether its ops are the ones that its passes call for.

use super::case::Case;
use super::finding::{Findings, Place, Rule, WasteKind};
use super::machine::Machine;
use super::memory::{Deed, DeedKind};
use super::reference::{Cause, Value};
use super::tile::{Cell, Tile, ops};
use crate::id::StepId;
use crate::plan::{Attachment, LoadOp, Role, StoreOp};

/// The store ops: what memory holds when the step is over.
pub(super) fn store(machine: &mut Machine<'_, '_>, tile: &mut Tile, step: StepId, findings: &mut Findings<'_>) {
    let case = machine.case;
    let start = case.plan.steps()[step.index()].attachments.start as usize;
    for (index, attachment) in case.plan.attachments_of(step).iter().enumerate() {
        let resource = attachment.resource;
        let bound = attachment.role == Role::DepthReadOnly && is_read_beside(case, step, attachment);
        for plane in 0..2 {
            let cells: Vec<Cell> = case
                .shown(attachment)
                .filter_map(|part| tile.cell(part).copied())
                .filter(|cell| cell.plane == plane)
                .collect();
            if cells.is_empty() {
                continue;
            }
            let state = Plane {
                touched: cells.iter().any(|c| c.touched || c.written),
                written: cells.iter().any(|c| c.written),
                used: cells.iter().any(|c| c.used),
                bound,
            };
            let place = Place::step(step).and_resource(resource);
            let (load, store) = ops(attachment, plane);
            if !machine.memory.exists(resource) {
                findings.require(store == StoreOp::Discard, Rule::NoMemory, place, || {
                    format!("the store op of plane {plane} is {store:?}, and it has no memory")
                });
                judge_load(load, state, plane, place, findings);
                continue;
            }
            judge_load(load, state, plane, place, findings);
            judge_store(store, state, plane, place, findings);
            let kind = match store {
                StoreOp::Store => DeedKind::Stored,
                StoreOp::Discard => DeedKind::Discarded,
                StoreOp::None if !state.touched => continue,
                StoreOp::None => DeedKind::Left,
            };
            let deed = machine.memory.deeds.len();
            machine.memory.deeds.push(Deed {
                kind,
                attachment: start + index,
                plane,
                readers: Vec::new(),
                survived: false,
                bound,
                overwritten: 0,
                parts: cells.len(),
            });
            if store != StoreOp::None {
                machine.memory.take(resource, &case.parts);
            }
            for cell in cells {
                let value = match store {
                    StoreOp::Store => cell.value,
                    StoreOp::Discard => Value::Garbage(Cause::Discarded),
                    StoreOp::None if state.written => Value::Garbage(Cause::NotStored),
                    StoreOp::None => machine.memory.value(resource, cell.part),
                };
                machine.memory.set(cell.part, value, Some(deed));
            }
        }
    }
}

/// What the passes of a step did to one plane of an attachment.
#[derive(Clone, Copy)]
struct Plane {
    touched: bool,
    written: bool,
    used: bool,
    /// It is read only and read beside the test, so it cannot be dropped.
    bound: bool,
}

/// Whether a pass of the step reads the level and layers of a depth attachment otherwise too, in whichever plane.
fn is_read_beside(case: &Case<'_>, step: StepId, attachment: &Attachment) -> bool {
    let place = |part| {
        let name = case.parts.name(attachment.resource, part);
        (name.mip, name.layer)
    };
    let shown: Vec<_> = case.shown(attachment).map(place).collect();
    let touches = case.plan.passes_of(step).iter().flat_map(|m| case.touches(*m));
    let mut reads = touches.filter(|t| t.resource == attachment.resource && !t.access.kind.is_attachment());
    reads.any(|t| case.parts.covered(t.resource, t.range).any(|part| shown.contains(&place(part))))
}

/// The load op of one plane against what the passes did with it.
fn judge_load(load: LoadOp, state: Plane, plane: u32, place: Place, findings: &mut Findings<'_>) {
    if load == LoadOp::Load && !state.used {
        let sentence = format!("plane {plane} is loaded, and no pass uses what was there");
        findings.waste(WasteKind::Load, place, sentence);
    }
    if load == LoadOp::Clear && !state.used {
        let sentence = format!("plane {plane} is cleared, and no pass declares it");
        findings.waste(WasteKind::Clear, place, sentence);
    }
}

/// The store op of one plane that has memory against what the passes did to it.
fn judge_store(store: StoreOp, state: Plane, plane: u32, place: Place, findings: &mut Findings<'_>) {
    let Plane { touched, written, bound, .. } = state;
    let fits = match store {
        StoreOp::None => !written,
        StoreOp::Store => written,
        StoreOp::Discard => touched && !bound,
    };
    findings.require(fits, Rule::StoreOp, place, || {
        format!("the store op of plane {plane} is {store:?}, touched: {touched}, written: {written}")
    });
}
