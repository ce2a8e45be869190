//! Write access to the arrays of plans and graphs, for `framegraph-check`, which breaks plans on purpose.
//!
//! Nothing in this module is stable.

use crate::access::Access;
use crate::barrier::Barrier;
use crate::decision::{Decision, Names, Reason};
use crate::graph::Graph;
use crate::handle::{Tag, Texture};
use crate::id::{StepId, VersionId};
use crate::options::Options;
use crate::plan::{Attachment, Memory, Plan, Planned, Slot, Step, StepPass};

/// The arrays of a plan, for writing.
#[derive(Debug)]
#[expect(missing_docs, reason = "each field is the array that the method of the same name returns")]
pub struct PlanArrays<'a> {
    pub options: &'a mut Options,
    pub compilation: &'a mut u64,
    pub pass_steps: &'a mut Vec<StepId>,
    pub steps: &'a mut Vec<Step>,
    pub step_passes: &'a mut Vec<StepPass>,
    pub attachments: &'a mut Vec<Attachment>,
    pub resources: &'a mut Vec<Planned>,
    pub slots: &'a mut Vec<Slot>,
    pub memory: &'a mut Memory,
    pub barriers: &'a mut Vec<Barrier>,
    pub decisions: &'a mut Vec<Decision>,
}

/// Returns the arrays of a plan for writing, and gives the plan a new compilation number.
pub fn arrays(plan: &mut Plan) -> PlanArrays<'_> {
    plan.number();
    PlanArrays {
        options: &mut plan.options,
        compilation: &mut plan.compilation,
        pass_steps: &mut plan.pass_steps,
        steps: &mut plan.steps,
        step_passes: &mut plan.step_passes,
        attachments: &mut plan.attachments,
        resources: &mut plan.resources,
        slots: &mut plan.slots,
        memory: &mut plan.memory,
        barriers: &mut plan.barriers,
        decisions: &mut plan.decisions,
    }
}

/// Returns the accesses of a graph for writing.
pub fn accesses(graph: &mut Graph) -> &mut [Access] {
    &mut graph.tables_mut().0.accesses
}

/// Returns every reason whose fields are present in `names`.
pub fn reasons(names: Names) -> Vec<Reason> {
    Reason::all(names)
}

/// A handle of no graph, for accesses that must be refused.
pub const NO_TEXTURE: Texture = Texture { tag: Tag(0), version: VersionId::NONE };
