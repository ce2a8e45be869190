//! Runs a plan on symbolic values: reads and writes of main memory, and the state at the end of the frame.
//!
//! The documentation of the module `check` defines the lattice and the transfer functions.

use super::finding::{Place, Rule, WasteKind};
use super::memory::{Memory, StoreRecord};
use super::reference::{Cause, Value, Wanted};
use super::rule_input::{PlannedAccess, RuleInput};
use framegraph::id::StepId;
use framegraph::plan::{StepPass, StoreOp};

/// The state of a run.
pub(super) struct Machine<'c, 'p> {
    pub(super) ctx: &'c RuleInput<'p>,
    pub(super) memory: Memory,
    pub(super) loaded: Vec<(usize, Value)>,
}

impl Machine<'_, '_> {
    /// Performs the reads of a pass from main memory for which `chosen` is true.
    pub(super) fn reads(&mut self, step: StepId, member: StepPass, chosen: impl Fn(&PlannedAccess) -> bool) {
        let ctx = self.ctx;
        for planned in ctx.planned_accesses(member) {
            let elsewhere = planned.access.kind.is_attachment() || planned.in_shader;
            if elsewhere || !planned.access.needs_contents() || !chosen(&planned) {
                continue;
            }
            // A replaced resource has no memory, so it is looked up under its own name.
            let resource = planned.access.resource;
            let place = (step, member.pass, resource);
            if !self.memory.exists(resource) {
                ctx.report.violation(Rule::NoMemory, place, "it is read, but has no memory");
                continue;
            }
            for read in ctx.reads(planned.id) {
                let found = self.memory.value(resource, read.part);
                self.compare(found, read.value, place.into(), &planned, read.part);
                let source = self.memory.source(read.part);
                self.memory.used(source, member.pass);
            }
        }
    }

    /// Performs the writes of a pass to main memory.
    pub(super) fn writes(&mut self, step: StepId, member: StepPass) {
        let ctx = self.ctx;
        let uses = ctx.planned_accesses(member).map(|t| t.access);
        for access in uses.filter(|a| !a.kind.is_attachment() && a.mode.writes()) {
            let resource = access.resource;
            if !self.memory.exists(resource) {
                let place = (step, member.pass, resource);
                ctx.report.violation(Rule::NoMemory, place, "it is written, but has no memory");
                continue;
            }
            if !access.needs_contents() {
                for part in ctx.covered(&access) {
                    self.memory.overwritten(self.memory.source(part));
                }
            }
            for part in ctx.covered(&access) {
                self.memory.set(part, Value::Written(member.pass), None);
            }
        }
    }

    /// Compares the value of a read with the expected one.
    pub(super) fn compare(&self, found: Value, expected: Value, place: Place, planned: &PlannedAccess, part: usize) {
        if found == expected {
            return;
        }
        let ctx = self.ctx;
        let own = planned.access.resource;
        let word = planned.access.kind.word();
        let (finds, should) = (found.sentence(ctx.graph), expected.sentence(ctx.graph));
        let rule = if found.is_garbage() { Rule::Garbage } else { Rule::Version };
        let place = (place, own, ctx.parts.name(own, part));
        ctx.report.violation(rule, place, format_args!("`{word}` finds {finds}, expected {should}"));
    }

    /// Checks the contents that must survive the frame.
    pub(super) fn exit(&mut self) {
        let RuleInput { graph, parts, reference, report, .. } = self.ctx;
        for (resource, part) in graph.resource_ids().flat_map(|r| parts.all(r).map(move |part| (r, part))) {
            let expected = reference.exit[part];
            let Some(why) = reference.wanted[part] else {
                continue;
            };
            if let Some(source) = self.memory.source(part) {
                self.memory.records[source].survived = true;
            }
            let found = self.memory.value(resource, part);
            // Contents that no pass of the declared frame wrote cannot be lost.
            if expected == Value::Garbage(Cause::NeverWritten) || found == expected {
                continue;
            }
            let (why, holds, should) = (why.sentence(), found.sentence(graph), expected.sentence(graph));
            let detail = format_args!("{why}, but contains {holds} at the end of the frame, expected {should}");
            report.violation(Rule::Exit, (resource, parts.name(resource, part)), detail);
        }
    }

    /// Reports stores that no pass reads, and contents kept or stored again without a use.
    pub(super) fn wasted(&self) {
        let plan = self.ctx.plan;
        // Passes may read it through another import.
        let aliased = |record: &StoreRecord| self.ctx.graph.has_alias(plan.attachments()[record.attachment].resource);
        for record in &self.memory.records {
            let (kind, what) = match record.op {
                _ if !record.readers.is_empty() || record.survived || record.bound || aliased(record) => continue,
                StoreOp::Discard => continue,
                StoreOp::Store => (WasteKind::Store, "stored"),
                StoreOp::None => (WasteKind::Discard, "kept in memory"),
            };
            let step = plan.step_ids().find(|s| self.ctx.step(*s).attachments.range().contains(&record.attachment));
            let place = (step.unwrap_or_default(), plan.attachments()[record.attachment].resource);
            let plane = record.plane;
            self.ctx.report.waste(kind, place, format_args!("plane {plane} is {what}, but no pass reads it there"));
        }
    }
}

impl Wanted {
    fn sentence(self) -> &'static str {
        match self {
            Self::Export => "it is exported",
            Self::Import => "it is imported with `Exit::Keep`",
            Self::History => "later frames read it",
        }
    }
}
