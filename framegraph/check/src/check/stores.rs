//! The end of a raster step: performs its store operations and checks that they are appropriate.

use super::finding::{Rule, WasteKind};
use super::machine::Machine;
use super::memory::StoreRecord;
use super::reference::{Cause, Value};
use super::rule_input::RuleInput;
use super::tile::{Cell, Tile, ops};
use framegraph::id::StepId;
use framegraph::plan::{Attachment, LoadOp, Role, StoreOp};
use framegraph::resource::Dimension;

/// Performs the store operations, which determine the contents of memory after the step.
pub(super) fn store(machine: &mut Machine<'_, '_>, tile: &mut Tile, step: StepId) {
    let ctx = machine.ctx;
    for (index, attachment) in ctx.attachments(step) {
        let resource = attachment.resource;
        let bound = attachment.role == Role::DepthReadOnly && is_read_beside(ctx, step, attachment);
        let place = (step, resource);
        let slices = ctx.texture(resource).filter(|t| t.dimension == Dimension::D3);
        for plane in 0..2 {
            let cells = ctx.attached(attachment).filter_map(|part| tile.cell(part).copied());
            let cells: Vec<Cell> = cells.filter(|cell| cell.plane == plane).collect();
            if cells.is_empty() {
                continue;
            }
            let written = cells.iter().any(|c| c.written);
            let accessed = written || cells.iter().any(|c| c.accessed);
            let (load, store) = ops(attachment, plane);
            let memory = machine.memory.exists(resource);
            let why = format_args!("the store op of plane {plane} is {store:?}, but it has no memory");
            ctx.report.require(memory || store == StoreOp::Discard, Rule::NoMemory, place, why);
            if !cells.iter().any(|c| c.used) {
                judge_load(ctx, load, plane, place);
            }
            if !memory {
                continue;
            }
            let fits = match store {
                StoreOp::None => !written,
                StoreOp::Store => written,
                StoreOp::Discard => accessed && !bound,
            };
            let why = format_args!("the store op of plane {plane} is {store:?}, used: {accessed}, written: {written}");
            ctx.report.require(fits, Rule::StoreOp, place, why);
            if store == StoreOp::None && !accessed {
                continue;
            }
            let source = Some(machine.memory.records.len());
            machine.memory.records.push(StoreRecord {
                op: store,
                attachment: index,
                plane,
                readers: Vec::new(),
                survived: false,
                bound,
                overwritten: 0,
                parts: cells.len(),
                replaced: slices.and_then(|_| machine.memory.source(cells[0].part)),
            });
            for cell in cells {
                let value = match store {
                    StoreOp::Store => cell.value,
                    StoreOp::Discard => Value::Garbage(Cause::Discarded),
                    StoreOp::None if written => Value::Garbage(Cause::NotStored),
                    StoreOp::None => machine.memory.value(resource, cell.part),
                };
                machine.memory.set(cell.part, value, source);
            }
        }
    }
}

/// Returns `true` if a pass of the step also reads the level and layers of a depth attachment in another way, in any
/// plane.
fn is_read_beside(ctx: &RuleInput<'_>, step: StepId, attachment: &Attachment) -> bool {
    let place = |part| {
        let name = ctx.parts.name(attachment.resource, part);
        (name.mip, name.layer)
    };
    let attached: Vec<_> = ctx.attached(attachment).map(place).collect();
    let uses = ctx.plan.passes_of(step).iter().flat_map(|m| ctx.planned_accesses(*m));
    let mut reads = uses.filter(|t| t.resource == attachment.resource && !t.access.kind.is_attachment());
    reads.any(|t| ctx.parts.covered(t.resource, t.range).any(|part| attached.contains(&place(part))))
}

/// Reports the load operation of a plane whose loaded value no pass uses.
fn judge_load(ctx: &RuleInput<'_>, load: LoadOp, plane: u32, place: (StepId, framegraph::ResourceId)) {
    let (kind, what) = match load {
        LoadOp::Load => (WasteKind::Load, "loaded, but no pass uses the contents"),
        LoadOp::Clear => (WasteKind::Clear, "cleared, but no pass declares it"),
        LoadOp::DontCare => return,
    };
    ctx.report.waste(kind, place, format_args!("plane {plane} is {what}"));
}
