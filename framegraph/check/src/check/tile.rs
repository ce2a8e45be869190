//! Tile memory: runs a raster step from its load operations through its passes. Store operations are in `stores`.

use super::finding::Rule;
use super::machine::Machine;
use super::memory::Source;
use super::reference::{Cause, Value};
use super::rule_input::{PlannedAccess, RuleInput};
use framegraph::access::{AccessKind, Mode, Range};
use framegraph::id::{PassId, StepId};
use framegraph::plan::{Attachment, Join, LoadOp, StepPass, StoreOp};
use framegraph::resource::Dimension;

/// One part in the tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) part: usize,
    pub(super) plane: u32,
    pub(super) value: Value,
    /// The source of the contents in memory before the step.
    source: Source,
    /// No pass has written it yet, so it has the value of the load operation.
    initial: bool,
    /// A pass used the value of the load operation.
    pub(super) used: bool,
    /// A pass drew into it or read it.
    pub(super) accessed: bool,
    /// A pass changed it.
    pub(super) written: bool,
}

/// The tile: the parts of the attachments of the current step, and an index by part.
pub(super) struct Tile {
    cells: Vec<Cell>,
    of_part: Vec<Option<usize>>,
    /// Resolves at the end of the step: the declaring pass, a part of the samples, and its value after the pass.
    resolves: Vec<(PassId, usize, Value)>,
}

impl Tile {
    pub(super) fn new(parts: usize) -> Self {
        Self { cells: Vec::new(), of_part: vec![None; parts], resolves: Vec::new() }
    }

    pub(super) fn cell(&mut self, part: usize) -> Option<&mut Cell> {
        let at = self.of_part[part]?;
        self.cells.get_mut(at)
    }

    /// Clears the tile for the next step.
    pub(super) fn close(&mut self) {
        for cell in self.cells.drain(..) {
            self.of_part[cell.part] = None;
        }
    }
}

/// Returns load and store operation of one plane of an attachment; `plane` is 1 for stencil of a format that also has
/// depth.
pub(super) const fn ops(attachment: &Attachment, plane: u32) -> (LoadOp, StoreOp) {
    if plane == 0 { (attachment.load, attachment.store) } else { (attachment.stencil_load, attachment.stencil_store) }
}

/// Runs one raster step up to its store operations.
pub(super) fn raster(machine: &mut Machine<'_, '_>, tile: &mut Tile, step: StepId) {
    let ctx = machine.ctx;
    load(machine, tile, step);
    for &member in ctx.plan.passes_of(step) {
        draw(machine, tile, step, member);
    }
    for (pass, samples, value) in std::mem::take(&mut tile.resolves) {
        let unchanged = tile.cell(samples).is_some_and(|c| c.value == value);
        let why = "the samples changed after the pass that resolves them";
        ctx.report.require(unchanged, Rule::Resolve, (step, pass), why);
    }
}

/// Performs the load operations.
fn load(machine: &mut Machine<'_, '_>, tile: &mut Tile, step: StepId) {
    let ctx = machine.ctx;
    for (index, attachment) in ctx.attachments(step) {
        let resource = attachment.resource;
        for part in ctx.attached(attachment) {
            if tile.of_part[part].is_some() {
                continue; // overlapping attachments are reported elsewhere
            }
            let plane = ctx.parts.name(resource, part).plane;
            let source = machine.memory.source(part);
            let value = match ops(attachment, plane).0 {
                LoadOp::Load => {
                    let exists = machine.memory.exists(resource);
                    ctx.report.require(exists, Rule::NoMemory, (step, resource), "it is loaded, but has no memory");
                    let value = machine.memory.value(resource, part);
                    machine.loaded.push((index, latest_of_level(machine, attachment, part)));
                    value
                }
                LoadOp::Clear => Value::Cleared(attachment.clear),
                LoadOp::DontCare => Value::Garbage(Cause::DontCare),
            };
            tile.of_part[part] = Some(tile.cells.len());
            let (used, accessed, written) = (false, false, false);
            tile.cells.push(Cell { part, plane, value, source, initial: true, used, accessed, written });
        }
    }
}

/// Runs one raster pass: first its reads, then its writes. An inlined pass runs inside of the shader that draws its
/// input, so its output replaces the input in the tile.
fn draw(machine: &mut Machine<'_, '_>, tile: &mut Tile, step: StepId, member: StepPass) {
    let ctx = machine.ctx;
    let inlined = member.join == Join::Inlined;
    let in_tile = |t: &PlannedAccess| {
        if inlined { t.in_shader } else { t.access.kind.is_attachment() || ctx.in_tile(step, member, t) }
    };
    machine.reads(step, member, |t| inlined || !in_tile(t));
    for planned in ctx.planned_accesses(member).filter(|t| in_tile(t) && !(inlined && t.access.mode.writes())) {
        consume(machine, tile, step, member.pass, &planned);
    }
    for planned in ctx.planned_accesses(member).filter(|t| in_tile(t) && t.access.mode.writes()) {
        produce(machine, tile, step, member, &planned);
    }
    if !inlined {
        machine.writes(step, member);
    }
}

