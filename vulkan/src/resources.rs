//! Memory, images and buffers of a plan.

use crate::driver::{Driver, Object, Thing};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::shape::{Shape, current};
use ash::vk;
use framegraph::{Placement, Plan, ResourceId, SlotId};
use framegraph_queues::{Command, Memory};
use std::collections::BTreeMap;

/// Memory of an executor as the driver reports it, in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryReport {
    /// Sum of the driver's sizes of all transient resources, as if nothing shared memory and nothing was memoryless.
    pub unshared_bytes: u64,
    /// Bytes allocated for transient resources: heaps, slots, and memoryless attachments without lazy memory.
    pub allocated_bytes: u64,
    /// Bytes of memoryless attachments in lazily allocated memory.
    pub lazy_bytes: u64,
    /// Bytes of them that the driver has committed so far. Zero as long as no tile was spilled.
    pub lazy_committed_bytes: u64,
    /// Bytes of resources that outlive the frame: exports and histories.
    pub own_bytes: u64,
}

impl MemoryReport {
    /// Returns the bytes saved by heaps, slots and lazily allocated memory.
    #[must_use]
    pub const fn saved_bytes(&self) -> u64 {
        self.unshared_bytes.saturating_sub(self.allocated_bytes + self.lazy_committed_bytes)
    }
}

/// Images of a history, or none.
#[derive(Debug)]
pub(crate) struct Ring {
    pub(crate) name: String,
    pub(crate) shape: Shape,
    pub(crate) things: Vec<Thing>,
    objects: Vec<Object>,
    bytes: u64,
    /// Index of the image that this frame writes.
    pub(crate) head: usize,
    /// The images are not cleared yet.
    pub(crate) fresh: bool,
}

/// Objects of a plan. Owned by an executor, which destroys them.
#[derive(Debug, Default)]
pub(crate) struct Resources {
    objects: Vec<Object>,
    things: Vec<Option<Thing>>,
    heaps: [Option<(vk::DeviceMemory, u32)>; 2],
    slots: BTreeMap<SlotId, Thing>,
    lazy: Vec<vk::DeviceMemory>,
    /// Driver's size and offset of resources in heaps, for the check of overlaps.
    spans: Vec<Span>,
    pub(crate) rings: Vec<Ring>,
    /// Ring of each resource that is an image of a history, and its age in frames.
    ring_of: BTreeMap<ResourceId, (usize, usize)>,
    report: MemoryReport,
}

#[derive(Clone, Copy, Debug)]
struct Span {
    of_buffers: bool,
    offset: u64,
    /// Bytes that the driver needs.
    needed: u64,
    /// Bytes that the plan has.
    planned: u64,
    resource: ResourceId,
}

const LAZY: vk::MemoryPropertyFlags = vk::MemoryPropertyFlags::LAZILY_ALLOCATED;
const LOCAL: vk::MemoryPropertyFlags = vk::MemoryPropertyFlags::DEVICE_LOCAL;
const PROTECTED: vk::MemoryPropertyFlags = vk::MemoryPropertyFlags::PROTECTED;

impl Resources {
    /// Executes the creating commands of a stream. Takes over histories of an earlier plan that have the same name and
    /// shape.
    pub(crate) fn new(
        gpu: &Gpu,
        plan: &Plan,
        commands: &[Command],
        families: &[u32],
        earlier: Vec<Ring>,
    ) -> (Self, Result<(), Error>) {
        let mut made = Self { things: vec![None; plan.resources().len()], ..Self::default() };
        let mut earlier = earlier;
        let mut create = || {
            let shared: Vec<ResourceId> = commands.iter().filter_map(concurrent).collect();
            for command in commands {
                match *command {
                    Command::Heap { of_buffers, bytes } => {
                        made.heap(gpu, plan, commands, of_buffers, bytes, families)?;
                    }
                    Command::Create { resource, memory, .. } => {
                        let at_once = shared.iter().any(|other| current(plan, *other) == current(plan, resource));
                        let families = if at_once { families } else { &[] };
                        made.create(gpu, plan, resource, memory, families, &mut earlier)?;
                    }
                    _ => {}
                }
            }
            made.check_overlaps(plan)
        };
        let result = create();
        for ring in earlier {
            destroy(&gpu.shared.driver, ring.objects);
        }
        (made, result)
    }

