//! Decisions with names in the place of ids.

use crate::decision::{Decision, Reason, Subject};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::Plan;
use serde::Serialize;

/// One decision.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DecisionView {
    /// About what: `pass`, `load`, `store` or `resource`.
    pub about: &'static str,
    /// The pass that it is about.
    pub pass: Option<String>,
    /// The resource that it is about.
    pub resource: Option<String>,
    /// The step that it is about.
    pub step: Option<usize>,
    /// What was decided, from a closed list: the name of the [`Reason`] in snake case.
    pub reason: String,
    /// Why a merge, an inlining or a memoryless attachment was refused, from a closed list; none for other reasons.
    pub refusal: Option<String>,
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
        let (other_pass, other_resource) = named(decision.reason);
        let pass_name = |p: PassId| graph.pass_name(p).to_owned();
        let resource_name = |r: ResourceId| graph.resource_name(r).to_owned();
        let hint = decision.reason.hint();
        Self {
            about,
            pass: pass.map(pass_name),
            resource: resource.map(resource_name),
            step: step.map(StepId::index),
            reason: reason_word(decision.reason),
            refusal: refusal_word(decision.reason),
            other_pass: other_pass.map(pass_name),
            other_resource: other_resource.map(resource_name),
            sentence: decision.reason.sentence(graph),
            hint: Some(hint).filter(|h| !h.is_empty()),
        }
    }
}

/// The pass and the resource that a reason names.
const fn named(reason: Reason) -> (Option<PassId>, Option<ResourceId>) {
    match reason {
        Reason::KeptExport(r)
        | Reason::KeptImport(r)
        | Reason::KeptHistory(r)
        | Reason::CulledUnread(r)
        | Reason::SlotAfter(r)
        | Reason::PlacedAfter(r) => (None, Some(r)),
        Reason::KeptReadBy(r, p) | Reason::CulledReaderCulled(r, p) | Reason::CulledOverwritten(r, p) => {
            (Some(p), Some(r))
        }
        Reason::OrderMerge(p)
        | Reason::OrderBytes(p)
        | Reason::MergedAttachments(p)
        | Reason::MergedSamePixel(p)
        | Reason::MergedInline(p)
        | Reason::Split(p, _)
        | Reason::NotInlined(p, _)
        | Reason::LoadWritten(p)
        | Reason::StoreReadBy(p) => (Some(p), None),
        Reason::KeptSideEffect
        | Reason::KeptCullingOff
        | Reason::CulledNoOutput
        | Reason::LoadClear
        | Reason::ClearUnneeded
        | Reason::LoadOverwritten
        | Reason::LoadEntry
        | Reason::StoreExport
        | Reason::StoreImport
        | Reason::StoreHistory
        | Reason::DiscardUnread
        | Reason::DiscardOverwritten
        | Reason::DiscardResolved
        | Reason::StoreUnchanged
        | Reason::Memoryless(_)
        | Reason::NeedsMemory(_)
        | Reason::Inlined
        | Reason::SlotFirst
        | Reason::Placed
        | Reason::External
        | Reason::Persistent
        | Reason::AliasingOff
        | Reason::Unused => (None, None),
    }
}

/// The name of a reason, in snake case.
pub(crate) fn reason_word(reason: Reason) -> String {
    variant(&reason)
}

fn refusal_word(reason: Reason) -> Option<String> {
    match reason {
        Reason::Split(_, why) | Reason::NotInlined(_, why) => Some(variant(&why)),
        Reason::NeedsMemory(why) => Some(variant(&why)),
        _ => None,
    }
}

/// The name of an enumeration's variant, `KeptReadBy` as `kept_read_by`.
pub(super) fn variant(value: &impl Serialize) -> String {
    let name = match serde_json::to_value(value) {
        Ok(serde_json::Value::String(name)) => name,
        Ok(serde_json::Value::Object(fields)) => fields.keys().next().cloned().unwrap_or_default(),
        // Enumerations of ids and of each other are written as one of the two.
        _ => String::new(),
    };
    let mut out = String::with_capacity(name.len() + 4);
    for c in name.chars() {
        if c.is_uppercase() && !out.is_empty() {
            out.push('_');
        }
        out.extend(c.to_lowercase());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decision::Refusal;

    #[test]
    fn variants_are_named_in_snake_case() {
        assert_eq!(variant(&Reason::KeptReadBy(ResourceId::at(1), PassId::at(2))), "kept_read_by");
        assert_eq!(variant(&Reason::Inlined), "inlined");
        let split = Reason::Split(PassId::at(0), Refusal::ComputeBetween);
        assert_eq!(refusal_word(split).as_deref(), Some("compute_between"));
    }
}
