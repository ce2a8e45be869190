//! Main memory in the model of the oracle: a value for each part, and the memory region of each resource.
//!
//! Resources that share a region (a slot, or overlapping bytes of a heap) have disjoint lifetimes, which `tenants`
//! checks. Aliasing is therefore not modeled here.

use super::reference::{Cause, Value};
use super::subresource::Subresources;
use framegraph::id::{PassId, ResourceId};
use framegraph::plan::{Placement, Plan, StoreOp};
use framegraph::resource::Kind;

/// One plane of an attachment at the end of its step, and the later uses of the contents in memory. Evidence for the
/// decision log and for waste.
#[derive(Clone, Debug)]
pub(super) struct StoreRecord {
    pub(super) op: StoreOp,
    /// Index of the attachment in the plan.
    pub(super) attachment: usize,
    /// Plane of the attachment.
    pub(super) plane: u32,
    /// Passes that used the contents afterwards.
    pub(super) readers: Vec<PassId>,
    /// The contents survived the frame, as required.
    pub(super) survived: bool,
    /// The contents could not be discarded.
    pub(super) bound: bool,
    /// Number of parts that were overwritten before any use.
    pub(super) overwritten: usize,
    /// Number of parts it covers.
    pub(super) parts: usize,
    /// For a slice: the source of the contents it replaced. Overwriting the level overwrites these as well.
    pub(super) replaced: Source,
}

/// Index of the store record that left contents in memory; `None` for contents not left by an attachment.
pub(super) type Source = Option<usize>;

/// Main memory.
pub(super) struct Memory {
    /// By part: its value and the source of the value.
    contents: Vec<(Value, Source)>,
    /// By resource: it has memory.
    exists: Vec<bool>,
    pub(super) records: Vec<StoreRecord>,
}

/// The memory region of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Region {
    /// No memory.
    None,
    /// Memory that is not shared.
    Alone,
    /// A slot.
    Slot(usize),
    /// Bytes `start..end` of a heap.
    Bytes {
        /// 0 for textures, or for everything if there is one heap; 1 for buffers.
        heap: u8,
        start: u64,
        end: u64,
    },
}

/// Returns the alignment of a resource in a heap, in bytes.
pub(super) fn alignment(plan: &Plan, resource: ResourceId) -> u64 {
    let texture = plan.graph().resources()[resource.index()].desc.texture().is_some();
    let caps = plan.caps();
    (if texture { caps.texture_alignment_bytes } else { caps.buffer_alignment_bytes }).max(1)
}

/// Returns the bytes that a resource, or one image of a history, occupies in a heap, rounded up to the alignment.
pub(super) fn reserved_bytes(plan: &Plan, resource: ResourceId) -> u64 {
    let alignment = alignment(plan, resource);
    plan.resources()[resource.index()].bytes.div_ceil(alignment).saturating_mul(alignment)
}

/// Returns the number of images of a resource: several for a history, otherwise 1.
pub(super) fn images(plan: &Plan, resource: ResourceId) -> u64 {
    match plan.graph().resources()[resource.index()].kind {
        Kind::HistoryCurrent { frames } => u64::from(frames) + 1,
        _ => 1,
    }
}

/// Returns the region of a resource, without padding.
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
    /// Returns the memory at the start of the frame.
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

    /// Returns `true` if a resource has memory.
    pub(super) fn exists(&self, resource: ResourceId) -> bool {
        self.exists[resource.index()]
    }

    /// Returns the value of a part in memory.
    pub(super) fn value(&self, resource: ResourceId, part: usize) -> Value {
        if self.exists(resource) { self.contents[part].0 } else { Value::Garbage(Cause::NoMemory) }
    }

    /// Returns the source of the value of a part in memory.
    pub(super) fn source(&self, part: usize) -> Source {
        self.contents[part].1
    }

    /// Records that a pass used contents.
    pub(super) fn used(&mut self, source: Source, pass: PassId) {
        if let Some(record) = source.map(|s| &mut self.records[s])
            && !record.readers.contains(&pass)
        {
            record.readers.push(pass);
        }
    }

    /// Records that contents were overwritten.
    pub(super) fn overwritten(&mut self, source: Source) {
        let mut next = source;
        while let Some(source) = next {
            self.records[source].overwritten += 1;
            next = self.records[source].replaced;
        }
    }

    /// Sets the value of a part of a resource with memory.
    pub(super) fn set(&mut self, part: usize, value: Value, source: Source) {
        self.contents[part] = (value, source);
    }
}
