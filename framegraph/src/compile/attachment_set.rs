//! The attachments of a raster step under construction.

use super::steps::{ResourceRange, overlapping, same_range};
use crate::access::{Access, AccessKind, Mode, Range};
use crate::caps::Caps;
use crate::decision::Refusal;
use crate::format::{Aspect, Format};
use crate::graph::Tables;
use crate::id::ResourceId;

/// Maximum number of color attachments of a step. Merged passes with same-pixel reads can have more than a single pass.
const STEP_COLORS: usize = 16;

/// Slot behind the color slots, for the depth resolve.
const DEPTH: u8 = Access::DEPTH;

/// Attachments of a step under construction. Masks mark the used slots, so that a reset clears only three words.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AttachmentSet {
    colors: [ResourceRange; STEP_COLORS],
    resolves: [ResourceRange; STEP_COLORS],
    depth: ResourceRange,
    color_slots: u16,
    resolve_slots: u16,
    has_depth: Option<Planes>,
    samples: u8,
}

/// Planes of the depth attachment in use, and if one of them is cleared.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planes {
    used: Aspect,
    cleared: bool,
}

/// Slots in use: colors, resolve targets, depth.
pub(crate) type Taken = (u16, u16, Option<Planes>);

const NOWHERE: ResourceRange = (ResourceId::NONE, Range::ALL);

impl Default for AttachmentSet {
    fn default() -> Self {
        Self {
            colors: [NOWHERE; STEP_COLORS],
            resolves: [NOWHERE; STEP_COLORS],
            depth: NOWHERE,
            color_slots: 0,
            resolve_slots: 0,
            has_depth: None,
            samples: 1,
        }
    }
}

/// Iterates over the slots of a mask, lowest first.
#[derive(Clone)]
struct Slots(u16);

impl Iterator for Slots {
    type Item = u8;

    #[inline]
    fn next(&mut self) -> Option<u8> {
        let slot = self.0.trailing_zeros() as u8;
        self.0 &= self.0.wrapping_sub(1);
        (slot < u16::BITS as u8).then_some(slot)
    }
}

impl AttachmentSet {
    /// Resets to the attachments of `accesses` with this sample count.
    pub(crate) fn reset_to(&mut self, accesses: &[Access], samples: u8) {
        self.restore((0, 0, None));
        self.samples = samples;
        for access in accesses {
            self.attach(accesses, access, false);
        }
    }

    /// Returns the slots in use.
    pub(crate) const fn taken(&self) -> Taken {
        (self.color_slots, self.resolve_slots, self.has_depth)
    }

    /// Restores the slots in use, and so removes attachments added since `taken` was called.
    pub(crate) const fn restore(&mut self, taken: Taken) {
        (self.color_slots, self.resolve_slots, self.has_depth) = taken;
    }

    /// Adds the attachment of one access. Uses the next free color slot if the wanted one is in use and `remap` is set.
    /// Returns `false` if there is no valid slot.
    #[inline]
    pub(crate) fn attach(&mut self, pass: &[Access], access: &Access, remap: bool) -> bool {
        let spot = (access.resource, access.range);
        match access.kind {
            AccessKind::Color => self.attach_color(access.slot, spot, remap),
            AccessKind::Depth | AccessKind::DepthReadOnly => {
                let own = Planes { used: spot.1.aspect, cleared: access.mode == Mode::Clear };
                let Some(planes) = self.has_depth else {
                    (self.depth, self.has_depth) = (spot, Some(own));
                    return true;
                };
                let used = if planes.used == own.used { own.used } else { Aspect::All };
                self.has_depth = Some(Planes { used, cleared: planes.cleared | own.cleared });
                same_range(self.depth, spot)
            }
            AccessKind::Resolve => {
                let samples = pass.iter().find(|a| a.is_resolved_by(access)).map(|a| (a.resource, a.range));
                let color = |spot| if access.slot == DEPTH { Some(DEPTH) } else { self.color_slot(spot) };
                let Some(slot) = samples.and_then(color) else {
                    return false;
                };
                let free = self.resolve_of(slot).is_none();
                if free {
                    self.set_resolve(slot, spot);
                }
                free
            }
            _ => true,
        }
    }

    /// Returns `true` if a range partly overlaps an attachment, or overlaps a resolve target. A layer cannot be
    /// attached twice.
    pub(crate) fn crosses(&self, spot: ResourceRange) -> bool {
        let of = |(_, s): (u8, ResourceRange)| s;
        let depth = self.has_depth.map(|_| self.depth);
        let mut shown = self.colors().map(of).chain(depth);
        shown.any(|s| overlapping(s, spot) && !same_range(s, spot))
            || self.resolves().map(of).any(|s| overlapping(s, spot))
    }

