//! Phase 6, forward half: attachments of each step and their load operations.
//!
//! The first pass of a step that accesses a plane determines its load operation: clear, don't care if it writes every
//! texel, or load if it uses the contents.

use super::parts::Parts;
use super::steps::{Members, StepView};
use crate::access::{Access, AccessKind, Mode, Range};
use crate::decision::{Decision, Reason, Subject};
use crate::format::{Aspect, Format};
use crate::graph::PassKind;
use crate::id::{PassId, Span, StepId};
use crate::plan::{Attachment, LoadOp, Role, Step, StoreOp};

/// Fills `attachments` with their load operations, and each step's span of them. `writers` is scratch memory: the last
/// writer of each subresource.
#[inline(never)]
pub(crate) fn loads(
    view: StepView<'_>,
    parts: &Parts,
    steps: &mut [Step],
    writers: &mut Vec<PassId>,
    attachments: &mut Vec<Attachment>,
    decisions: &mut Vec<Decision>,
) {
    attachments.clear();
    writers.clear();
    writers.resize(parts.total(), PassId::NONE);
    for (index, step) in steps.iter_mut().enumerate() {
        let start = attachments.len();
        let members = view.of(step);
        if step.kind == PassKind::Raster {
            gather(members, attachments);
            let before =
                |a: &Attachment| parts.find(writers, a.resource, attached_range(a, loaded(a)), |w| !w.is_none());
            log(StepId::at(index), &attachments[start..], before, decisions);
        }
        step.attachments = Span::new(start, attachments.len());
        for member in members.passes {
            for access in view.graph.accesses_of(member.pass).iter().filter(|a| a.mode.writes()) {
                let (resource, range) = members.resource_range(access);
                parts.fill(writers, resource, range, member.pass);
            }
        }
    }
}

/// Logs the load operations of a step; `before` returns the last writer of an attachment.
fn log(
    step: StepId,
    attachments: &[Attachment],
    before: impl Fn(&Attachment) -> Option<PassId>,
    decisions: &mut Vec<Decision>,
) {
    decisions.extend(attachments.iter().map(|attachment| {
        let reason = why_loaded(attachment, || before(attachment));
        Decision { subject: Subject::Load(step, attachment.resource), reason }
    }));
}

/// Returns the reason of an attachment's load operation; `before` returns its last writer.
pub(super) fn why_loaded(attachment: &Attachment, before: impl FnOnce() -> Option<PassId>) -> Reason {
    if attachment.loads() {
        loaded_after(before())
    } else if attachment.load == LoadOp::Clear || attachment.stencil_load == LoadOp::Clear {
        Reason::LoadClear
    } else {
        Reason::LoadOverwritten
    }
}

/// Returns the reason to load contents written by this pass, or the initial contents.
pub(super) fn loaded_after(writer: Option<PassId>) -> Reason {
    writer.map_or(Reason::LoadEntry, Reason::LoadWritten)
}

#[inline]
pub(super) const fn load_op(mode: Mode) -> LoadOp {
    const OPS: [LoadOp; 4] = {
        let mut ops = [LoadOp::Load; 4];
        ops[Mode::Clear as usize] = LoadOp::Clear;
        ops[Mode::Overwrite as usize] = LoadOp::DontCare;
        ops
    };
    OPS[mode as usize]
}

/// Adds the attachments of a step with their load operations.
#[inline(never)]
pub(super) fn gather(members: Members<'_>, attachments: &mut Vec<Attachment>) {
    let start = attachments.len();
    for at in 0..members.passes.len() {
        for access in members.accesses(at) {
            if access.kind.is_attachment() {
                attach(members, at, access, attachments, start);
            }
        }
    }
    if attachments.len() - start > 1 {
        attachments[start..].sort_unstable_by_key(|a| rank(a.role));
    }
}

const fn rank(role: Role) -> u8 {
    match role {
        Role::Color(slot) => slot,
        Role::Depth | Role::DepthReadOnly => 16,
        Role::ResolveTarget(slot, _) => 32 + slot,
        Role::ResolveDepth(_) => 48,
    }
}

