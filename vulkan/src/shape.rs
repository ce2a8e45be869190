//! Vulkan descriptions of a plan's images and buffers.

use crate::convert::{buffer_usage, image_usage, vk_format};
use ash::vk;
use framegraph::{Access, Desc, Dimension, Kind, Mode, Placement, Plan, ResourceId, TextureDesc, Usage};

/// Everything that decides how an object is created.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Shape {
    pub(crate) desc: Desc,
    /// Frame that relative extents refer to.
    pub(crate) frame: [u32; 2],
    pub(crate) usage: Usage,
    pub(crate) srgb_views: bool,
    pub(crate) memoryless: bool,
    /// The object is an image of a history.
    pub(crate) history: bool,
    /// The executor clears the object.
    pub(crate) cleared: bool,
    /// Queue families that use the object concurrently; empty if one family owns it.
    pub(crate) families: Vec<u32>,
}

impl Shape {
    /// Returns the shape of a resource, or of the images of its history.
    pub(crate) fn of(plan: &Plan, id: ResourceId, families: &[u32]) -> Self {
        let current = current(plan, id);
        let graph = plan.graph();
        let own = graph.resource_ids().filter(|other| self::current(plan, *other) == current);
        let rows = own.map(|other| plan.resources()[other.index()]);
        let (usage, srgb_views) =
            rows.fold((Usage::NONE, false), |(usage, srgb), row| (usage.union(row.usage), srgb || row.srgb_views));
        let desc = match (graph.resources()[current.index()].desc, plan.format(current)) {
            (Desc::Texture(desc), Some(format)) => Desc::Texture(desc.format(format)),
            (desc, _) => desc,
        };
        let history = matches!(graph.resources()[current.index()].kind, Kind::HistoryCurrent { .. });
        // The engine samples or copies what outlives the frame.
        let outlives = plan.resources()[current.index()].placement == Placement::Own;
        let more = if outlives { Usage::SAMPLED.union(Usage::COPY_SOURCE) } else { Usage::NONE };
        Self {
            desc,
            frame: plan.frame(),
            usage: usage.union(more),
            srgb_views,
            memoryless: plan.resources()[current.index()].placement == Placement::Memoryless,
            history,
            cleared: history || is_cleared(plan, id),
            families: families.to_vec(),
        }
    }

    /// Returns the shape of a slot of the pool.
    pub(crate) fn of_slot(plan: &Plan, slot: framegraph::SlotId, families: &[u32]) -> Self {
        let row = &plan.slots()[slot.index()];
        let (frame, families) = (plan.frame(), families.to_vec());
        let (usage, srgb_views) = (row.usage, row.srgb_views);
        let mut tenants = plan.graph().resource_ids().zip(plan.resources());
        let cleared = tenants.any(|(id, row)| row.placement == Placement::Slot(slot) && is_cleared(plan, id));
        Self { desc: row.desc, frame, usage, srgb_views, memoryless: false, history: false, cleared, families }
    }

