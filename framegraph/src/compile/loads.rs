//! Phase 6, forward half: the attachments of each step, and how their contents come into the tile.
//!
//! The first pass of a step that touches a plane decides: it clears, or it writes every texel (don't care), or it needs
//! what is there (load). Nothing here is chosen by the user.

use super::group::in_tile;
use super::inline::{InlinedInto, effective};
use super::parts::Parts;
use super::shape::sole_color;
use crate::access::{Access, AccessKind, Mode, Range};
use crate::decision::{Decision, Reason, Subject};
use crate::format::{Aspect, Format};
use crate::graph::{PassKind, Tables};
use crate::id::{AccessId, PassId, ResourceId, Span, StepId};
use crate::plan::{Attachment, Join, LoadOp, Role, Step, StepPass, StoreOp};

/// Where the stores of an attachment are decided.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    /// Whose attachment it is.
    pub(crate) step: StepId,
    /// The access that attaches it, where it is the only attachment of a step of one pass, the color attachment of a texture
    /// of one part.
    pub(crate) sole: AccessId,
    /// Whether it is averaged into another attachment of the step.
    pub(crate) resolved: bool,
}

/// Fills `attachments` and each step's span of them, with load ops, and `ends`, parallel to them, where versions know who
/// wrote what: every resource has one part, and none stands in another's stead.
#[inline(never)]
pub(crate) fn loads_of_wholes(
    graph: &Tables,
    steps: &mut [Step],
    step_passes: &[StepPass],
    ends: &mut Vec<End>,
    attachments: &mut Vec<Attachment>,
    decisions: &mut Vec<Decision>,
) {
    attachments.clear();
    ends.clear();
    for (index, step) in steps.iter_mut().enumerate() {
        // There are no more steps than passes, and passes were counted.
        let (step_id, start) = (StepId::unchecked(index), attachments.len());
        step.attachments = Span::new(start, start);
        if step.kind != PassKind::Raster {
            continue;
        }
        let members = step.passes.of(step_passes);
        if let Some(sole) = sole_color(graph, members) {
            let access = &graph.accesses[sole.index()];
            attachments.push(plain(access));
            ends.push(End { step: step_id, sole, resolved: false });
            let subject = Subject::Load(step_id, access.resource);
            if access.mode.needs_contents() {
                let reason = loaded_after(writer_before(graph, access));
                decisions.push(Decision { subject, reason });
            } else {
                let cleared = access.mode == Mode::Clear;
                let reason = if cleared { Reason::LoadClear } else { Reason::LoadOverwritten };
                decisions.push(Decision { subject, reason });
            }
        } else {
            gather(graph, members, &[], attachments);
            let of_step = &attachments[start..];
            log(step_id, of_step, |a| writer_before_step(graph, members, a.resource), decisions);
            ends.extend(of_step.iter().map(|a| {
                let resolved = is_resolved(of_step, a);
                End { step: step_id, sole: AccessId::NONE, resolved }
            }));
        }
        step.attachments = Span::new(start, attachments.len());
    }
}

/// Fills `attachments` and each step's span of them, with load ops; `writers` is scratch (who wrote each part last).
#[inline(never)]
pub(crate) fn loads(
    graph: &Tables,
    parts: &Parts,
    steps: &mut [Step],
    step_passes: &[StepPass],
    inlined_into: &InlinedInto,
    writers: &mut Vec<PassId>,
    attachments: &mut Vec<Attachment>,
    decisions: &mut Vec<Decision>,
) {
    attachments.clear();
    writers.clear();
    writers.resize(parts.total(), PassId::NONE);
    for (index, step) in steps.iter_mut().enumerate() {
        let start = attachments.len();
        let members = step.passes.of(step_passes);
        if step.kind == PassKind::Raster {
            gather(graph, members, inlined_into, attachments);
            let before = |a: &Attachment| parts.find(writers, a.resource, covered(a, loaded(a)), |w| !w.is_none());
            log(StepId::at(index), &attachments[start..], before, decisions);
        }
        step.attachments = Span::new(start, attachments.len());
        for member in members {
            let accesses = graph.accesses_of(member.pass);
            for access in accesses.iter().filter(|a| a.mode.writes()) {
                let (resource, range) = effective(graph, inlined_into, access);
                parts.fill(writers, resource, range, member.pass);
            }
        }
    }
}