    /// Returns the rings, so that another plan can take them over.
    pub(crate) fn take_rings(&mut self) -> Vec<Ring> {
        std::mem::take(&mut self.rings)
    }

    /// Destroys everything.
    pub(crate) fn destroy(&mut self, driver: &Driver) {
        for ring in self.rings.drain(..) {
            destroy(driver, ring.objects);
        }
        destroy(driver, std::mem::take(&mut self.objects));
    }

    /// Returns the object of a resource in this frame; `None` for imports and unused resources.
    pub(crate) fn of(&self, id: ResourceId) -> Option<Thing> {
        if let Some((ring, age)) = self.ring_of.get(&id) {
            let ring = &self.rings[*ring];
            return Some(ring.things[(ring.head + ring.things.len() - age) % ring.things.len()]);
        }
        self.things.get(id.index()).copied().flatten()
    }

    /// Returns the object of an export, or the image of a history that the last frame wrote.
    pub(crate) fn written(&self, plan: &Plan, id: ResourceId) -> Option<Thing> {
        if let Some((ring, age)) = self.ring_of.get(&id) {
            // The ring has advanced since.
            let ring = &self.rings[*ring];
            return Some(ring.things[(ring.head + 2 * ring.things.len() - 1 - age) % ring.things.len()]);
        }
        let own = plan.resources().get(id.index())?.placement == Placement::Own;
        self.things.get(id.index()).copied().flatten().filter(|_| own)
    }

    /// Advances histories by one frame.
    pub(crate) fn advance(&mut self) {
        for ring in &mut self.rings {
            ring.head = (ring.head + 1) % ring.things.len();
        }
    }

    /// Returns the memory, with the driver's current commitment of lazy memory.
    pub(crate) fn report(&self, driver: &Driver) -> MemoryReport {
        let lazy_committed_bytes = self.lazy.iter().map(|memory| driver.committed_bytes(*memory)).sum();
        MemoryReport { lazy_committed_bytes, ..self.report }
    }

    fn heap(
        &mut self,
        gpu: &Gpu,
        plan: &Plan,
        commands: &[Command],
        of_buffers: bool,
        bytes: u64,
        families: &[u32],
    ) -> Result<(), Error> {
        let driver = &gpu.shared.driver;
        let (mut types, mut end, mut first) = (u32::MAX, bytes, None);
        for command in commands {
            let Command::Create { resource, memory: Memory::Heap { offset }, .. } = *command else { continue };
            let is_buffer = plan.graph().resources()[resource.index()].desc.texture().is_none();
            if (is_buffer && plan.caps().separate_heaps) == of_buffers {
                let needs = requirements(gpu, plan, resource, families)?;
                types &= needs.memory_type_bits;
                end = end.max(offset + needs.size);
                first = first.or(Some(resource));
            }
        }
        let kind = driver.memory_type(types, LOCAL, LAZY | PROTECTED);
        let name = first.map(|resource| plan.graph().resource_name(resource).to_owned());
        let kind = kind.ok_or(Error::MemoryType { resource: name.unwrap_or_default() })?;
        let memory = driver.allocate(end, kind)?;
        self.objects.push(Object::Memory(memory));
        self.heaps[usize::from(of_buffers)] = Some((memory, 1 << kind));
        self.report.allocated_bytes += end;
        Ok(())
    }