    /// Returns the description of an image; `None` for a buffer.
    pub(crate) fn image_info(&self) -> Option<vk::ImageCreateInfo<'_>> {
        let desc = self.desc.texture()?;
        let [width, height] = desc.extent.texels(self.frame);
        let (kind, depth, layers) = match desc.dimension {
            Dimension::D2 => (vk::ImageType::TYPE_2D, 1, desc.layers.into()),
            Dimension::D3 => (vk::ImageType::TYPE_3D, u32::from(desc.layers), 1),
        };
        let mut usage = image_usage(self.usage, desc.format, self.memoryless);
        if self.cleared {
            usage |= vk::ImageUsageFlags::TRANSFER_DST;
        }
        let mut flags = vk::ImageCreateFlags::empty();
        if desc.dimension == Dimension::D3 && usage.contains(vk::ImageUsageFlags::COLOR_ATTACHMENT) {
            flags |= vk::ImageCreateFlags::TYPE_2D_ARRAY_COMPATIBLE;
        }
        if desc.dimension == Dimension::D2 && width == height && layers >= 6 && desc.samples == 1 {
            // `ViewShape::kind` can be a cube.
            flags |= vk::ImageCreateFlags::CUBE_COMPATIBLE;
        }
        if self.srgb_views {
            // Storage usage does not apply to views in the sRGB format.
            flags |= vk::ImageCreateFlags::MUTABLE_FORMAT | vk::ImageCreateFlags::EXTENDED_USAGE;
        }
        let info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(kind)
            .format(vk_format(desc.format))
            .extent(vk::Extent3D { width, height, depth })
            .mip_levels(desc.mip_count(self.frame))
            .array_layers(layers)
            .samples(vk::SampleCountFlags::from_raw(desc.samples.into()))
            .usage(usage);
        Some(if self.families.is_empty() {
            info
        } else {
            info.sharing_mode(vk::SharingMode::CONCURRENT).queue_family_indices(&self.families)
        })
    }

    /// Returns the description of a buffer; `None` for an image.
    pub(crate) fn buffer_info(&self) -> Option<vk::BufferCreateInfo<'_>> {
        let Desc::Buffer(desc) = self.desc else { return None };
        let mut usage = buffer_usage(self.usage);
        if self.cleared {
            usage |= vk::BufferUsageFlags::TRANSFER_DST;
        }
        let info = vk::BufferCreateInfo::default().size(desc.bytes(self.frame).max(4)).usage(usage);
        Some(if self.families.is_empty() {
            info
        } else {
            info.sharing_mode(vk::SharingMode::CONCURRENT).queue_family_indices(&self.families)
        })
    }
}

/// Returns `true` if the executor clears the resource with a command of its own in a frame of the plan.
fn is_cleared(plan: &Plan, id: ResourceId) -> bool {
    let mut accesses = plan.running().flat_map(|member| plan.graph().accesses_of(member.pass));
    accesses.any(|access| access.resource == id && clears(access))
}

/// Returns `true` for an access that the executor clears with a command of its own.
pub(crate) fn clears(access: &Access) -> bool {
    access.mode == Mode::Clear && !access.kind.is_attachment()
}

/// Returns the resource that a history writes, or the resource itself.
pub(crate) fn current(plan: &Plan, id: ResourceId) -> ResourceId {
    match plan.graph().resources()[id.index()].kind {
        Kind::HistoryPrevious { current, .. } => current,
        _ => id,
    }
}

/// A subresource: level, layer and number of the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    pub(crate) mip: u32,
    pub(crate) layer: u32,
    pub(crate) plane: u32,
}

impl Part {
    /// Returns the part at an index of [`framegraph::Barrier`].
    pub(crate) fn at(desc: &TextureDesc, frame: [u32; 2], index: u32) -> Self {
        let (mips, layers) = (desc.mip_count(frame), desc.tracked_layers());
        Self { mip: index % mips, layer: index / mips % layers, plane: index / mips / layers }
    }

    /// Returns the index of the part. Slices of a three-dimensional texture belong to the part of their level.
    pub(crate) fn index(self, desc: &TextureDesc, frame: [u32; 2]) -> u32 {
        let layer = if desc.dimension == Dimension::D3 { 0 } else { self.layer };
        (self.plane * desc.tracked_layers() + layer) * desc.mip_count(frame) + self.mip
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::{Extent, Format};

    #[test]
    fn parts_are_numbered_by_plane_layer_and_level() {
        let desc = TextureDesc::new(Extent::absolute(8, 8), Format::Depth32FloatStencil8).mips(3).layers(2);
        for index in 0..12 {
            let part = Part::at(&desc, [8, 8], index);
            assert_eq!(part.index(&desc, [8, 8]), index);
        }
        assert_eq!(Part::at(&desc, [8, 8], 10), Part { mip: 1, layer: 1, plane: 1 });
    }
}
