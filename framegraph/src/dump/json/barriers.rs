//! Barriers with names in the place of ids.

use crate::barrier::{Barrier, Stages};
use crate::id::StepId;
use crate::plan::Plan;

/// A transition or a hand-over of memory in front of a step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct BarrierView {
    /// Index of the step that it stands in front of.
    pub before_step: usize,
    /// Whose parts change their use.
    pub resource: String,
    /// First part: `(plane · layers + layer) · mips + mip`.
    pub first_part: u32,
    /// How many consecutive parts.
    pub parts: u32,
    /// What they were used as: `undefined`, `entry`, `color_attachment`, …
    pub from: &'static str,
    /// What they will be used as.
    pub to: &'static str,
    /// What must be over: `shader`, `color`, …
    pub from_stages: Vec<&'static str>,
    /// What waits.
    pub to_stages: Vec<&'static str>,
    /// Index of the step whose work is waited for; none for what happened before the frame.
    pub after_step: Option<usize>,
    /// The resource whose memory is taken over; none when it is no hand-over.
    pub hand_over: Option<String>,
}

impl BarrierView {
    pub(super) fn new(plan: &Plan, barrier: &Barrier) -> Self {
        let name = |r| plan.graph().resource_name(r).to_owned();
        let stages = |s: Stages| s.names().collect();
        Self {
            before_step: barrier.before.index(),
            resource: name(barrier.resource),
            first_part: barrier.first_part,
            parts: barrier.parts,
            from: barrier.from.word(),
            to: barrier.to.word(),
            from_stages: stages(barrier.from_stages),
            to_stages: stages(barrier.to_stages),
            after_step: barrier.after.some().map(StepId::index),
            hand_over: barrier.hand_over.some().map(name),
        }
    }
}
