//! Resources and the places they have, with names.

use super::super::{held, offsets, shape};
use crate::access::Usage;
use crate::id::{ResourceId, StepId};
use crate::plan::{Placement, Plan};
use crate::resource::{Desc, Kind};

/// A declared resource.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct ResourceView {
    /// Its full name.
    pub name: String,
    /// `transient`, `imported`, `history` or `previous`.
    pub kind: &'static str,
    /// Its shape in words.
    pub shape: String,
    /// The format it is made with; none for a buffer.
    pub format: Option<String>,
    /// Width and height in texels; none for a buffer.
    pub extent: Option<[u32; 2]>,
    /// Levels; none for a buffer.
    pub mips: Option<u32>,
    /// Layers; none for a buffer.
    pub layers: Option<u16>,
    /// Samples; none for a buffer.
    pub samples: Option<u8>,
    /// Every use that survives culling.
    pub usage: Vec<&'static str>,
    /// Index of the first step that touches it; none when no kept pass does.
    pub first_step: Option<usize>,
    /// Index of the last step that touches it; none when no kept pass does.
    pub last_step: Option<usize>,
    /// First and last step over which it keeps its place in shared memory: those above, or all of them for the image of a
    /// history in a heap. None where it takes no shared memory.
    pub held_steps: Option<[usize; 2]>,
    /// Bytes, without padding, that it takes or would take.
    pub bytes: u64,
    /// Whether it takes no memory, being an attachment of one step.
    pub memoryless: bool,
    /// `unused`, `memoryless`, `inlined`, `slot`, `heap`, `external` or `own`.
    pub placement: &'static str,
    /// Bytes from the start of the heap; in a pool, of the slots laid end to end. None where it takes no shared memory.
    pub offset: Option<u64>,
    /// Index of its slot in the pool; none outside of a pool.
    pub slot: Option<usize>,
}

/// A physical texture or buffer of the pool.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct SlotView {
    /// Its index.
    pub index: usize,
    /// Its shape in words.
    pub shape: String,
    /// Every use by any tenant.
    pub usage: Vec<&'static str>,
    /// Bytes, without padding.
    pub bytes: u64,
    /// Bytes from the start of the slots laid end to end.
    pub offset: u64,
    /// Names of its tenants, in order of time.
    pub tenants: Vec<String>,
}

pub(super) fn views(plan: &Plan) -> Vec<ResourceView> {
    let offsets = offsets(plan);
    let view = |r: ResourceId| view(plan, r, offsets[r.index()]);
    plan.graph().resource_ids().map(view).collect()
}

fn view(plan: &Plan, resource: ResourceId, offset: Option<u64>) -> ResourceView {
    let graph = plan.graph();
    let declared = &graph.resources()[resource.index()];
    let row = &plan.resources()[resource.index()];
    let texture = declared.desc.texture();
    ResourceView {
        name: graph.resource_name(resource).into(),
        kind: match declared.kind {
            Kind::Transient => "transient",
            Kind::Imported { .. } => "imported",
            Kind::HistoryCurrent { .. } => "history",
            Kind::HistoryPrevious { .. } => "previous",
        },
        shape: shape(plan, &declared.desc, row.format),
        format: plan.format(resource).map(|f| format!("{f:?}")),
        extent: texture.map(|t| t.extent.resolve(plan.frame())),
        mips: texture.map(|t| t.mip_count(plan.frame())),
        layers: texture.map(|t| t.layers),
        samples: texture.map(|t| t.samples),
        usage: names(row.usage),
        first_step: row.first.some().map(StepId::index),
        last_step: row.last.some().map(StepId::index),
        held_steps: held(plan, resource).map(|(first, last)| [first.index(), last.index()]),
        bytes: row.bytes,
        memoryless: row.placement == Placement::Memoryless,
        placement: placement_word(row.placement),
        offset,
        slot: match row.placement {
            Placement::Slot(slot) => Some(slot.index()),
            _ => None,
        },
    }
}

/// The word for a placement.
pub(crate) const fn placement_word(placement: Placement) -> &'static str {
    match placement {
        Placement::Unused => "unused",
        Placement::Memoryless => "memoryless",
        Placement::Inlined => "inlined",
        Placement::Slot(_) => "slot",
        Placement::Heap { .. } => "heap",
        Placement::External => "external",
        Placement::Own => "own",
    }
}

pub(super) fn slots(plan: &Plan) -> Vec<SlotView> {
    let mut tenants = vec![Vec::new(); plan.slots().len()];
    for resource in plan.graph().resource_ids() {
        if let Placement::Slot(slot) = plan.resources()[resource.index()].placement {
            tenants[slot.index()].push(resource);
        }
    }
    let mut offset = 0u64;
    let slots = plan.slots().iter().zip(tenants).enumerate();
    let view = |(index, (slot, mut tenants)): (usize, (&crate::plan::Slot, Vec<ResourceId>))| {
        tenants.sort_by_key(|r| plan.resources()[r.index()].first);
        let start = offset;
        offset = offset.saturating_add(slot.bytes);
        let format = match slot.desc {
            Desc::Texture(t) => Some(t.format),
            Desc::Buffer(_) => None,
        };
        SlotView {
            index,
            shape: shape(plan, &slot.desc, format),
            usage: names(slot.usage),
            bytes: slot.bytes,
            offset: start,
            tenants: tenants.iter().map(|r| plan.graph().resource_name(*r).to_owned()).collect(),
        }
    };
    slots.map(view).collect()
}

fn names(usage: Usage) -> Vec<&'static str> {
    usage.names().collect()
}