/// Checks the values that a pass reads from the tile.
fn consume(machine: &mut Machine<'_, '_>, tile: &mut Tile, step: StepId, pass: PassId, planned: &PlannedAccess) {
    let ctx = machine.ctx;
    let access = planned.access;
    let place = (step, pass, access.resource);
    let in_vain = ctx.reference.in_vain[planned.id];
    if planned.range.slice {
        keep(machine, tile, (step, pass), planned);
    }
    for (at, part) in ctx.parts.covered(planned.resource, planned.range).enumerate() {
        let reads = ctx.reads(planned.id);
        let read = if planned.range.slice { reads.iter().find(|r| r.part == part) } else { reads.get(at) };
        let Some(cell) = tile.cell(part) else {
            if let Some(read) = read.filter(|_| access.needs_contents()) {
                let nothing = Value::Garbage(Cause::NotAttached);
                machine.compare(nothing, read.value, place.into(), planned, read.part);
            }
            continue;
        };
        cell.accessed = true;
        let found = cell.value;
        let refuse = |should: &str| {
            let why = format_args!("the tile contains {}, expected {should}", found.sentence(ctx.graph));
            ctx.report.violation(Rule::ClearValue, place, why);
        };
        match access.mode {
            Mode::Read | Mode::Modify if in_vain => {
                // Contents that are not used must not be loaded, but blending needs a defined value.
                let fits = match cell.value {
                    Value::Cleared(index) => !cell.initial || index == Attachment::ZERO,
                    value => !cell.initial || !value.is_garbage(),
                };
                if !fits {
                    refuse("zero");
                }
                cell.used |= cell.initial && cell.value == Value::Cleared(Attachment::ZERO);
            }
            Mode::Read | Mode::Modify => {
                if let Some(read) = read {
                    machine.compare(cell.value, read.value, place.into(), planned, read.part);
                }
                if cell.initial {
                    cell.used = true;
                    machine.memory.used(cell.source, pass);
                }
            }
            Mode::Clear => {
                let value = |index: u32| ctx.graph.clears().get(index as usize);
                let same = match cell.value {
                    Value::Cleared(found) => value(found).is_some() && value(found) == value(access.clear),
                    _ => false,
                };
                if !same {
                    refuse(&Value::Cleared(access.clear).sentence(ctx.graph));
                }
                cell.used |= cell.initial;
            }
            Mode::Overwrite => {}
        }
        if cell.initial && !planned.range.slice && (!access.needs_contents() || in_vain) {
            machine.memory.overwritten(cell.source);
        }
    }
}

/// Checks the other slices of a level when one slice is drawn: the tile or memory must have the contents to keep.
fn keep(machine: &mut Machine<'_, '_>, tile: &mut Tile, (step, pass): (StepId, PassId), planned: &PlannedAccess) {
    let ctx = machine.ctx;
    if ctx.reference.in_vain[planned.id] {
        return;
    }
    let own: Vec<_> = ctx.parts.covered(planned.resource, planned.range).collect();
    for read in ctx.reads(planned.id) {
        let drawn = tile.cell(read.part).filter(|cell| cell.written).map(|cell| cell.value);
        if !own.contains(&read.part) && !read.value.is_garbage() {
            let found = drawn.unwrap_or_else(|| machine.memory.value(planned.resource, read.part));
            machine.compare(found, read.value, (step, pass, planned.resource).into(), planned, read.part);
        }
        if drawn.is_none() {
            machine.memory.used(machine.memory.source(read.part), pass);
        }
    }
}

/// Returns the value of a part in memory; for a slice, the value that the last pass left in a slice of its level.
fn latest_of_level(machine: &Machine<'_, '_>, attachment: &Attachment, part: usize) -> Value {
    let ctx = machine.ctx;
    let range = Range { mip: attachment.mip, mips: 1, ..Range::ALL };
    let slices = ctx.texture(attachment.resource).filter(|t| t.dimension == Dimension::D3);
    let level = slices.into_iter().flat_map(|_| ctx.parts.covered(attachment.resource, range));
    let values = level.chain([part]).map(|part| machine.memory.value(attachment.resource, part));
    let position = |value: &Value| match value {
        Value::Written(pass) => ctx.position[pass.index()],
        _ => None,
    };
    values.max_by_key(position).unwrap_or(Value::Garbage(Cause::NeverWritten))
}

/// Sets the values that a pass leaves in the tile.
fn produce(machine: &Machine<'_, '_>, tile: &mut Tile, step: StepId, member: StepPass, planned: &PlannedAccess) {
    let ctx = machine.ctx;
    if planned.access.kind == AccessKind::Resolve {
        for part in averaged_parts(ctx, step, member, planned) {
            let value = tile.cell(part).map_or(Value::Garbage(Cause::NotAttached), |cell| cell.value);
            tile.resolves.push((member.pass, part, value));
        }
    }
    for part in ctx.parts.covered(planned.resource, planned.range) {
        if let Some(cell) = tile.cell(part) {
            cell.value = Value::Written(member.pass);
            (cell.initial, cell.written) = (false, true);
        } else {
            let place = (step, member.pass, planned.access.resource);
            ctx.report.violation(Rule::Attachments, place, "it is drawn into, but not attached");
        }
    }
}

/// Returns the parts of the source of a resolve, without stencil. The source must be attached in the plan.
fn averaged_parts(ctx: &RuleInput<'_>, step: StepId, member: StepPass, resolve: &PlannedAccess) -> Vec<usize> {
    let averaged = ctx.averaged(member, resolve);
    averaged
        .filter(|t| ctx.attachment(step, t.access.kind, t.resource, t.range).is_some())
        .map(|t| {
            let parts = ctx.parts.covered(t.resource, t.range);
            parts.filter(|part| ctx.parts.name(t.resource, *part).plane == 0).collect()
        })
        .unwrap_or_default()
}