    fn create(
        &mut self,
        gpu: &Gpu,
        plan: &Plan,
        id: ResourceId,
        memory: Memory,
        families: &[u32],
        earlier: &mut Vec<Ring>,
    ) -> Result<(), Error> {
        let name = plan.graph().resource_name(id);
        let is_buffer = plan.graph().resources()[id.index()].desc.texture().is_none();
        let shape = Shape::of(plan, id, families);
        let thing = match memory {
            Memory::External => return Ok(()),
            Memory::Heap { offset } => {
                let of_buffers = is_buffer && plan.caps().separate_heaps;
                let thing = self.object(gpu, &shape, name)?;
                let needs = gpu.shared.driver.requirements(thing);
                let planned = plan.resources()[id.index()].bytes;
                self.report.unshared_bytes += needs.size;
                self.spans.push(Span { of_buffers, offset, needed: needs.size, planned, resource: id });
                let heap = self.heaps[usize::from(of_buffers)].ok_or(Error::NotPrepared)?;
                if heap.1 & needs.memory_type_bits == 0 {
                    return Err(Error::MemoryType { resource: name.to_owned() });
                }
                if !offset.is_multiple_of(needs.alignment) {
                    return Err(Error::Alignment { resource: name.to_owned(), needed: needs.alignment, offset });
                }
                gpu.shared.driver.bind(thing, heap.0, offset)?;
                thing
            }
            Memory::Slot(slot) => {
                let thing = match self.slots.get(&slot) {
                    Some(thing) => *thing,
                    None => {
                        let shape = Shape::of_slot(plan, slot, families);
                        let thing = self.object(gpu, &shape, name)?;
                        self.report.allocated_bytes += self.dedicated(gpu, thing, name, false)?;
                        self.slots.insert(slot, thing);
                        thing
                    }
                };
                self.report.unshared_bytes += gpu.shared.driver.requirements(thing).size;
                thing
            }
            Memory::Tile => {
                let thing = self.object(gpu, &shape, name)?;
                let bytes = self.dedicated(gpu, thing, name, true)?;
                self.report.unshared_bytes += bytes;
                thing
            }
            Memory::Own if shape.history => return self.ring(gpu, plan, id, shape, earlier),
            Memory::Own => {
                let thing = self.object(gpu, &shape, name)?;
                self.report.own_bytes += self.dedicated(gpu, thing, name, false)?;
                thing
            }
        };
        self.things[id.index()] = Some(thing);
        Ok(())
    }

    /// Finds or creates the images of a history.
    fn ring(
        &mut self,
        gpu: &Gpu,
        plan: &Plan,
        id: ResourceId,
        shape: Shape,
        earlier: &mut Vec<Ring>,
    ) -> Result<(), Error> {
        let graph = plan.graph();
        let written = current(plan, id);
        let framegraph::Kind::HistoryCurrent { frames } = graph.resources()[written.index()].kind else {
            return Err(Error::NotPrepared);
        };
        let age = match graph.resources()[id.index()].kind {
            framegraph::Kind::HistoryPrevious { age, .. } => usize::from(age),
            _ => 0,
        };
        let name = graph.resource_name(written);
        if let Some(known) = self.rings.iter().position(|ring| ring.name == name) {
            self.ring_of.insert(id, (known, age));
            return Ok(());
        }
        let count = usize::from(frames) + 1;
        let same = |ring: &Ring| ring.name == name && ring.shape == shape && ring.things.len() == count;
        let ring = match earlier.iter().position(same) {
            Some(at) => earlier.swap_remove(at),
            None => {
                let before = (self.objects.len(), self.report.own_bytes);
                let mut things = Vec::new();
                for _ in 0..count {
                    let thing = self.object(gpu, &shape, name)?;
                    self.report.own_bytes += self.dedicated(gpu, thing, name, false)?;
                    things.push(thing);
                }
                let bytes = self.report.own_bytes - before.1;
                self.report.own_bytes = before.1;
                let objects = self.objects.split_off(before.0);
                Ring { name: name.to_owned(), shape, things, objects, bytes, head: 0, fresh: true }
            }
        };
        self.report.own_bytes += ring.bytes;
        self.ring_of.insert(id, (self.rings.len(), age));
        self.rings.push(ring);
        Ok(())
    }