/// Says of each attachment of a step how its contents come into the tile; `before` tells who wrote what is loaded.
fn log(
    step: StepId,
    attachments: &[Attachment],
    before: impl Fn(&Attachment) -> Option<PassId>,
    decisions: &mut Vec<Decision>,
) {
    decisions.extend(attachments.iter().map(|attachment| {
        let reason = if attachment.loads() {
            loaded_after(before(attachment))
        } else if attachment.load == LoadOp::Clear || attachment.stencil_load == LoadOp::Clear {
            Reason::LoadClear
        } else {
            Reason::LoadOverwritten
        };
        Decision { subject: Subject::Load(step, attachment.resource), reason }
    }));
}

/// Why contents are loaded that this pass wrote, if any did.
fn loaded_after(writer: Option<PassId>) -> Reason {
    writer.map_or(Reason::LoadEntry, Reason::LoadWritten)
}

/// The color attachment of a texture of one part, alone in its step.
#[inline]
fn plain(access: &Access) -> Attachment {
    let load = load_op(access.mode);
    let clear = if load == LoadOp::Clear { access.clear } else { u32::MAX };
    Attachment {
        resource: access.resource,
        mip: 0,
        layer: 0,
        layers: 1,
        role: Role::Color(access.slot),
        load,
        store: StoreOp::Store,
        stencil_load: load,
        stencil_store: StoreOp::Store,
        clear,
    }
}

#[inline]
const fn load_op(mode: Mode) -> LoadOp {
    const OPS: [LoadOp; 4] = {
        let mut ops = [LoadOp::Load; 4];
        ops[Mode::Clear as usize] = LoadOp::Clear;
        ops[Mode::Overwrite as usize] = LoadOp::DontCare;
        ops
    };
    OPS[mode as usize]
}

/// Who wrote a resource of one part last before this access.
#[inline(never)]
fn writer_before(graph: &Tables, access: &Access) -> Option<PassId> {
    let version = if access.mode.writes() { graph.versions[access.version.index()].previous } else { access.version };
    graph.versions[version.index()].writer.some()
}

/// Who wrote a resource of one part last before these passes.
fn writer_before_step(graph: &Tables, members: &[StepPass], resource: ResourceId) -> Option<PassId> {
    let mut accesses = members.iter().flat_map(|m| graph.accesses_of(m.pass));
    writer_before(graph, accesses.find(|a| a.resource == resource)?)
}

