//! Main memory, as the oracle sees it: a value for each subresource, and who has which place.
//!
//! Resources in one place (a slot of the pool, or overlapping bytes of a heap) take turns. The first write of a resource
//! that does not have its place takes it over: everything that overlaps loses its contents, and so do the other parts of
//! the new tenant. A read of a resource that does not have its place sees garbage.

use super::reference::{Cause, Value};
use super::subresource::Subresources;
use crate::id::{PassId, ResourceId};
use crate::plan::{Placement, Plan};
use crate::resource::Kind;
use std::collections::BTreeMap;

/// What left contents in memory, and what became of them: the evidence for the decision log and for waste.
#[derive(Clone, Debug)]
pub(super) struct Deed {
    pub(super) kind: DeedKind,
    /// The attachment of the plan whose op it was.
    pub(super) attachment: usize,
    /// The plane of that attachment.
    pub(super) plane: u32,
    /// Passes that used the contents afterwards.
    pub(super) readers: Vec<PassId>,
    /// They survived the frame, as they had to.
    pub(super) survived: bool,
    /// They could not be dropped.
    pub(super) bound: bool,
    /// How many of its subresources were written over before anybody used them.
    pub(super) overwritten: usize,
    /// How many subresources it covers.
    pub(super) parts: usize,
}

/// What the op at the end of a step did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DeedKind {
    /// Tile contents were written to memory.
    Stored,
    /// Memory was left as it was.
    Left,
    /// Contents were dropped.
    Discarded,
}

/// The number of a deed; none for contents that no attachment op left.
pub(super) type DeedId = Option<usize>;

/// Main memory.
pub(super) struct Memory {
    values: Vec<Value>,
    sources: Vec<DeedId>,
    places: Vec<Place>,
    holds: Vec<bool>,
    slots: Vec<Option<ResourceId>>,
    /// Ranges of the heaps that somebody has: by heap and first byte, the end and the tenant. They do not overlap.
    ranges: BTreeMap<(u8, u64), (u64, ResourceId)>,
    pub(super) deeds: Vec<Deed>,
}

/// Where a resource lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Nowhere.
    None,
    /// In memory that nobody else has.
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

/// Bytes that a resource, or one image of a history, really takes in a heap: rounded up to the device's alignment.
pub(super) fn reserved_bytes(plan: &Plan, resource: ResourceId) -> u64 {
    let texture = plan.graph().resources()[resource.index()].desc.texture();
    let alignment =
        if texture.is_some() { plan.caps().texture_alignment_bytes } else { plan.caps().buffer_alignment_bytes };
    let bytes = plan.resources()[resource.index()].bytes;
    bytes.div_ceil(alignment.max(1)).saturating_mul(alignment.max(1))
}

/// How many images a resource has: a history has a ring of them.
pub(super) fn images(plan: &Plan, resource: ResourceId) -> u64 {
    match plan.graph().resources()[resource.index()].kind {
        Kind::HistoryCurrent { frames } => u64::from(frames) + 1,
        _ => 1,
    }
}

/// The place of a resource of a plan, padding left out.
pub(super) fn place_of(plan: &Plan, resource: ResourceId) -> Place {
    let row = &plan.resources()[resource.index()];
    match row.placement {
        Placement::Unused | Placement::Memoryless | Placement::Inlined => Place::None,
        Placement::External | Placement::Own => Place::Alone,
        Placement::Slot(slot) => Place::Slot(slot.index()),
        Placement::Heap { offset } => {
            let buffer = plan.graph().resources()[resource.index()].desc.texture().is_none();
            Place::Bytes {
                heap: u8::from(buffer && plan.caps().separate_heaps),
                start: offset,
                end: offset.saturating_add(row.bytes.max(1)),
            }
        }
    }
}

impl Memory {
    /// Memory as the frame finds it.
    pub(super) fn on_entry(plan: &Plan, parts: &Subresources) -> Self {
        let graph = plan.graph();
        let mut memory = Self {
            values: vec![Value::Garbage(Cause::NeverWritten); parts.total()],
            sources: vec![None; parts.total()],
            places: Vec::with_capacity(graph.resources().len()),
            holds: vec![false; graph.resources().len()],
            slots: vec![None; plan.slots().len()],
            ranges: BTreeMap::new(),
            deeds: Vec::new(),
        };
        for (id, resource) in graph.resource_ids().zip(graph.resources()) {
            // The images of a history keep their places from frame to frame; that nobody else is there is shown elsewhere.
            let place = match (place_of(plan, id), resource.kind) {
                (Place::Bytes { .. }, Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. }) => Place::Alone,
                (place, _) => place,
            };
            memory.places.push(place);
            memory.holds[id.index()] = place == Place::Alone;
            if resource.kind.defined_on_entry() {
                memory.values[parts.all(id)].fill(Value::Entry);
            }
        }
        memory
    }

    /// Whether a resource has memory at all.
    pub(super) fn exists(&self, resource: ResourceId) -> bool {
        self.places[resource.index()] != Place::None
    }

    /// What memory holds of a part.
    pub(super) fn value(&self, resource: ResourceId, part: usize) -> Value {
        if self.holds[resource.index()] {
            return self.values[part];
        }
        Value::Garbage(match (self.places[resource.index()], self.values[part]) {
            (Place::None, _) => Cause::NoMemory,
            (_, Value::Garbage(cause)) => cause,
            _ => Cause::HandedOver,
        })
    }

    /// Which deed left what memory holds of a part.
    pub(super) fn source(&self, resource: ResourceId, part: usize) -> DeedId {
        self.sources[part].filter(|_| self.holds[resource.index()])
    }

    /// Notes that a pass used what a deed left.
    pub(super) fn used(&mut self, deed: DeedId, pass: PassId) {
        if let Some(deed) = deed.map(|d| &mut self.deeds[d])
            && !deed.readers.contains(&pass)
        {
            deed.readers.push(pass);
        }
    }

    /// Notes that contents that a deed left are dead, because somebody wrote over them.
    pub(super) fn overwritten(&mut self, deed: DeedId) {
        if let Some(deed) = deed {
            self.deeds[deed].overwritten += 1;
        }
    }

    /// Changes what memory holds of a part; the resource must have its place.
    pub(super) fn set(&mut self, part: usize, value: Value, source: DeedId) {
        self.values[part] = value;
        self.sources[part] = source;
    }

    /// Gives a resource its place, if it has not got it: whatever overlaps loses it.
    pub(super) fn take(&mut self, resource: ResourceId, parts: &Subresources) {
        if std::mem::replace(&mut self.holds[resource.index()], true) {
            return;
        }
        match self.places[resource.index()] {
            Place::None => self.holds[resource.index()] = false,
            Place::Alone => {}
            Place::Slot(slot) => {
                if let Some(before) = self.slots[slot].replace(resource) {
                    self.holds[before.index()] = false;
                }
            }
            Place::Bytes { heap, start, end } => {
                while let Some((key, (_, before))) = self.overlapping(heap, start, end) {
                    self.ranges.remove(&key);
                    self.holds[before.index()] = false;
                }
                self.ranges.insert((heap, start), (end, resource));
            }
        }
        for part in parts.all(resource) {
            self.set(part, Value::Garbage(Cause::HandedOver), None);
        }
    }

    fn overlapping(&self, heap: u8, start: u64, end: u64) -> Option<((u8, u64), (u64, ResourceId))> {
        let before = self.ranges.range((heap, 0)..(heap, end.max(start + 1))).next_back();
        before.filter(|(_, (last, _))| *last > start).map(|(key, row)| (*key, *row))
    }
}
