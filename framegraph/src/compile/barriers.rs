//! Phase 9: barriers, for back ends with explicit synchronization.
//!
//! A forward sweep tracks the last use of each subresource. Two uses need a barrier if one of them writes, or if they
//! need different layouts. Reads in the same layout need no barrier, but the next write waits for all of them.
//!
//! Attachment views contain both planes of a depth-stencil texture. A plane that no pass accesses is treated as
//! read-only.
//!
//! Imported resources start in the state declared by their owner, and wait for the owner's stages. The first use of
//! memory that another resource used before is an **aliasing barrier**: it waits for that resource, and its contents
//! are undefined.
//!
//! An import that may alias others also waits for their uses.

use super::loads::attached_range;
use super::ownership::{Owned, take_over};
use super::parts::Parts;
use super::steps::{Members, StepView};
use crate::access::{Access, AccessKind, Range};
use crate::barrier::{Barrier, Stages, State};
use crate::caps::Caps;
use crate::format::Aspect;
use crate::graph::{PassKind, Tables};
use crate::id::{ResourceId, StepId};
use crate::plan::{Attachment, Placement, Planned, Step};
use crate::resource::{Entry, Kind};

/// The last use of a subresource.
#[derive(Clone, Copy, Debug)]
struct Last {
    state: State,
    stages: Stages,
    writes: bool,
    step: StepId,
    /// The barrier that made the contents visible; none before the first.
    barrier: u32,
}

const NO_BARRIER: u32 = u32::MAX;

const NEVER: Last =
    Last { state: State::Undefined, stages: Stages::NONE, writes: false, step: StepId::NONE, barrier: NO_BARRIER };

/// Memory of the phase, reused between compilations.
#[derive(Debug, Default)]
pub(crate) struct BarrierScratch {
    last: Vec<Last>,
    /// The uses of one step, collected before they are compared.
    now: Vec<Use>,
    /// Resources that reuse memory, in the order of their first step: (first step, resource).
    tenants: Vec<(StepId, ResourceId)>,
    owned: Vec<Owned>,
    befores: Vec<Before>,
    /// The earlier uses of the aliases of each resource in `now` that has some.
    beside: Vec<(ResourceId, Beside)>,
}

/// Uses of the aliases of a resource.
#[derive(Clone, Copy, Debug)]
struct Beside {
    stages: Stages,
    /// The last one.
    step: StepId,
}

#[derive(Clone, Copy, Debug)]
struct Use {
    part: u32,
    resource: ResourceId,
    state: State,
    stages: Stages,
    writes: bool,
}

/// Returns the layout and the stages of an access.
fn wanted(access: &Access, kind: PassKind, in_tile: bool) -> (State, Stages) {
    let shader = match kind {
        PassKind::Raster => Stages::SHADER,
        PassKind::Compute => Stages::COMPUTE,
        PassKind::Copy => Stages::COPY,
    };
    match access.kind {
        // Depth is resolved in the color output stage (`VkSubpassDescriptionDepthStencilResolve`).
        AccessKind::Resolve if access.slot == Access::DEPTH => (State::DepthAttachment, Stages::COLOR),
        AccessKind::Color | AccessKind::Resolve => (State::ColorAttachment, Stages::COLOR),
        AccessKind::Depth => (State::DepthAttachment, Stages::DEPTH),
        AccessKind::DepthReadOnly => (State::DepthReadOnly, Stages::DEPTH),
        AccessKind::SamePixel if in_tile => (State::InputAttachment, Stages::SHADER),
        AccessKind::SamePixel | AccessKind::Sampled => (State::Sampled, shader),
        AccessKind::StorageRead | AccessKind::StorageWrite => (State::Storage, shader),
        AccessKind::Uniform => (State::Uniform, shader),
        AccessKind::Vertex | AccessKind::Index => (State::VertexInput, Stages::VERTEX_INPUT),
        AccessKind::Indirect => (State::Indirect, Stages::INDIRECT),
        AccessKind::CopySource => (State::CopySource, Stages::COPY),
        AccessKind::CopyTarget => (State::CopyTarget, Stages::COPY),
    }
}

