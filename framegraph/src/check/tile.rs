//! Tile memory: one raster step, from its load ops through its passes to its store ops.

use super::case::{Case, Touch};
use super::finding::{Findings, Place, Rule};
use super::machine::Machine;
use super::memory::DeedId;
use super::reference::{Cause, Value};
use super::stores;
use crate::access::{AccessKind, Mode};
use crate::id::{PassId, StepId};
use crate::plan::{Attachment, Join, LoadOp, Role, StepPass, StoreOp};

/// One subresource in the tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) part: usize,
    pub(super) plane: u32,
    pub(super) value: Value,
    /// Which deed left the contents in memory that were there before the step.
    source: DeedId,
    /// No pass has written it yet: it holds what the load op left.
    initial: bool,
    /// A pass used what the load op left.
    pub(super) used: bool,
    /// A pass drew into it or read it.
    pub(super) touched: bool,
    /// A pass changed it.
    pub(super) written: bool,
}

/// A multisample resolve that the end of the step will make.
#[derive(Clone, Copy)]
struct Pending {
    pass: PassId,
    /// A subresource of the averaged color attachment.
    samples: usize,
}

/// The tile: cells by attachment of the open step, and where each subresource is.
pub(super) struct Tile {
    cells: Vec<Cell>,
    of_part: Vec<Option<usize>>,
    pending: Vec<Pending>,
}

impl Tile {
    pub(super) fn new(parts: usize) -> Self {
        Self { cells: Vec::new(), of_part: vec![None; parts], pending: Vec::new() }
    }

    pub(super) fn cell(&mut self, part: usize) -> Option<&mut Cell> {
        let at = self.of_part[part]?;
        self.cells.get_mut(at)
    }
}

/// Load and store op of one plane of an attachment; `plane` is 1 for the stencil of a format with depth too.
pub(super) const fn ops(attachment: &Attachment, plane: u32) -> (LoadOp, StoreOp) {
    if plane == 0 { (attachment.load, attachment.store) } else { (attachment.stencil_load, attachment.stencil_store) }
}

/// Runs one raster step.
pub(super) fn raster(machine: &mut Machine<'_, '_>, tile: &mut Tile, step: StepId, findings: &mut Findings<'_>) {
    let case = machine.case;
    load(machine, tile, step, findings);
    for &member in case.plan.passes_of(step) {
        if member.join == Join::Inlined {
            epilogue(machine, tile, step, member, findings);
        } else {
            draw(machine, tile, step, member, findings);
        }
    }
    for Pending { pass, samples } in std::mem::take(&mut tile.pending) {
        let left = tile.cell(samples).map(|c| c.value);
        if left != Some(Value::Written(pass)) {
            let place = Place::step(step).and_pass(pass);
            let why = "the samples changed after the pass that resolves them";
            findings.violation(Rule::Resolve, place, why);
        }
    }
    stores::store(machine, tile, step, findings);
    for cell in tile.cells.drain(..) {
        tile.of_part[cell.part] = None;
    }
}

/// The load ops: what the tile holds when the first pass begins.
fn load(machine: &mut Machine<'_, '_>, tile: &mut Tile, step: StepId, findings: &mut Findings<'_>) {
    let case = machine.case;
    let start = case.plan.steps()[step.index()].attachments.start as usize;
    for (index, attachment) in case.plan.attachments_of(step).iter().enumerate() {
        let resource = attachment.resource;
        // Without a tile, drawing goes to memory at once, whatever the store op says afterwards.
        if !attachment.loads() && attachment.role != Role::DepthReadOnly {
            machine.memory.take(resource, &case.parts);
        }
        for part in case.shown(attachment) {
            if tile.of_part[part].is_some() {
                continue; // two attachments of one spot are reported elsewhere
            }
            let plane = case.parts.name(resource, part).plane;
            let source = machine.memory.source(resource, part);
            let value = match ops(attachment, plane).0 {
                LoadOp::Load => {
                    if !machine.memory.exists(resource) {
                        let place = Place::step(step).and_resource(resource);
                        findings.violation(Rule::NoMemory, place, "it is loaded, and has no memory");
                    }
                    let value = machine.memory.value(resource, part);
                    machine.loaded.push((start + index, value));
                    value
                }
                LoadOp::Clear => Value::Cleared(attachment.clear),
                LoadOp::DontCare => Value::Garbage(Cause::DontCare),
            };
            tile.of_part[part] = Some(tile.cells.len());
            tile.cells.push(Cell {
                part,
                plane,
                value,
                source,
                initial: true,
                used: false,
                touched: false,
                written: false,
            });
        }
    }
}

/// One pass that draws: first what it reads, then what it writes.
fn draw(machine: &mut Machine<'_, '_>, tile: &mut Tile, step: StepId, member: StepPass, findings: &mut Findings<'_>) {
    let case = machine.case;
    machine.reads(step, member, |t| !case.in_tile(step, member, t), findings);
    for touch in case.touches(member) {
        if touch.access.kind.is_attachment() || case.in_tile(step, member, &touch) {
            consume(machine, tile, step, member.pass, &touch, findings);
        }
    }
    for touch in case.touches(member) {
        if touch.access.kind.is_attachment() && touch.access.mode.writes() {
            produce(machine, tile, step, member, &touch, findings);
        }
    }
    machine.writes(step, member, findings);
}

