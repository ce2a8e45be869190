//! Properties shared by the attachments of a pass or step: size, layers and samples.

use super::measure::Measured;
use crate::access::{Access, AccessKind};
use crate::decision::Refusal;
use crate::graph::{Declared, Tables};
use crate::id::AccessId;
use crate::plan::StepPass;
use crate::resource::halved;

/// Size, layers and samples of all attachments of a step. Packed into two words, so that comparisons are cheap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Framebuffer {
    /// Width in the lower half, height in the upper half.
    extent: u64,
    /// Samples in the lower half, layers in the upper half.
    counts: u64,
}

impl Framebuffer {
    /// The framebuffer of a pass without attachments.
    pub(crate) const NONE: Self = Self::new([0; 2], 0, 1);

    #[inline]
    pub(crate) const fn new(extent: [u32; 2], layers: u32, samples: u8) -> Self {
        let extent = extent[0] as u64 | (extent[1] as u64) << 32;
        Self { extent, counts: samples as u64 | (layers as u64) << 32 }
    }

    /// Width and height in texels; 0 without attachments.
    #[inline]
    pub(crate) const fn extent(self) -> [u32; 2] {
        [self.extent as u32, (self.extent >> 32) as u32]
    }

    /// Number of layers; 0 without attachments.
    #[inline]
    pub(crate) const fn layers(self) -> u32 {
        (self.counts >> 32) as u32
    }

    /// Number of samples; 1 without attachments.
    #[inline]
    pub(crate) const fn samples(self) -> u8 {
        self.counts as u8
    }

    /// Returns the reason why passes with these framebuffers cannot share a step.
    #[inline]
    pub(crate) const fn difference(self, other: Self) -> Refusal {
        if self.extent != other.extent {
            Refusal::Extent
        } else if self.samples() != other.samples() {
            Refusal::Samples
        } else {
            Refusal::Layers
        }
    }
}

/// Returns the framebuffer that one attachment requires.
#[inline]
pub(crate) fn framebuffer_of(graph: &Tables, measures: &[Measured], access: &Access) -> Framebuffer {
    let Some(texture) = graph.resources[access.resource.index()].desc.texture() else {
        return Framebuffer::NONE;
    };
    let layers = access.range.layer_range(texture.tracked_layers());
    let extent = measures[access.resource.index()].extent;
    let extent = extent.map(|side| halved(side, access.range.mip.into()));
    Framebuffer::new(extent, layers.end - layers.start, texture.samples)
}

/// Returns the framebuffer of a pass: that of its first color or depth attachment, otherwise of its first resolve
/// target.
#[inline(always)]
pub(crate) fn framebuffer_of_pass(graph: &Tables, measures: &[Measured], pass: &Declared) -> Framebuffer {
    match pass.sole_color.some() {
        Some(sole) => {
            let measured = &measures[graph.accesses[sole.index()].resource.index()];
            Framebuffer::new(measured.extent, 1, measured.layout.samples())
        }
        None => framebuffer_of_several(graph, measures, pass.accesses.of(&graph.accesses)),
    }
}

#[inline(never)]
fn framebuffer_of_several(graph: &Tables, measures: &[Measured], accesses: &[Access]) -> Framebuffer {
    let mut resolve = None;
    for access in accesses {
        match access.kind {
            AccessKind::Color | AccessKind::Depth | AccessKind::DepthReadOnly => {
                return framebuffer_of(graph, measures, access);
            }
            AccessKind::Resolve => resolve = resolve.or(Some(access)),
            _ => {}
        }
    }
    resolve.map_or(Framebuffer::NONE, |a| framebuffer_of(graph, measures, a))
}

/// Returns the attachment of a step that consists of one pass with a single color attachment with one subresource, and
/// without same-pixel reads.
#[inline]
pub(crate) fn sole_color(graph: &Tables, members: &[StepPass]) -> Option<AccessId> {
    match members {
        [only] => graph.passes[only.pass.index()].sole_color.some(),
        _ => None,
    }
}