/// Fills `barriers`, ordered by the step they precede, then by subresource.
pub(crate) fn barriers(
    view: StepView<'_>,
    steps: &[Step],
    caps: &Caps,
    parts: &Parts,
    attachments: &[Attachment],
    resources: &[Planned],
    scratch: &mut BarrierScratch,
    barriers: &mut Vec<Barrier>,
) {
    let graph = view.graph;
    let BarrierScratch { last, now, beside, .. } = scratch;
    barriers.clear();
    last.clear();
    beside.clear();
    last.resize(parts.total(), NEVER);
    for (id, row) in graph.resource_ids().zip(&graph.resources) {
        let (state, stages) = match row.kind {
            Kind::Imported { entry: Entry::Left { state, stages }, .. } => (state, stages),
            kind if kind.defined_on_entry() => (State::Entry, Stages::NONE),
            _ => continue,
        };
        parts.fill(last, id, Range::ALL, Last { state, stages, ..NEVER });
    }
    for (index, step) in steps.iter().enumerate() {
        let step_id = StepId::at(index);
        gather(parts, view.of(step), step.attachments.of(attachments), now);
        if !graph.aliases.is_empty() {
            find_aliases(graph, parts, last, now, beside);
        }
        let mut at = 0;
        while at < now.len() {
            let first = now[at];
            let before = last[first.part as usize];
            let mut end = at + 1;
            // Consecutive subresources with the same change share a barrier.
            while end < now.len()
                && same_change(&now[at], &now[end], at, end)
                && same_past(before, last[now[end].part as usize])
            {
                end += 1;
            }
            let beside = beside.iter().find(|(r, _)| *r == first.resource).map(|(_, beside)| *beside);
            let later = beside.is_some_and(|beside| before.step.is_none() || beside.step > before.step);
            let needs = before.step.is_none() || before.writes || first.writes || before.state != first.state || later;
            if needs {
                barriers.push(Barrier {
                    before: step_id,
                    resource: first.resource,
                    first_part: first.part - parts.all(first.resource).start as u32,
                    parts: (end - at) as u32,
                    from: before.state,
                    to: first.state,
                    from_stages: beside.map_or(before.stages, |beside| before.stages.union(beside.stages)),
                    to_stages: first.stages,
                    after: beside.filter(|_| later).map_or(before.step, |beside| beside.step),
                    aliases: ResourceId::NONE,
                });
            }
            for used in &now[at..end] {
                let past = &mut last[used.part as usize];
                let joins = !needs && past.state == used.state;
                let stages = if joins { past.stages.union(used.stages) } else { used.stages };
                let barrier = if needs { barriers.len() as u32 - 1 } else { past.barrier };
                // A later reader needs no barrier of its own, but the existing one must include its stages.
                if let Some(row) = barriers.get_mut(barrier as usize) {
                    row.to_stages = row.to_stages.union(used.stages);
                }
                *past = Last { state: used.state, stages, writes: used.writes, step: step_id, barrier };
            }
            at = end;
        }
    }
    aliasing_barriers(graph, caps, parts, resources, scratch, barriers);
    barriers.retain(|b| !is_silent(graph, resources, b));
    barriers.sort_unstable_by_key(|b| (b.before, b.resource, b.first_part));
}

/// Collects the earlier uses of the aliases of all buffers that a step uses.
#[cold]
fn find_aliases(graph: &Tables, parts: &Parts, last: &[Last], now: &[Use], beside: &mut Vec<(ResourceId, Beside)>) {
    beside.clear();
    for used in now {
        let parts = graph.aliases_of(used.resource).flat_map(|other| &last[parts.all(other)]);
        let uses = parts.filter(|last| !last.step.is_none()).map(|last| (last.stages, last.step));
        let all = uses.reduce(|(stages, step), (more, then)| (stages.union(more), step.max(then)));
        beside.extend(all.map(|(stages, step)| (used.resource, Beside { stages, step })));
    }
}

/// Returns `true` for a transition from undefined contents to a first use of memory that no step used before. Textures
/// still need it to set their layout; for buffers it is omitted.
fn is_silent(graph: &Tables, resources: &[Planned], barrier: &Barrier) -> bool {
    let resource = barrier.resource.index();
    let buffer = graph.resources[resource].desc.texture().is_none();
    barrier.after.is_none() && buffer && resources[resource].placement != Placement::External
}

