//! The machine that runs a plan, step by step, on symbols: main memory here, tile memory in `tile`.
//!
//! See the module documentation of `check` for the lattice and the transfer functions.

use super::case::{Case, Touch};
use super::finding::{Findings, Place, Rule, WasteKind};
use super::memory::{Deed, DeedKind, Memory};
use super::reference::{Cause, Value, Wanted};
use super::tile;
use crate::id::{PassId, StepId};
use crate::plan::StepPass;

/// What a run leaves for the phases that judge the decision log.
pub(super) struct Trace {
    /// Every op at the end of a step, with what became of it.
    pub(super) deeds: Vec<Deed>,
    /// Every value that a load op brought into the tile: attachment of the plan, value.
    pub(super) loaded: Vec<(usize, Value)>,
}

/// The state of a run.
pub(super) struct Machine<'c, 'p> {
    pub(super) case: &'c Case<'p>,
    pub(super) memory: Memory,
    pub(super) loaded: Vec<(usize, Value)>,
}

/// Runs the plan from entry to exit.
pub(super) fn run(case: &Case<'_>, findings: &mut Findings<'_>) -> Trace {
    let mut machine = Machine { case, memory: Memory::on_entry(case.plan, &case.parts), loaded: Vec::new() };
    let mut cells = tile::Tile::new(case.parts.total());
    for step in case.plan.step_ids() {
        if case.is_raster(step) {
            tile::raster(&mut machine, &mut cells, step, findings);
        } else {
            for member in case.plan.passes_of(step) {
                machine.reads(step, *member, |_| true, findings);
                machine.writes(step, *member, findings);
            }
        }
    }
    machine.exit(findings);
    machine.wasted(findings);
    Trace { deeds: machine.memory.deeds, loaded: machine.loaded }
}

impl Machine<'_, '_> {
    /// The reads that a pass makes in main memory, among those that `chosen` picks.
    pub(super) fn reads(
        &mut self,
        step: StepId,
        member: StepPass,
        chosen: impl Fn(&Touch<'_>) -> bool,
        findings: &mut Findings<'_>,
    ) {
        for touch in self.case.touches(member) {
            let elsewhere = touch.access.kind.is_attachment() || touch.in_shader;
            if elsewhere || !touch.access.mode.needs_contents() || !chosen(&touch) {
                continue;
            }
            let place = Place::step(step).and_pass(member.pass);
            // What an inlined pass replaced exists nowhere, so it is looked for under its own name.
            let resource = touch.access.resource;
            if !self.memory.exists(resource) {
                let place = place.and_resource(resource);
                findings.violation(Rule::NoMemory, place, "it is read, and has no memory");
                continue;
            }
            for read in self.case.reads(touch.id) {
                let found = self.memory.value(resource, read.part);
                self.compare(found, read.value, place, &touch, read.part, findings);
                let source = self.memory.source(resource, read.part);
                self.memory.used(source, member.pass);
            }
        }
    }

    /// The writes that a pass makes in main memory.
    pub(super) fn writes(&mut self, step: StepId, member: StepPass, findings: &mut Findings<'_>) {
        for touch in self.case.touches(member) {
            if touch.access.kind.is_attachment() || !touch.access.mode.writes() {
                continue;
            }
            let (resource, range) = (touch.access.resource, touch.access.range);
            if !self.memory.exists(resource) {
                let place = Place::step(step).and_pass(member.pass);
                let place = place.and_resource(resource);
                findings.violation(Rule::NoMemory, place, "it is written, and has no memory");
                continue;
            }
            for part in self.case.parts.covered(resource, range) {
                if !touch.access.mode.needs_contents() {
                    let source = self.memory.source(resource, part);
                    self.memory.overwritten(source);
                }
            }
            self.memory.take(resource, &self.case.parts);
            for part in self.case.parts.covered(resource, range) {
                self.memory.set(part, Value::Written(member.pass), None);
            }
        }
    }

    /// What a read found against what it must find.
    pub(super) fn compare(
        &self,
        found: Value,
        expected: Value,
        place: Place,
        touch: &Touch<'_>,
        part: usize,
        findings: &mut Findings<'_>,
    ) {
        if found == expected {
            return;
        }
        let own = touch.access.resource;
        let place = place.and_resource(own);
        let place = place.and_part(self.case.parts.name(own, part));
        let sentence = format!(
            "`{}` finds {}, should find {}",
            touch.access.kind.word(),
            found.sentence(self.case.graph),
            expected.sentence(self.case.graph)
        );
        let rule = if found.is_garbage() { Rule::Garbage } else { Rule::Version };
        findings.violation(rule, place, sentence);
    }

    /// What must survive the frame, and does it?
    fn exit(&mut self, findings: &mut Findings<'_>) {
        let Case { graph, parts, reference, .. } = self.case;
        for resource in graph.resource_ids() {
            for part in parts.all(resource) {
                let expected = reference.exit[part];
                let Some(why) = reference.wanted[part] else {
                    continue;
                };
                if let Some(deed) = self.memory.source(resource, part) {
                    self.memory.deeds[deed].survived = true;
                }
                let found = self.memory.value(resource, part);
                // What nobody wrote in the declared frame is nothing that anybody can lose.
                if expected == Value::Garbage(Cause::NeverWritten) || found == expected {
                    continue;
                }
                let place = Place::resource(resource).and_part(parts.name(resource, part));
                let sentence = format!(
                    "{}, and holds {} when the frame ends, should hold {}",
                    why.sentence(),
                    found.sentence(graph),
                    expected.sentence(graph)
                );
                findings.violation(Rule::Exit, place, sentence);
            }
        }
    }

    /// Stores that nobody reads, and contents that were left or stored once more for nobody.
    fn wasted(&self, findings: &mut Findings<'_>) {
        for deed in &self.memory.deeds {
            if !deed.readers.is_empty() || deed.survived || deed.bound || deed.kind == DeedKind::Discarded {
                continue;
            }
            let attachment = &self.case.plan.attachments()[deed.attachment];
            let step = self.case.plan.steps().iter().position(|s| {
                let range = s.attachments.range();
                range.contains(&deed.attachment)
            });
            let place = Place::step(step.map_or(StepId::NONE, StepId::at));
            let place = place.and_resource(attachment.resource);
            let plane = deed.plane;
            if deed.kind == DeedKind::Stored {
                let sentence = format!("plane {plane} is stored, and nobody reads it there");
                findings.waste(WasteKind::Store, place, sentence);
            } else {
                let sentence = format!("plane {plane} is left in memory, and nobody reads it there");
                findings.waste(WasteKind::Discard, place, sentence);
            }
        }
    }

    /// Where a finding about a pass of a step and a resource is.
    pub(super) fn at(step: StepId, pass: PassId, touch: &Touch<'_>) -> Place {
        Place::step(step).and_pass(pass).and_resource(touch.access.resource)
    }
}

impl Wanted {
    fn sentence(self) -> &'static str {
        match self {
            Self::Export => "it is exported",
            Self::Import => "it is imported and must survive",
            Self::History => "later frames read it",
        }
    }
}
