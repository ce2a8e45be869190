//! Resources and their memory.

use super::names::Names;
use super::value::{Json, field, object};
use crate::access::Usage;
use crate::barrier::{Stages, State};
use crate::dump::describe::{held, offsets, shape};
use crate::id::{ResourceId, StepId};
use crate::plan::{Placement, Plan, Planned};
use crate::resource::{Desc, Entry, Exit, Kind};

/// Returns the declared resources.
pub(super) fn resources(plan: &Plan, names: &Names) -> Json {
    let offsets = offsets(plan);
    Json::list(plan.graph().resource_ids().map(|r| resource(plan, names, r, offsets[r.index()])))
}

fn resource(plan: &Plan, names: &Names, resource: ResourceId, offset: Option<u64>) -> Json {
    let graph = plan.graph();
    let declared = &graph.resources()[resource.index()];
    let row = &plan.resources()[resource.index()];
    let texture = declared.desc.texture();
    let slot = match row.placement {
        Placement::Slot(slot) => Some(slot.index()),
        _ => None,
    };
    let (entry, exit) = match declared.kind {
        Kind::Imported { entry, exit } => (Some(entry_of(entry)), Some(exit)),
        _ => (None, None),
    };
    object([
        field("name", names.resource(resource)),
        field("kind", declared.kind.word()),
        field("entry", entry),
        field("exit", exit.map(|e| if e == Exit::Keep { "keep" } else { "discard" })),
        field("may_alias", Json::list(graph.aliases_of(resource).map(|r| names.resource(r)))),
        field("shape", shape(plan, &declared.desc, row.format)),
        field("format", plan.format(resource).map(|f| format!("{f:?}"))),
        field("extent", texture.map(|t| t.extent.texels(plan.frame()).to_vec())),
        field("mips", texture.map(|t| t.mip_count(plan.frame()))),
        field("layers", texture.map(|t| u32::from(t.layers))),
        field("samples", texture.map(|t| u32::from(t.samples))),
        field("usage", uses(row.usage)),
        field("first_step", row.first.some().map(StepId::index)),
        field("last_step", row.last.some().map(StepId::index)),
        field("held_steps", held(plan, resource).map(|(first, last)| vec![first.index(), last.index()])),
        field("bytes", row.bytes),
        field("memoryless", row.placement == Placement::Memoryless),
        field("placement", row.placement.word()),
        field("offset", offset),
        field("slot", slot),
    ])
}

/// Returns the initial state of an import, and the stages that its first use waits for.
fn entry_of(entry: Entry) -> Json {
    let (state, stages) = match entry {
        Entry::Defined => (State::Entry, Stages::NONE),
        Entry::Undefined => (State::Undefined, Stages::NONE),
        Entry::Left { state, stages } => (state, stages),
    };
    object([
        field("defined", entry.is_defined()),
        field("state", state.word()),
        field("stages", Json::list(stages.names())),
    ])
}

/// Returns the histories, each with the earlier images that this frame reads.
pub(super) fn histories(plan: &Plan, names: &Names) -> Json {
    let graph = plan.graph();
    let rows = || graph.resource_ids().zip(graph.resources());
    Json::list(rows().filter_map(|(history, row)| {
        let Kind::HistoryCurrent { frames } = row.kind else { return None };
        let previous = rows().filter_map(|(image, row)| match row.kind {
            Kind::HistoryPrevious { current, age } if current == history => {
                Some(object([field("resource", names.resource(image)), field("age", u32::from(age))]))
            }
            _ => None,
        });
        let Planned { bytes, placement, .. } = plan.resources()[history.index()];
        let stride = bytes.next_multiple_of(plan.caps().texture_alignment_bytes.max(1));
        let images = u32::from(frames) + 1;
        let first = match placement {
            Placement::Heap { offset } => Some(offset),
            _ => None,
        };
        let offsets = first.into_iter().flat_map(|first| (0..images).map(move |age| first + stride * u64::from(age)));
        Some(object([
            field("name", names.resource(history)),
            field("images", images),
            field("image_bytes", bytes),
            field("offsets", Json::list(offsets)),
            field("previous", Json::list(previous)),
        ]))
    }))
}

/// Returns the physical textures and buffers of the pool, each with its resources in order of time.
pub(super) fn slots(plan: &Plan, names: &Names) -> Json {
    let mut tenants = vec![Vec::new(); plan.slots().len()];
    for resource in plan.graph().resource_ids() {
        if let Placement::Slot(slot) = plan.resources()[resource.index()].placement {
            tenants[slot.index()].push(resource);
        }
    }
    let mut end = 0u64;
    let slots = plan.slots().iter().zip(tenants).enumerate();
    Json::list(slots.map(|(index, (slot, mut tenants))| {
        tenants.sort_by_key(|r| plan.resources()[r.index()].first);
        let offset = end;
        end = end.saturating_add(slot.bytes);
        let format = match slot.desc {
            Desc::Texture(t) => Some(t.format),
            Desc::Buffer(_) => None,
        };
        object([
            field("index", index),
            field("shape", shape(plan, &slot.desc, format)),
            field("usage", uses(slot.usage)),
            field("bytes", slot.bytes),
            field("offset", offset),
            field("tenants", Json::list(tenants.iter().map(|r| names.resource(*r)))),
        ])
    }))
}

fn uses(usage: Usage) -> Json {
    Json::list(usage.names())
}