/// Adds the attachment of one access to the step, or updates an existing one.
fn attach(members: Members<'_>, at: usize, access: &Access, attachments: &mut Vec<Attachment>, start: usize) {
    let (resource, range) = members.resource_range(access);
    let Some(texture) = members.graph.resources[resource.index()].desc.texture() else {
        return;
    };
    let layers = range.layer_range(texture.tracked_layers());
    let (layer, layers) = (layers.start as u16, (layers.end - layers.start) as u16);
    let found = attachments[start..].iter().position(|a| {
        a.resource == resource
            && a.mip == range.mip
            && a.layer == layer
            && a.role.is_resolve() == (access.kind == AccessKind::Resolve)
    });
    let index = match found {
        Some(found) => start + found,
        None => {
            let role = role(members, at, access, &attachments[start..]);
            attachments.push(Attachment {
                resource,
                mip: range.mip,
                layer,
                layers,
                view: range.view,
                role,
                load: LoadOp::DontCare,
                store: StoreOp::None,
                stencil_load: LoadOp::DontCare,
                stencil_store: StoreOp::None,
                clear: u32::MAX,
            });
            attachments.len() - 1
        }
    };
    refine(&mut attachments[index], access, texture.format, found.is_none());
}

/// Returns the role of an attachment. Uses the next free color slot if another pass of the step occupies the declared
/// one.
fn role(members: Members<'_>, at: usize, access: &Access, taken: &[Attachment]) -> Role {
    match access.kind {
        AccessKind::DepthReadOnly => Role::DepthReadOnly,
        AccessKind::Depth => Role::Depth,
        AccessKind::Resolve if access.slot == Access::DEPTH => Role::ResolveDepth(access.resolve),
        AccessKind::Resolve => {
            let pass = members.graph.accesses_of(members.passes[at].pass);
            let averaged = pass.iter().find(|a| a.is_resolved_by(access));
            let slot = averaged.and_then(|c| {
                let (resource, range) = members.resource_range(c);
                taken.iter().find_map(|t| match t.role {
                    Role::Color(slot) if t.resource == resource && t.mip == range.mip && t.layer == range.layer => {
                        Some(slot)
                    }
                    _ => None,
                })
            });
            Role::ResolveTarget(slot.unwrap_or(access.slot), access.resolve)
        }
        _ => {
            let free = |slot: u8| !taken.iter().any(|t| t.role == Role::Color(slot));
            Role::Color(if free(access.slot) {
                access.slot
            } else {
                (0..u8::MAX).find(|s| free(*s)).unwrap_or(access.slot)
            })
        }
    }
}

/// Sets the load operations of the planes that this access is the first of the step to use.
#[inline]
fn refine(attachment: &mut Attachment, access: &Access, format: Format, first: bool) {
    if access.kind == AccessKind::Depth {
        attachment.role = Role::Depth;
    }
    let load = load_op(access.mode);
    let (has_depth, has_stencil) = (format.has_depth(), format.has_stencil());
    let covers = |aspect: Aspect| access.range.aspect == Aspect::All || access.range.aspect == aspect;
    // The first access of a plane decides; `Store` marks the plane as accessed until the backward half.
    let depth = if has_depth || has_stencil { has_depth && covers(Aspect::Depth) } else { true };
    let cleared = |clear| {
        if load == LoadOp::Clear { access.clear } else { clear }
    };
    if depth && (first || attachment.store == StoreOp::None) {
        (attachment.load, attachment.store) = (load, StoreOp::Store);
        attachment.clear = cleared(attachment.clear);
    }
    if !has_stencil {
        (attachment.stencil_load, attachment.stencil_store) = (attachment.load, attachment.store);
        return;
    }
    if covers(Aspect::Stencil) && (first || attachment.stencil_store == StoreOp::None) {
        (attachment.stencil_load, attachment.stencil_store) = (load, StoreOp::Store);
        attachment.clear = cleared(attachment.clear);
    }
    if !has_depth {
        (attachment.load, attachment.store) = (attachment.stencil_load, attachment.stencil_store);
    }
}

/// Returns `true` if an attachment is resolved into another one of its step.
pub(crate) fn is_resolved(of_step: &[Attachment], attachment: &Attachment) -> bool {
    of_step.iter().any(|a| a.role.resolves(attachment.role))
}

/// Returns the range that an attachment covers.
pub(crate) fn attached_range(attachment: &Attachment, aspect: Aspect) -> Range {
    Range { mip: attachment.mip, mips: 1, layer: attachment.layer, layers: attachment.layers, aspect, ..Range::ALL }
}

/// Returns the loaded planes of an attachment with at least one loaded plane.
fn loaded(attachment: &Attachment) -> Aspect {
    match (attachment.load, attachment.stencil_load) {
        (LoadOp::Load, LoadOp::Load) => Aspect::All,
        (LoadOp::Load, _) => Aspect::Depth,
        _ => Aspect::Stencil,
    }
}