    fn object(&mut self, gpu: &Gpu, shape: &Shape, name: &str) -> Result<Thing, Error> {
        let (thing, object) = object(gpu, shape, name)?;
        self.objects.push(object);
        gpu.shared.driver.name(thing, name);
        Ok(thing)
    }

    /// Allocates memory for one object, lazily if wanted and possible. Returns the size in bytes.
    fn dedicated(&mut self, gpu: &Gpu, thing: Thing, name: &str, lazy: bool) -> Result<u64, Error> {
        let driver = &gpu.shared.driver;
        let needs = driver.requirements(thing);
        let lazy_kind = driver.memory_type(needs.memory_type_bits, LAZY, PROTECTED).filter(|_| lazy);
        let kind = lazy_kind.or_else(|| driver.memory_type(needs.memory_type_bits, LOCAL, LAZY | PROTECTED));
        let kind = kind.ok_or_else(|| Error::MemoryType { resource: name.to_owned() })?;
        let memory = driver.allocate(needs.size, kind)?;
        self.objects.push(Object::Memory(memory));
        driver.bind(thing, memory, 0)?;
        if lazy_kind.is_some() {
            self.lazy.push(memory);
            self.report.lazy_bytes += needs.size;
        } else if lazy {
            self.report.allocated_bytes += needs.size;
        }
        Ok(needs.size)
    }

    /// Fails if the driver's sizes make two resources overlap that do not overlap in the plan.
    fn check_overlaps(&self, plan: &Plan) -> Result<(), Error> {
        for (at, a) in self.spans.iter().enumerate() {
            for b in &self.spans[at + 1..] {
                let (low, high) = if a.offset <= b.offset { (a, b) } else { (b, a) };
                let reserved = high.offset - low.offset;
                if a.of_buffers == b.of_buffers && low.planned <= reserved && low.needed > reserved {
                    let resource = plan.graph().resource_name(low.resource).to_owned();
                    return Err(Error::Size { resource, needed: low.needed, reserved });
                }
            }
        }
        Ok(())
    }
}

fn concurrent(command: &Command) -> Option<ResourceId> {
    match *command {
        Command::Create { resource, concurrent: true, .. } => Some(resource),
        _ => None,
    }
}

fn destroy(driver: &Driver, objects: Vec<Object>) {
    // Objects before the memory that they are bound to.
    objects.into_iter().rev().for_each(|object| driver.destroy(object));
}

/// Creates an object without memory.
fn object(gpu: &Gpu, shape: &Shape, name: &str) -> Result<(Thing, Object), Error> {
    if let Some(info) = shape.image_info() {
        if !gpu.supports(&info) {
            let format = shape.desc.texture().map_or_else(String::new, |desc| format!("{:?}", desc.format));
            return Err(Error::Format { resource: name.to_owned(), format });
        }
        let image = gpu.shared.driver.image(&info)?;
        return Ok((Thing::Image(image), Object::Image(image)));
    }
    let info = shape.buffer_info().ok_or(Error::NotPrepared)?;
    let buffer = gpu.shared.driver.buffer(&info)?;
    Ok((Thing::Buffer(buffer), Object::Buffer(buffer)))
}

/// Returns the driver's memory requirements of a resource.
pub(crate) fn requirements(
    gpu: &Gpu,
    plan: &Plan,
    id: ResourceId,
    families: &[u32],
) -> Result<vk::MemoryRequirements, Error> {
    let shape = match plan.resources()[id.index()].placement {
        Placement::Slot(slot) => Shape::of_slot(plan, slot, families),
        _ => Shape::of(plan, id, families),
    };
    let (thing, object) = object(gpu, &shape, plan.graph().resource_name(id))?;
    let needs = gpu.shared.driver.requirements(thing);
    gpu.shared.driver.destroy(object);
    Ok(needs)
}