/// Adds the attachments of a step.
#[inline(never)]
fn gather(graph: &Tables, members: &[StepPass], inlined_into: &InlinedInto, attachments: &mut Vec<Attachment>) {
    let start = attachments.len();
    for (at, member) in members.iter().enumerate() {
        if member.join == Join::Inlined {
            continue;
        }
        let accesses = graph.accesses_of(member.pass);
        for access in accesses {
            if access.kind.is_attachment() {
                attach(graph, accesses, access, inlined_into, attachments, start);
            } else if in_tile(graph, &members[..at], member.join, access, inlined_into) {
                read(graph, access, inlined_into, &mut attachments[start..]);
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
        Role::Resolve(slot) => 32 + slot,
    }
}

/// Adds the attachment of one access to the step, or refines the one that is there.
fn attach(
    graph: &Tables,
    pass: &[Access],
    access: &Access,
    inlined_into: &InlinedInto,
    attachments: &mut Vec<Attachment>,
    start: usize,
) {
    let (resource, range) = effective(graph, inlined_into, access);
    let Some(texture) = graph.resources[resource.index()].desc.texture() else {
        return;
    };
    let layers = range.layer_range(texture.tracked_layers());
    let (layer, layers) = (layers.start as u16, (layers.end - layers.start) as u16);
    let found = attachments[start..].iter().position(|a| {
        a.resource == resource
            && a.mip == range.mip
            && a.layer == layer
            && is_resolve(a.role) == (access.kind == AccessKind::Resolve)
    });
    let index = match found {
        Some(found) => start + found,
        None => {
            let role = role(graph, inlined_into, pass, access, &attachments[start..]);
            attachments.push(Attachment {
                resource,
                mip: range.mip,
                layer,
                layers,
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

/// A read in the tile: planes that no pass of the step touched before are loaded for it.
fn read(graph: &Tables, access: &Access, inlined_into: &InlinedInto, attachments: &mut [Attachment]) {
    let (resource, range) = effective(graph, inlined_into, access);
    let shown =
        |a: &&mut Attachment| (a.resource, a.mip, a.layer) == (resource, range.mip, range.layer) && !is_resolve(a.role);
    let texture = graph.resources[resource.index()].desc.texture();
    if let (Some(attachment), Some(texture)) = (attachments.iter_mut().find(shown), texture) {
        refine(attachment, access, texture.format, false);
    }
}

const fn is_resolve(role: Role) -> bool {
    matches!(role, Role::Resolve(_))
}

/// What the attachment is for; a color slot that another pass of the step has taken moves to the next free one.
fn role(graph: &Tables, inlined_into: &InlinedInto, pass: &[Access], access: &Access, taken: &[Attachment]) -> Role {
    match access.kind {
        AccessKind::DepthReadOnly => Role::DepthReadOnly,
        AccessKind::Depth => Role::Depth,
        AccessKind::Resolve => {
            let averaged = pass.iter().find(|a| a.kind == AccessKind::Color && a.slot == access.slot);
            let slot = averaged.and_then(|c| {
                let (resource, range) = effective(graph, inlined_into, c);
                taken.iter().find_map(|t| match t.role {
                    Role::Color(slot) if t.resource == resource && t.mip == range.mip && t.layer == range.layer => {
                        Some(slot)
                    }
                    _ => None,
                })
            });
            Role::Resolve(slot.unwrap_or(access.slot))
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

/// Sets the ops of the planes that this access is the first of the step to touch.
#[inline]
fn refine(attachment: &mut Attachment, access: &Access, format: Format, first: bool) {
    if access.kind == AccessKind::Depth {
        attachment.role = Role::Depth;
    }
    let load = load_op(access.mode);
    let (has_depth, has_stencil) = (format.has_depth(), format.has_stencil());
    let touches = |aspect: Aspect| access.range.aspect == Aspect::All || access.range.aspect == aspect;
    // A plane is decided by the first access that touches it; `Store` marks it as touched until the backward half.
    let depth = if has_depth || has_stencil { has_depth && touches(Aspect::Depth) } else { true };
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
    if touches(Aspect::Stencil) && (first || attachment.stencil_store == StoreOp::None) {
        (attachment.stencil_load, attachment.stencil_store) = (load, StoreOp::Store);
        attachment.clear = cleared(attachment.clear);
    }
    if !has_depth {
        (attachment.load, attachment.store) = (attachment.stencil_load, attachment.stencil_store);
    }
}

/// Whether an attachment is averaged into another one of those of its step.
pub(crate) fn is_resolved(of_step: &[Attachment], attachment: &Attachment) -> bool {
    match attachment.role {
        Role::Color(slot) => of_step.iter().any(|a| a.role == Role::Resolve(slot)),
        _ => false,
    }
}

/// The range of parts that an attachment covers, all planes.
pub(crate) fn covered(attachment: &Attachment, aspect: Aspect) -> Range {
    Range { mip: attachment.mip, mips: 1, layer: attachment.layer, layers: attachment.layers, aspect }
}

/// The planes that are loaded, of an attachment of which some are.
fn loaded(attachment: &Attachment) -> Aspect {
    match (attachment.load, attachment.stencil_load) {
        (LoadOp::Load, LoadOp::Load) => Aspect::All,
        (LoadOp::Load, _) => Aspect::Depth,
        _ => Aspect::Stencil,
    }
}