    fn attach_color(&mut self, wanted: u8, spot: ResourceRange, remap: bool) -> bool {
        if let Some(slot) = self.color_slot(spot) {
            return remap || slot == wanted;
        }
        let taken = |slot: u8| self.color_slots & (1 << slot) != 0;
        let free = if !taken(wanted) {
            Some(wanted)
        } else if remap {
            (0..DEPTH).find(|s| !taken(*s))
        } else {
            None
        };
        if let Some(slot) = free {
            self.set_color(slot, spot);
        }
        free.is_some()
    }

    /// The color attachments with their slots.
    pub(crate) fn colors(&self) -> impl Iterator<Item = (u8, ResourceRange)> + Clone {
        Slots(self.color_slots).map(|s| (s, self.colors[usize::from(s)]))
    }

    /// The resolve targets with the slots of their source; [`Access::DEPTH`] for depth.
    pub(crate) fn resolves(&self) -> impl Iterator<Item = (u8, ResourceRange)> {
        Slots(self.resolve_slots).map(|s| (s, self.resolves[usize::from(s)]))
    }

    /// Returns the resolve target of a slot.
    pub(crate) fn resolve_of(&self, slot: u8) -> Option<ResourceRange> {
        let has = self.resolve_slots & (1 << slot) != 0;
        has.then(|| self.resolves[usize::from(slot)])
    }

    /// Sets the attachment of a color slot.
    pub(crate) fn set_color(&mut self, slot: u8, spot: ResourceRange) {
        self.colors[usize::from(slot)] = spot;
        self.color_slots |= 1 << slot;
    }

    /// Sets the resolve target of a color slot.
    pub(crate) fn set_resolve(&mut self, slot: u8, spot: ResourceRange) {
        self.resolves[usize::from(slot)] = spot;
        self.resolve_slots |= 1 << slot;
    }

    /// Returns the slot in which a range is attached as color.
    #[inline]
    pub(crate) fn color_slot(&self, spot: ResourceRange) -> Option<u8> {
        self.colors().find(|(_, c)| same_range(*c, spot)).map(|(slot, _)| slot)
    }

    /// Returns `true` if a range is the depth attachment.
    #[inline]
    pub(crate) fn is_depth(&self, spot: ResourceRange) -> bool {
        self.has_depth.is_some() && same_range(self.depth, spot)
    }

    /// Returns `true` if a range is in the tile: a color attachment, or a plane of the depth attachment that the step
    /// uses.
    #[inline]
    pub(crate) fn shows(&self, spot: ResourceRange) -> bool {
        let used = |planes: Planes| planes.used == Aspect::All || planes.used == spot.1.aspect;
        self.color_slot(spot).is_some() || self.has_depth.is_some_and(used) && self.is_depth(spot)
    }

    /// Returns `true` if a plane of the depth attachment can still be cleared at the start of the step. No pass may use
    /// that plane, and the other plane must not be cleared, because both share one clear value.
    pub(crate) fn can_clear(&self, spot: ResourceRange) -> bool {
        let apart = |a: Aspect, b: Aspect| a != b && a != Aspect::All && b != Aspect::All;
        self.has_depth.is_some_and(|planes| !planes.cleared && apart(planes.used, spot.1.aspect))
    }

    /// Checks that the color attachments fit the limits of the device. If same-pixel reads stay in the tile, the
    /// attachment limit applies to each pass; only the tile memory is shared.
    pub(crate) fn fits(&self, graph: &Tables, caps: &Caps) -> Result<(), Refusal> {
        let format = |(_, (r, _)): (u8, ResourceRange)| graph.resources[r.index()].desc.texture().map(|t| t.format);
        let formats = self.colors().filter_map(format);
        let count = formats.clone().count();
        let bytes: u32 = formats.clone().map(Format::tile_bytes).sum();
        let many = count > usize::from(caps.max_color_attachments)
            || Format::tile_sum(formats) > caps.max_color_bytes_per_sample;
        if many && !caps.same_pixel {
            return Err(Refusal::TooManyAttachments);
        }
        let tile = bytes * u32::from(self.samples);
        if caps.tile_bytes_per_pixel != 0 && tile > caps.tile_bytes_per_pixel {
            return Err(Refusal::TileMemory);
        }
        Ok(())
    }
}
