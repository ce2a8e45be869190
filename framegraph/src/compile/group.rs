//! The raster step that is being put together: what is attached to it so far.

use crate::access::{Access, AccessKind, Range};
use crate::caps::Caps;
use crate::decision::Refusal;
use crate::format::Format;
use crate::graph::Graph;
use crate::id::ResourceId;

/// Size, samples and layers that all attachments of a step share.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Width and height in texels; 0 without attachments.
    pub(crate) extent: [u32; 2],
    /// Layers; 0 without attachments.
    pub(crate) layers: u32,
    /// Samples; 1 without attachments.
    pub(crate) samples: u8,
}

/// The most color attachments of one step: several passes that read each other in the tile can have more than one pass.
const STEP_COLORS: usize = 16;

/// One level and some layers of one resource.
pub(crate) type Spot = (ResourceId, Range);

/// Attachments of a step in the making.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Group {
    /// Color attachments by slot of the step.
    pub(crate) colors: [Option<Spot>; STEP_COLORS],
    /// Resolve targets by slot of the color attachment that they average.
    pub(crate) resolves: [Option<Spot>; STEP_COLORS],
    /// The depth attachment.
    pub(crate) depth: Option<Spot>,
    /// What all attachments share.
    pub(crate) shape: Shape,
}

/// The shape of one attachment.
pub(crate) fn shape_of(graph: &Graph, access: &Access, frame: [u32; 2]) -> Shape {
    let Some(texture) = graph.resources[access.resource.index()].desc.texture() else {
        return Shape {
            extent: [0; 2],
            layers: 0,
            samples: 1,
        };
    };
    let layers = access.range.layer_range(texture.tracked_layers());
    Shape {
        extent: texture.mip_extent(frame, access.range.mip.into()),
        layers: layers.end - layers.start,
        samples: texture.samples,
    }
}

/// The shape of a pass's attachments: that of its first color or depth attachment, else of its first resolve target.
pub(crate) fn shape_of_pass(graph: &Graph, accesses: &[Access], frame: [u32; 2]) -> Shape {
    let attached = accesses.iter().filter(|a| a.kind.is_attachment());
    let first = attached
        .clone()
        .find(|a| a.kind != AccessKind::Resolve)
        .or_else(|| attached.clone().next());
    first.map_or(
        Shape {
            extent: [0; 2],
            layers: 0,
            samples: 1,
        },
        |a| shape_of(graph, a, frame),
    )
}

impl Group {
    /// The step that `accesses` open.
    pub(crate) fn open(graph: &Graph, accesses: &[Access], frame: [u32; 2]) -> Self {
        let mut group = Self {
            shape: shape_of_pass(graph, accesses, frame),
            ..Self::default()
        };
        for access in accesses {
            group.attach(accesses, access, false);
        }
        group
    }

    /// Attaches what one access of a pass names. Where the wanted color slot is taken by another, the next free one is
    /// used if `remap`. Returns false when there is no place.
    pub(crate) fn attach(&mut self, pass: &[Access], access: &Access, remap: bool) -> bool {
        let spot = (access.resource, access.range);
        match access.kind {
            AccessKind::Color => self.attach_color(access.slot, spot, remap),
            AccessKind::Depth | AccessKind::DepthReadOnly => {
                same_spot(*self.depth.get_or_insert(spot), spot)
            }
            AccessKind::Resolve => {
                let averaged = pass
                    .iter()
                    .find(|a| a.kind == AccessKind::Color && a.slot == access.slot);
                let Some(slot) = averaged.and_then(|a| self.color_slot((a.resource, a.range)))
                else {
                    return false;
                };
                let place = &mut self.resolves[usize::from(slot)];
                let free = place.is_none();
                place.get_or_insert(spot);
                free
            }
            _ => true,
        }
    }

    fn attach_color(&mut self, wanted: u8, spot: Spot, remap: bool) -> bool {
        if let Some(slot) = self.color_slot(spot) {
            return remap || slot == wanted;
        }
        let wanted = usize::from(wanted);
        let free = match self.colors[wanted] {
            None => Some(wanted),
            Some(_) if remap => self.colors.iter().position(Option::is_none),
            Some(_) => None,
        };
        free.map(|slot| self.colors[slot] = Some(spot)).is_some()
    }

    /// The slot of the step in which a spot is attached as color.
    pub(crate) fn color_slot(&self, spot: Spot) -> Option<u8> {
        self.colors
            .iter()
            .position(|c| c.is_some_and(|c| same_spot(c, spot)))
            .map(|slot| slot as u8)
    }

    /// Whether the color attachments fit the device. Where same-pixel reads stay in the tile, each pass of a step has the
    /// device's number of attachments to itself, and the tile's memory is what they share.
    pub(crate) fn fits(&self, graph: &Graph, caps: &Caps) -> Result<(), Refusal> {
        let format = |(r, _): Spot| graph.resources[r.index()].desc.texture().map(|t| t.format);
        let formats = || {
            self.colors
                .iter()
                .flatten()
                .filter_map(|spot| format(*spot))
        };
        let bytes: u32 = formats().map(Format::tile_bytes).sum();
        let many = formats().count() > usize::from(caps.max_color_attachments)
            || bytes > caps.max_color_bytes_per_sample;
        if many && !caps.same_pixel {
            return Err(Refusal::TooManyAttachments);
        }
        let tile = bytes * u32::from(self.shape.samples.max(1));
        if caps.tile_bytes_per_pixel != 0 && tile > caps.tile_bytes_per_pixel {
            return Err(Refusal::TileMemory);
        }
        Ok(())
    }
}

/// Two spots of one resource at one level and layer; planes may differ, since they are attached together.
pub(crate) fn same_spot(a: Spot, b: Spot) -> bool {
    let layers = |r: Range| (r.layer, r.layers);
    a.0 == b.0 && a.1.mip == b.1.mip && layers(a.1) == layers(b.1)
}
