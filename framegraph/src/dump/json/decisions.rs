//! Decisions with names in the place of ids.

use crate::decision::{Decision, MemoryNeed, Names, Refusal, Subject};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::Plan;

/// One decision.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct DecisionView {
    /// About what: `pass`, `load`, `store` or `resource`.
    pub about: &'static str,
    /// The pass that it is about.
    pub pass: Option<String>,
    /// The resource that it is about.
    pub resource: Option<String>,
    /// The step that it is about.
    pub step: Option<usize>,
    /// What was decided, from a closed list: [`Reason::word`](crate::Reason::word).
    pub reason: &'static str,
    /// Why a merge, an inlining or a memoryless attachment was refused, from a closed list; none for other reasons.
    pub refusal: Option<&'static str>,
    /// Another pass that the reason names.
    pub other_pass: Option<String>,
    /// Another resource that the reason names.
    pub other_resource: Option<String>,
    /// What was decided and why, in words.
    pub sentence: String,
    /// What to change to have it otherwise; none where there is nothing to want.
    pub hint: Option<&'static str>,
}

impl DecisionView {
    pub(super) fn new(plan: &Plan, decision: Decision) -> Self {
        let graph = plan.graph();
        let (about, pass, resource, step) = match decision.subject {
            Subject::Pass(p) => ("pass", Some(p), None, None),
            Subject::Load(s, r) => ("load", None, Some(r), Some(s)),
            Subject::Store(s, r) => ("store", None, Some(r), Some(s)),
            Subject::Resource(r) => ("resource", None, Some(r), None),
        };
        let Names { pass: other_pass, resource: other_resource, refusal, need, .. } = decision.reason.names();
        let pass_name = |p: PassId| graph.pass_name(p).to_owned();
        let resource_name = |r: ResourceId| graph.resource_name(r).to_owned();
        let hint = decision.reason.hint();
        Self {
            about,
            pass: pass.map(pass_name),
            resource: resource.map(resource_name),
            step: step.map(StepId::index),
            reason: decision.reason.word(),
            refusal: refusal.map(Refusal::word).or(need.map(MemoryNeed::word)),
            other_pass: other_pass.map(pass_name),
            other_resource: other_resource.map(resource_name),
            sentence: decision.reason.sentence(graph),
            hint: Some(hint).filter(|h| !h.is_empty()),
        }
    }
}
