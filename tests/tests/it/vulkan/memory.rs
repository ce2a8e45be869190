//! The first commands of a stream: heaps, images and buffers.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use crate::vulkan::device::{Device, Object, Trouble};
use crate::vulkan::states::{buffer_usage, format, image_usage};
use ash::vk;
use framegraph::{
    Desc, Dimension, Entry, Format, Kind, Placement, Plan, ResourceId, SlotId, State, TextureDesc, Usage,
};
use framegraph_queues::Memory;
use std::collections::BTreeMap;

/// Vulkan object of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Thing {
    Image(vk::Image),
    Buffer(vk::Buffer),
}

/// Objects created by the stream.
#[derive(Debug, Default)]
pub struct Objects {
    /// Memory of the heaps of textures and of buffers.
    heaps: [Option<vk::DeviceMemory>; 2],
    slots: BTreeMap<SlotId, Thing>,
    /// Images of each history, by the resource that the frame writes.
    rings: BTreeMap<ResourceId, Vec<Thing>>,
    things: BTreeMap<ResourceId, Thing>,
    /// Number of frames so far, by which histories rotate.
    pub frame: usize,
}

/// Heaps end at a page, so that the last resource has the size its driver rounds up to.
const PAGE: u64 = 65536;

impl Objects {
    pub fn heap(&mut self, device: &Device, plan: &Plan, of_buffers: bool, bytes: u64) -> Result<(), Trouble> {
        let mut types = u32::MAX;
        for (id, row) in plan.graph().resource_ids().zip(plan.resources()) {
            let of = plan.graph().resources()[id.index()].desc;
            let is_placed = matches!(row.placement, Placement::Heap { .. } | Placement::Slot(_));
            if is_placed && of.texture().is_none() == of_buffers {
                types &= asked(device, plan, id)?.memory_type_bits;
            }
        }
        self.heaps[usize::from(of_buffers)] = Some(device.allocate(bytes.next_multiple_of(PAGE), types)?);
        Ok(())
    }

    pub fn create(&mut self, device: &Device, plan: &Plan, id: ResourceId, memory: Memory) -> Result<(), Trouble> {
        let resource = &plan.graph().resources()[id.index()];
        let thing = match (memory, resource.kind) {
            (Memory::Heap { offset }, _) => {
                let heap = self.heaps[usize::from(resource.desc.texture().is_none())].ok_or("a heap was not made")?;
                let thing = make(device, plan, id)?;
                bind(device, thing, heap, offset)?;
                thing
            }
            (Memory::Slot(slot), _) => match self.slots.get(&slot) {
                Some(thing) => *thing,
                None => {
                    let row = &plan.slots()[slot.index()];
                    let thing = described(device, plan, row.desc, row.usage, row.srgb_views)?;
                    apart(device, thing)?;
                    self.slots.insert(slot, thing);
                    thing
                }
            },
            (_, Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. }) => return self.ring(device, plan, id),
            _ => {
                let thing = make(device, plan, id)?;
                apart(device, thing)?;
                thing
            }
        };
        self.things.insert(id, thing);
        Ok(())
    }

    /// Creates the images of the history that `id` belongs to.
    fn ring(&mut self, device: &Device, plan: &Plan, id: ResourceId) -> Result<(), Trouble> {
        let graph = plan.graph();
        let current = current(plan, id);
        if self.rings.contains_key(&current) {
            return Ok(());
        }
        let Kind::HistoryCurrent { frames } = graph.resources()[current.index()].kind else {
            return Err("a history without an image that is written".into());
        };
        let own = graph.resource_ids().filter(|other| self::current(plan, *other) == current);
        let rows = own.map(|other| plan.resources()[other.index()].usage);
        let usage = rows.fold(Usage::default(), Usage::union);
        let desc = graph.resources()[current.index()].desc;
        let mut ring = Vec::new();
        for _ in 0..=frames {
            let thing = described(device, plan, desc, usage, plan.resources()[id.index()].srgb_views)?;
            apart(device, thing)?;
            ring.push(thing);
        }
        self.rings.insert(current, ring);
        Ok(())
    }

    /// Returns the object of `id` in this frame.
    pub fn of(&self, plan: &Plan, id: ResourceId) -> Result<Thing, Trouble> {
        let age = match plan.graph().resources()[id.index()].kind {
            Kind::HistoryPrevious { age, .. } => usize::from(age),
            _ => 0,
        };
        let found = match self.rings.get(&current(plan, id)) {
            Some(ring) => ring.get((self.frame + ring.len() - age) % ring.len()),
            None => self.things.get(&id),
        };
        Ok(*found.ok_or_else(|| format!("{} was not made", plan.graph().resource_name(id)))?)
    }
}

/// Returns the resource that a history writes, or the resource itself.
fn current(plan: &Plan, id: ResourceId) -> ResourceId {
    match plan.graph().resources()[id.index()].kind {
        Kind::HistoryPrevious { current, .. } => current,
        _ => id,
    }
}

/// Returns the description with resolved format and size.
pub fn shaped(plan: &Plan, id: ResourceId) -> Desc {
    match (plan.graph().resources()[id.index()].desc, plan.format(id)) {
        (Desc::Texture(desc), Some(format)) => Desc::Texture(desc.format(format)),
        (desc, _) => desc,
    }
}