/// What a pass needs of what the tile holds.
fn consume(
    machine: &mut Machine<'_, '_>,
    tile: &mut Tile,
    step: StepId,
    pass: PassId,
    touch: &Touch<'_>,
    findings: &mut Findings<'_>,
) {
    let case = machine.case;
    let place = Machine::at(step, pass, touch);
    for (at, part) in case.parts.covered(touch.resource, touch.range).enumerate() {
        let Some(cell) = tile.cell(part) else {
            if touch.access.mode.needs_contents() {
                let nothing = Value::Garbage(Cause::NotAttached);
                if let Some(read) = case.reads(touch.id).get(at) {
                    machine.compare(nothing, read.value, place, touch, read.part, findings);
                }
            }
            continue;
        };
        cell.touched = true;
        match touch.access.mode {
            Mode::Read | Mode::Modify if case.reference.in_vain[touch.id] => {
                // Contents that nobody needs are not to be loaded, and blending needs some.
                let fits = match cell.value {
                    Value::Cleared(index) => !cell.initial || index == Attachment::ZERO,
                    value => !cell.initial || !value.is_garbage(),
                };
                findings.require(fits, Rule::ClearValue, place, || {
                    format!("the tile holds {}, should hold zero", cell.value.sentence(case.graph))
                });
                cell.used |= cell.initial && cell.value == Value::Cleared(Attachment::ZERO);
            }
            Mode::Read | Mode::Modify => {
                if let Some(read) = case.reads(touch.id).get(at) {
                    machine.compare(cell.value, read.value, place, touch, read.part, findings);
                }
                if cell.initial {
                    cell.used = true;
                    machine.memory.used(cell.source, pass);
                }
            }
            Mode::Clear => {
                let clears = case.graph.clears();
                let same = match cell.value {
                    Value::Cleared(found) => clears
                        .get(found as usize)
                        .zip(clears.get(touch.access.clear as usize))
                        .is_some_and(|(a, b)| a.same_bits(b)),
                    _ => false,
                };
                findings.require(same, Rule::ClearValue, place, || {
                    let declared = Value::Cleared(touch.access.clear).sentence(case.graph);
                    let found = cell.value.sentence(case.graph);
                    format!("the tile holds {found}, should hold {declared}")
                });
                cell.used |= cell.initial;
            }
            Mode::Overwrite => {}
        }
        if cell.initial && (!touch.access.mode.needs_contents() || case.reference.in_vain[touch.id]) {
            machine.memory.overwritten(cell.source);
        }
    }
}

/// What a pass leaves in the tile.
fn produce(
    machine: &Machine<'_, '_>,
    tile: &mut Tile,
    step: StepId,
    member: StepPass,
    touch: &Touch<'_>,
    findings: &mut Findings<'_>,
) {
    let case = machine.case;
    if touch.access.kind == AccessKind::Resolve {
        for samples in resolved_samples(case, step, member, touch) {
            tile.pending.push(Pending { pass: member.pass, samples });
        }
    }
    for part in case.parts.covered(touch.resource, touch.range) {
        match tile.cell(part) {
            Some(cell) => {
                cell.value = Value::Written(member.pass);
                (cell.initial, cell.written) = (false, true);
            }
            None => {
                let place = Machine::at(step, member.pass, touch);
                findings.violation(Rule::Attachments, place, "it is drawn into, and not attached");
            }
        }
    }
}

/// The subresources of the color attachment that a resolve averages: in the plan it must be the attachment of the slot
/// that the target's role names.
fn resolved_samples(case: &Case<'_>, step: StepId, member: StepPass, touch: &Touch<'_>) -> Vec<usize> {
    let averaged =
        case.touches(member).find(|t| t.access.kind == AccessKind::Color && t.access.slot == touch.access.slot);
    averaged
        .filter(|t| case.attachment(step, AccessKind::Color, t.resource, t.range).is_some())
        .map(|t| case.parts.covered(t.resource, t.range).collect())
        .unwrap_or_default()
}

/// One inlined pass: it runs inside the shader that draws its input, so what the tile holds in place of that input
/// becomes its output.
fn epilogue(
    machine: &mut Machine<'_, '_>,
    tile: &mut Tile,
    step: StepId,
    member: StepPass,
    findings: &mut Findings<'_>,
) {
    let case = machine.case;
    machine.reads(step, member, |_| true, findings);
    for touch in case.touches(member).filter(|t| t.in_shader) {
        if touch.access.kind == AccessKind::SamePixel {
            consume(machine, tile, step, member.pass, &touch, findings);
        }
    }
    for touch in case.touches(member).filter(|t| t.in_shader) {
        if touch.access.kind == AccessKind::Color {
            produce(machine, tile, step, member, &touch, findings);
        }
    }
}
