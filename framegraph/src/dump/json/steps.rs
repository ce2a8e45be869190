//! Passes, steps and attachments, with names.

use super::super::reasons::Reasons;
use super::super::{load_word, store_word};
use crate::decision::Subject;
use crate::format::Aspect;
use crate::id::{PassId, StepId};
use crate::plan::{Attachment, Join, Plan, Role};

/// A declared pass.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct PassView {
    /// Its full name.
    pub name: String,
    /// `raster`, `compute` or `copy`.
    pub kind: &'static str,
    /// Whether it was culled.
    pub culled: bool,
    /// Why it was culled, or kept.
    pub reason: String,
    /// Index of its step; none when it was culled.
    pub step: Option<usize>,
    /// How it came into its step: `first`, `attachments`, `same_pixel` or `inlined`; none when it was culled.
    pub join: Option<&'static str>,
    /// What it touches.
    pub accesses: Vec<AccessView>,
}

/// One access of a pass.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct AccessView {
    /// What is touched.
    pub resource: String,
    /// `color`, `sampled`, …
    pub kind: &'static str,
    /// `read`, `clear`, `overwrite` or `modify`.
    pub mode: &'static str,
}

/// A step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct StepView {
    /// Its place in the plan, from 0.
    pub index: usize,
    /// `raster`, `compute` or `copy`.
    pub kind: &'static str,
    /// Names of its passes, in order.
    pub passes: Vec<String>,
    /// Width and height of its attachments in texels; 0 without attachments.
    pub extent: [u32; 2],
    /// Layers of its attachments; 0 without attachments.
    pub layers: u32,
    /// Samples of its attachments.
    pub samples: u8,
    /// Its attachments: colors by slot, then depth, then resolve targets.
    pub attachments: Vec<AttachmentView>,
    /// Attachments loaded.
    pub unresolves: u32,
    /// Attachments stored.
    pub resolves: u32,
    /// Bytes loaded.
    pub unresolve_bytes: u64,
    /// Bytes stored.
    pub resolve_bytes: u64,
}

/// One attachment of a step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct AttachmentView {
    /// What is attached.
    pub resource: String,
    /// `color`, `depth`, `depth_read_only` or `resolve`.
    pub role: &'static str,
    /// Slot of a color attachment, or of the one that a resolve target averages.
    pub slot: Option<u8>,
    /// Its level.
    pub mip: u8,
    /// Its first layer.
    pub layer: u16,
    /// Its number of layers.
    pub layers: u16,
    /// `load`, `clear` or `dont_care`, of the color or depth plane.
    pub load: &'static str,
    /// `store`, `discard` or `none`, of the color or depth plane.
    pub store: &'static str,
    /// The same for the stencil plane; none where the format has none.
    pub stencil_load: Option<&'static str>,
    /// The same for the stencil plane; none where the format has none.
    pub stencil_store: Option<&'static str>,
    /// Why it is loaded, cleared or neither.
    pub load_reason: String,
    /// Why it is stored, discarded or neither.
    pub store_reason: String,
    /// Bytes loaded.
    pub unresolve_bytes: u64,
    /// Bytes stored.
    pub resolve_bytes: u64,
}

impl PassView {
    pub(super) fn new(plan: &Plan, reasons: &Reasons, pass: PassId) -> Self {
        let graph = plan.graph();
        let step = plan.pass_steps()[pass.index()].some();
        let member = step.and_then(|s| plan.passes_of(s).iter().find(|m| m.pass == pass));
        let accesses = graph.accesses_of(pass).iter().map(|a| AccessView {
            resource: graph.resource_name(a.resource).into(),
            kind: a.kind.word(),
            mode: a.mode.word(),
        });
        Self {
            name: graph.pass_name(pass).into(),
            kind: graph.passes()[pass.index()].kind.word(),
            culled: plan.is_culled(pass),
            reason: reasons.verdict(plan, pass),
            step: step.map(StepId::index),
            join: member.map(|m| join_word(m.join)),
            accesses: accesses.collect(),
        }
    }
}

impl StepView {
    pub(super) fn new(plan: &Plan, reasons: &Reasons, step: StepId) -> Self {
        let graph = plan.graph();
        let row = &plan.steps()[step.index()];
        let counts = plan.step_counts(step);
        let traffic = plan.step_traffic(step, plan.frame());
        let passes = plan.passes_of(step).iter();
        let attachments = plan.attachments_of(step).iter();
        Self {
            index: step.index(),
            kind: row.kind.word(),
            passes: passes.map(|m| graph.pass_name(m.pass).to_owned()).collect(),
            extent: row.extent,
            layers: row.layers,
            samples: row.samples,
            attachments: attachments.map(|a| AttachmentView::new(plan, reasons, step, a)).collect(),
            unresolves: counts.unresolves,
            resolves: counts.resolves,
            unresolve_bytes: traffic.loaded_bytes,
            resolve_bytes: traffic.stored_bytes,
        }
    }
}

impl AttachmentView {
    fn new(plan: &Plan, reasons: &Reasons, step: StepId, attachment: &Attachment) -> Self {
        let Attachment { resource, mip, layer, layers, role, load, store, .. } = *attachment;
        let (role, slot) = match role {
            Role::Color(slot) => ("color", Some(slot)),
            Role::Depth => ("depth", None),
            Role::DepthReadOnly => ("depth_read_only", None),
            Role::Resolve(slot) => ("resolve", Some(slot)),
        };
        let stencil = plan.format(resource).and_then(|f| attachment.ops(f, Aspect::Stencil));
        let (unresolve_bytes, resolve_bytes) = plan.attachment_bytes(attachment, plan.frame());
        let why = |subject| reasons.sentence(plan, subject);
        Self {
            resource: plan.graph().resource_name(resource).into(),
            role,
            slot,
            mip,
            layer,
            layers,
            load: load_word(load),
            store: store_word(store),
            stencil_load: stencil.map(|(load, _)| load_word(load)),
            stencil_store: stencil.map(|(_, store)| store_word(store)),
            load_reason: why(Subject::Load(step, resource)),
            store_reason: why(Subject::Store(step, resource)),
            unresolve_bytes,
            resolve_bytes,
        }
    }
}

/// The word for the way into a step.
pub(crate) const fn join_word(join: Join) -> &'static str {
    match join {
        Join::First => "first",
        Join::Attachments => "attachments",
        Join::SamePixel => "same_pixel",
        Join::Inlined => "inlined",
    }
}
