//! Phase 4, last part: full-screen passes for resolves that the device cannot perform while storing.
//!
//! A full-screen pass reads the samples from memory and writes the resolve targets. It forms a step of its own after
//! the step of the pass that declares the resolves. It is added after merging, so that it does not prevent merges.
//! Later phases treat it like any other pass. The plan refers to it by its declarer, with [`Join::Resolve`].

use crate::access::{Access, AccessKind, Mode, Range};
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Subject};
use crate::format::Aspect;
use crate::graph::{Declared, PassFlags, PassKind, Tables};
use crate::id::{AccessId, PassId, Span, StepId};
use crate::plan::{Join, Step, StepPass};

/// Memory of the phase, reused between compilations.
#[derive(Debug, Default)]
pub(crate) struct Lowering {
    /// The graph with added full-screen passes, and without the resolves they perform.
    graph: Tables,
    /// The declarer of each added pass.
    declarers: Vec<PassId>,
}

impl Lowering {
    /// Adds steps for the resolves that the device does not support. Returns the graph that includes them, or `None` if
    /// there are none.
    pub(crate) fn lower(
        &mut self,
        graph: &Tables,
        caps: &Caps,
        steps: &mut Vec<Step>,
        step_passes: &mut Vec<StepPass>,
        pass_steps: &mut [StepId],
        decisions: &mut Vec<Decision>,
    ) -> Option<&Tables> {
        self.declarers.clear();
        let format = |a: &Access| graph.resources[a.resource.index()].desc.texture().map(|t| t.format);
        let lacks = |a: &Access| a.kind == AccessKind::Resolve && !caps.resolves_in_store(a, format(a));
        let resolves = |p: PassId| graph.passes[p.index()].flags.has(PassFlags::RESOLVES);
        if !graph.resolves
            || !step_passes.iter().any(|m| resolves(m.pass) && graph.accesses_of(m.pass).iter().any(lacks))
        {
            return None;
        }
        self.graph.copy_work(graph);
        let mut at = 0;
        while at < steps.len() {
            let step = steps[at];
            at += 1;
            for member in step.passes.range() {
                let pass = step_passes[member].pass;
                if !graph.accesses_of(pass).iter().any(lacks) {
                    continue;
                }
                for access in graph.accesses_of(pass).iter().filter(|a| lacks(a)) {
                    let reason = Reason::ResolvePass(access.resource);
                    decisions.push(Decision { subject: Subject::Pass(pass), reason });
                }
                let end = steps[at - 1].passes.range().end;
                let added = PassId::at(self.graph.passes.len());
                self.full_screen_pass(graph, pass, lacks);
                let passes = Span::new(end, end + 1);
                steps.insert(
                    at,
                    Step { kind: PassKind::Raster, samples: 1, passes, attachments: Span::default(), ..step },
                );
                step_passes.insert(end, StepPass { pass: added, join: Join::First });
                at += 1;
                for later in &mut steps[at..] {
                    later.passes.start += 1;
                }
            }
        }
        for (index, step) in steps.iter().enumerate() {
            for member in step.passes.of(step_passes) {
                if let Some(own) = pass_steps.get_mut(member.pass.index()) {
                    *own = StepId::at(index);
                }
            }
        }
        Some(&self.graph)
    }

    /// Removes the unsupported resolves from a pass and adds a full-screen pass that performs them.
    fn full_screen_pass(&mut self, declared: &Tables, pass: PassId, lacking: impl Fn(&Access) -> bool) {
        let Tables { passes, accesses, .. } = &mut self.graph;
        let (row, own) = (declared.passes[pass.index()], declared.accesses_of(pass));
        let start = accesses.len();
        for resolve in own.iter().filter(|a| lacking(a)) {
            let samples = own.iter().find(|a| a.is_resolved_by(resolve)).expect("a resolved texture is attached");
            let format = declared.resources[samples.resource.index()].desc.texture().map(|t| t.format);
            let planes = format.is_some_and(|f| f.has_depth() && f.has_stencil());
            let aspect = if planes { Aspect::Depth } else { samples.range.aspect };
            let range = Range { aspect, ..samples.range };
            accesses.push(Access { kind: AccessKind::Sampled, mode: Mode::Read, range, slot: 0, clear: 0, ..*samples });
            let (kind, slot) =
                if resolve.slot == Access::DEPTH { (AccessKind::Depth, 0) } else { (AccessKind::Color, resolve.slot) };
            accesses.push(Access { kind, slot, ..*resolve });
        }
        let added = Span::new(start, accesses.len());
        let span = &mut passes[pass.index()].accesses;
        for at in span.range().rev() {
            if lacking(&accesses[at]) {
                accesses[at..span.range().end].rotate_left(1);
                span.len -= 1;
            }
        }
        let sole_color = AccessId::NONE;
        passes.push(Declared { accesses: added, flags: PassFlags::default(), sole_color, ..row });
        self.declarers.push(pass);
    }

    /// Replaces the added passes in the plan by their declarers. `declared` is the number of declared passes.
    pub(crate) fn rename(&self, declared: usize, step_passes: &mut [StepPass], decisions: &mut [Decision]) {
        let declarer = |pass: PassId| pass.index().checked_sub(declared).map(|added| self.declarers[added]);
        for member in step_passes {
            if let Some(pass) = declarer(member.pass) {
                *member = StepPass { pass, join: Join::Resolve };
            }
        }
        for decision in decisions {
            match decision.reason {
                Reason::StoreReadBy(reader) => {
                    decision.reason = declarer(reader).map_or(decision.reason, Reason::StoreResolved);
                }
                Reason::LoadWritten(writer) => {
                    decision.reason = declarer(writer).map_or(decision.reason, Reason::LoadWritten);
                }
                _ => {}
            }
        }
    }
}
