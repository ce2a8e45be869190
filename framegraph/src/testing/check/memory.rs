//! Main memory, as the oracle sees it: a value for each subresource, and which resource has which region.
//!
//! That resources in one region (a slot of the pool, or overlapping bytes of a heap) take turns is shown by their lives
//! (`tenants`), so nothing is followed of it here.

use super::reference::{Cause, Value};
use super::subresource::Subresources;
use crate::id::{PassId, ResourceId};
use crate::plan::{Placement, Plan, StoreOp};
use crate::resource::Kind;

/// One plane of an attachment at the end of its step, and what became of the contents that its store op left in memory:
/// the evidence for the decision log and for waste.
#[derive(Clone, Debug)]
pub(super) struct StoreRecord {
    pub(super) op: StoreOp,
    /// The attachment of the plan whose op it was.
    pub(super) attachment: usize,
    /// The plane of that attachment.
    pub(super) plane: u32,
    /// Passes that used the contents afterwards.
    pub(super) readers: Vec<PassId>,
    /// The contents survived the frame, as they had to.
    pub(super) survived: bool,
    /// The contents could not be dropped.
    pub(super) bound: bool,
    /// How many of its subresources were written over before any pass used them.
    pub(super) overwritten: usize,
    /// How many subresources it covers.
    pub(super) parts: usize,
}

/// The index of the store record that left contents in memory; none for contents that no attachment left.
pub(super) type Source = Option<usize>;

/// Main memory.
pub(super) struct Memory {
    /// By subresource: what memory holds, and where that is from.
    contents: Vec<(Value, Source)>,
    /// By resource: whether it has memory at all.
    exists: Vec<bool>,
    pub(super) records: Vec<StoreRecord>,
}

/// Where in memory a resource lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Region {
    /// Nowhere.
    None,
    /// In memory that no other resource has.
    Alone,
    /// In a slot.
    Slot(usize),
    /// In bytes `start..end` of a heap.
    Bytes {
        /// 0 for textures or for everything, 1 for buffers.
        heap: u8,
        start: u64,
        end: u64,
    },
}

/// The alignment of a resource in a heap, in bytes.
pub(super) fn alignment(plan: &Plan, resource: ResourceId) -> u64 {
    let texture = plan.graph().resources()[resource.index()].desc.texture().is_some();
    let caps = plan.caps();
    (if texture { caps.texture_alignment_bytes } else { caps.buffer_alignment_bytes }).max(1)
}

/// Bytes that a resource, or one image of a history, really takes in a heap: rounded up to the device's alignment.
pub(super) fn reserved_bytes(plan: &Plan, resource: ResourceId) -> u64 {
    let alignment = alignment(plan, resource);
    plan.resources()[resource.index()].bytes.div_ceil(alignment).saturating_mul(alignment)
}

/// How many images a resource has: a history has a ring of them.
pub(super) fn images(plan: &Plan, resource: ResourceId) -> u64 {
    match plan.graph().resources()[resource.index()].kind {
        Kind::HistoryCurrent { frames } => u64::from(frames) + 1,
        _ => 1,
    }
}

/// The region of a resource of a plan, padding left out.
pub(super) fn region_of(plan: &Plan, resource: ResourceId) -> Region {
    let row = &plan.resources()[resource.index()];
    match row.placement {
        Placement::Unused | Placement::Memoryless | Placement::Inlined => Region::None,
        Placement::External | Placement::Own => Region::Alone,
        Placement::Slot(slot) => Region::Slot(slot.index()),
        Placement::Heap { offset } => {
            let buffer = plan.graph().resources()[resource.index()].desc.texture().is_none();
            let heap = u8::from(buffer && plan.caps().separate_heaps);
            Region::Bytes { heap, start: offset, end: offset.saturating_add(row.bytes.max(1)) }
        }
    }
}

impl Memory {
    /// Memory as the frame finds it.
    pub(super) fn on_entry(plan: &Plan, parts: &Subresources) -> Self {
        let graph = plan.graph();
        let mut contents = vec![(Value::Garbage(Cause::NeverWritten), None); parts.total()];
        for (id, resource) in graph.resource_ids().zip(graph.resources()) {
            if resource.kind.defined_on_entry() {
                contents[parts.all(id)].fill((Value::Entry, None));
            }
        }
        let exists = graph.resource_ids().map(|r| region_of(plan, r) != Region::None).collect();
        Self { contents, exists, records: Vec::new() }
    }

    /// Whether a resource has memory at all.
    pub(super) fn exists(&self, resource: ResourceId) -> bool {
        self.exists[resource.index()]
    }

    /// What memory holds of a part.
    pub(super) fn value(&self, resource: ResourceId, part: usize) -> Value {
        if self.exists(resource) { self.contents[part].0 } else { Value::Garbage(Cause::NoMemory) }
    }

    /// Where what memory holds of a part is from.
    pub(super) fn source(&self, part: usize) -> Source {
        self.contents[part].1
    }

    /// Notes that a pass used contents.
    pub(super) fn used(&mut self, source: Source, pass: PassId) {
        if let Some(record) = source.map(|s| &mut self.records[s])
            && !record.readers.contains(&pass)
        {
            record.readers.push(pass);
        }
    }

    /// Notes that contents are dead, because they were written over.
    pub(super) fn overwritten(&mut self, source: Source) {
        if let Some(source) = source {
            self.records[source].overwritten += 1;
        }
    }

    /// Changes what memory holds of a part of a resource that has memory.
    pub(super) fn set(&mut self, part: usize, value: Value, source: Source) {
        self.contents[part] = (value, source);
    }
}