fn make(device: &Device, plan: &Plan, id: ResourceId) -> Result<Thing, Trouble> {
    let row = &plan.resources()[id.index()];
    // The owner of an imported resource declared its own usage too.
    let left = match plan.graph().resources()[id.index()].kind {
        Kind::Imported { entry: Entry::Left { state, .. }, .. } => state,
        _ => State::Undefined,
    };
    let owners = match left {
        State::ColorAttachment | State::DepthAttachment | State::DepthReadOnly => Usage::ATTACHMENT,
        State::Sampled => Usage::SAMPLED,
        State::Storage => Usage::STORAGE,
        State::InputAttachment => Usage::INPUT_ATTACHMENT,
        State::CopySource => Usage::COPY_SOURCE,
        State::CopyTarget => Usage::COPY_TARGET,
        _ => Usage::default(),
    };
    described(device, plan, shaped(plan, id), row.usage.union(owners), row.srgb_views)
}

fn described(device: &Device, plan: &Plan, desc: Desc, usage: Usage, views: bool) -> Result<Thing, Trouble> {
    let desc = match desc {
        Desc::Texture(desc) => return Ok(Thing::Image(image(device, plan, &desc, usage, views)?)),
        Desc::Buffer(desc) => desc,
    };
    // Unused resources are created too.
    let more = if buffer_usage(usage).is_empty() { vk::BufferUsageFlags::TRANSFER_DST } else { buffer_usage(usage) };
    let info = vk::BufferCreateInfo::default().size(desc.bytes(plan.frame()).max(4)).usage(more);
    // SAFETY: the size is not 0 and the uses are not none.
    let buffer = unsafe { device.raw.create_buffer(&info, None)? };
    device.keep(Object::Buffer(buffer));
    Ok(Thing::Buffer(buffer))
}

fn image(
    device: &Device,
    plan: &Plan,
    desc: &TextureDesc,
    usage: Usage,
    srgb_views: bool,
) -> Result<vk::Image, Trouble> {
    let raw = known(desc.format)?;
    let [width, height] = desc.extent.texels(plan.frame());
    let (kind, depth, layers) = match desc.dimension {
        Dimension::D2 => (vk::ImageType::TYPE_2D, 1, desc.layers.into()),
        Dimension::D3 => (vk::ImageType::TYPE_3D, u32::from(desc.layers), 1),
    };
    let usage = image_usage(usage, desc.format);
    let mut flags = vk::ImageCreateFlags::empty();
    if desc.dimension == Dimension::D3 && usage.contains(vk::ImageUsageFlags::COLOR_ATTACHMENT) {
        flags |= vk::ImageCreateFlags::TYPE_2D_ARRAY_COMPATIBLE;
    }
    if srgb_views {
        flags |= vk::ImageCreateFlags::MUTABLE_FORMAT;
    }
    let needs = [
        (vk::ImageUsageFlags::STORAGE, vk::FormatFeatureFlags::STORAGE_IMAGE),
        (vk::ImageUsageFlags::COLOR_ATTACHMENT, vk::FormatFeatureFlags::COLOR_ATTACHMENT),
    ];
    let offered = (device.formats)(raw);
    if needs.iter().any(|(usage_bit, feature)| usage.contains(*usage_bit) && !offered.contains(*feature)) {
        return Err(format!("the device does not use {:?} so", desc.format).into());
    }
    let info = vk::ImageCreateInfo::default()
        .flags(flags)
        .image_type(kind)
        .format(raw)
        .extent(vk::Extent3D { width, height, depth })
        .mip_levels(desc.mip_count(plan.frame()))
        .array_layers(layers)
        .samples(vk::SampleCountFlags::from_raw(desc.samples.into()))
        .usage(if usage.is_empty() { vk::ImageUsageFlags::SAMPLED } else { usage });
    // SAFETY: the description is sound, or the layers say so.
    let image = unsafe { device.raw.create_image(&info, None)? };
    device.keep(Object::Image(image));
    Ok(image)
}

/// Returns the format in Vulkan.
pub fn known(of: Format) -> Result<vk::Format, Trouble> {
    Ok(format(of).ok_or_else(|| format!("{of:?} is not replayed"))?)
}

/// Returns the driver's memory requirements of a resource.
pub fn asked(device: &Device, plan: &Plan, id: ResourceId) -> Result<vk::MemoryRequirements, Trouble> {
    Ok(needs(device, make(device, plan, id)?))
}

fn needs(device: &Device, thing: Thing) -> vk::MemoryRequirements {
    // SAFETY: the object is of this device.
    unsafe {
        match thing {
            Thing::Image(image) => device.raw.get_image_memory_requirements(image),
            Thing::Buffer(buffer) => device.raw.get_buffer_memory_requirements(buffer),
        }
    }
}

fn bind(device: &Device, thing: Thing, memory: vk::DeviceMemory, offset: u64) -> Result<(), Trouble> {
    // SAFETY: the object is new and the memory is of this device; whether it suits is for the layers to say.
    unsafe {
        match thing {
            Thing::Image(image) => device.raw.bind_image_memory(image, memory, offset)?,
            Thing::Buffer(buffer) => device.raw.bind_buffer_memory(buffer, memory, offset)?,
        }
    }
    Ok(())
}

/// Allocates separate memory for an object.
fn apart(device: &Device, thing: Thing) -> Result<(), Trouble> {
    let needs = needs(device, thing);
    bind(device, thing, device.allocate(needs.size, needs.memory_type_bits)?, 0)
}