/// Collects the uses of one step, one for each subresource.
///
/// Attachments take precedence over reads of the same subresource. Among reads, storage takes precedence, because its
/// layout supports all of them (`VK_IMAGE_LAYOUT_GENERAL`).
fn gather(parts: &Parts, members: Members<'_>, attachments: &[Attachment], now: &mut Vec<Use>) {
    now.clear();
    let format = |a: &Attachment| members.graph.resources[a.resource.index()].desc.texture().map(|t| t.format);
    for attachment in attachments.iter().filter(|a| format(a).is_some_and(|f| f.planes() > 1)) {
        let (resource, state, stages) = (attachment.resource, State::DepthReadOnly, Stages::DEPTH);
        parts.runs(resource, attached_range(attachment, Aspect::All), |run| {
            now.extend(run.map(|part| Use { part: part as u32, resource, state, stages, writes: false }));
        });
    }
    for (at, member) in members.passes.iter().enumerate() {
        let kind = members.graph.passes[member.pass.index()].kind;
        for access in members.accesses(at) {
            let (state, stages) = wanted(access, kind, members.in_tile(at, access));
            let (resource, range) = members.resource_range(access);
            let writes = access.mode.writes();
            parts.runs(resource, range, |run| {
                now.extend(run.map(|part| Use { part: part as u32, resource, state, stages, writes }));
            });
            if access.kind == AccessKind::Resolve && access.slot == Access::DEPTH {
                let own = members.graph.accesses_of(member.pass);
                let samples = own.iter().find(|a| a.is_resolved_by(access)).expect("a resolved texture is attached");
                let (resource, state) = (samples.resource, State::DepthReadOnly);
                parts.runs(resource, samples.range, |run| {
                    now.extend(run.map(|part| Use { part: part as u32, resource, state, stages, writes: false }));
                });
            }
        }
    }
    now.sort_unstable_by_key(|u| (u.part, !u.writes, u.state != State::Storage, u.state));
    now.dedup_by(|next, kept| {
        let same = next.part == kept.part;
        if same {
            kept.stages = kept.stages.union(next.stages);
            kept.writes |= next.writes;
        }
        same
    });
}

fn same_change(a: &Use, b: &Use, at: usize, end: usize) -> bool {
    b.part as usize == a.part as usize + (end - at)
        && (a.resource, a.state, a.stages, a.writes) == (b.resource, b.state, b.stages, b.writes)
}

fn same_past(a: Last, b: Last) -> bool {
    (a.state, a.stages, a.writes, a.step) == (b.state, b.stages, b.writes, b.step)
}

/// The uses that a resource waits for before it reuses memory.
#[derive(Clone, Copy, Debug)]
struct Before {
    previous: ResourceId,
    after: StepId,
    stages: Stages,
}

/// Turns the first barriers of resources that reuse memory into aliasing barriers. They wait for all previous resources
/// in that memory, and name the latest one.
fn aliasing_barriers(
    graph: &Tables,
    caps: &Caps,
    parts: &Parts,
    resources: &[Planned],
    scratch: &mut BarrierScratch,
    barriers: &mut [Barrier],
) {
    let BarrierScratch { last, tenants, owned, befores, .. } = scratch;
    tenants.clear();
    tenants.extend(resources.iter().enumerate().filter_map(|(index, row)| {
        let shared = matches!(row.placement, Placement::Slot(_) | Placement::Heap { .. });
        (shared && graph.resources[index].kind == Kind::Transient).then_some((row.first, ResourceId::at(index)))
    }));
    tenants.sort_unstable();
    befores.clear();
    befores.resize(resources.len(), Before { previous: ResourceId::NONE, after: StepId::NONE, stages: Stages::NONE });
    owned.clear();
    for &(_, tenant) in tenants.iter() {
        let row = &resources[tenant.index()];
        let buffer = graph.resources[tenant.index()].desc.texture().is_none();
        let (heap, start, end) = match row.placement {
            Placement::Slot(slot) => (2 + slot.index() as u32, 0, 1),
            Placement::Heap { offset } => {
                (u32::from(caps.separate_heaps && buffer), offset, offset.saturating_add(row.bytes.max(1)))
            }
            _ => continue,
        };
        let before = &mut befores[tenant.index()];
        take_over(owned, Owned { heap, start, end, resource: tenant }, |previous| {
            let past = &resources[previous.index()];
            if before.after.is_none() || past.last >= before.after {
                (before.previous, before.after) = (previous, past.last);
            }
            let stages = parts.all(previous).map(|p| last[p].stages);
            before.stages = stages.fold(before.stages, Stages::union);
        });
    }
    for barrier in barriers.iter_mut().filter(|b| b.after.is_none()) {
        let before = befores[barrier.resource.index()];
        if !before.previous.is_none() {
            (barrier.aliases, barrier.after) = (before.previous, before.after);
            barrier.from_stages = before.stages;
        }
    }
}
