//! Hints: how to change a decision of a plan.

use crate::access::{Access, AccessKind, Mode};
use crate::decision::{Decision, Reason, Refusal, Subject};
use crate::graph::{PassFlags, PassKind};
use crate::id::{PassId, ResourceId};
use crate::plan::Plan;

impl Plan {
    /// Returns how to change a decision of this plan; empty if there is no reason to change it.
    ///
    /// Takes the passes, the device and the options into account, so that the hint is not already fulfilled.
    pub fn hint(&self, decision: &Decision) -> &'static str {
        let (general, graph) = (decision.reason.hint(), self.graph());
        let inlining = self.options().inline && self.caps().inline;
        match (decision.reason, decision.subject) {
            (Reason::Split(_, Refusal::SamePixelUnsupported), Subject::Pass(pass)) => {
                let accesses = graph.accesses_of(pass);
                let count = |counts: fn(&Access) -> bool| accesses.iter().filter(|a| counts(a)).count();
                let one_of_each = count(|a| a.kind == AccessKind::SamePixel) == 1
                    && count(|a| a.mode.writes() || a.kind.is_attachment()) == 1
                    && count(|a| a.kind == AccessKind::Color && a.mode != Mode::Modify) == 1;
                let samples = count(|a| a.kind == AccessKind::Sampled) != 0;
                let flags = graph.passes()[pass.index()].flags;
                if inlining && flags.has(PassFlags::POINTWISE) {
                    "use a device that supports it, or fix what prevents inlining of the pass"
                } else if inlining && one_of_each && !samples && !flags.has(PassFlags::SIDE_EFFECT) {
                    general
                } else {
                    "use a device that supports it"
                }
            }
            (Reason::Split(writer, Refusal::SampledElsewhere), Subject::Pass(reader)) => {
                let step = self.pass_steps()[writer.index()];
                let written = |resource| {
                    let attached = step.some().map(|step| self.attachments_of(step)).unwrap_or_default();
                    attached.iter().any(|a| a.resource == resource)
                };
                let mut sampled = graph.accesses_of(reader).iter().filter(|a| a.kind == AccessKind::Sampled);
                let possible = sampled.any(|a| written(a.resource) && self.fits_pixels(reader, a.resource));
                if possible { general } else { "" }
            }
            (Reason::StoreReadBy(reader), Subject::Store(_, resource)) if !self.fits_pixels(reader, resource) => "",
            (Reason::StoreReadBy(reader), Subject::Store(_, resource)) => {
                let reads = |a: &&Access| a.resource == resource && a.mode == Mode::Read;
                let mut reads = graph.accesses_of(reader).iter().filter(reads).map(|a| a.kind).peekable();
                if !self.options().merge || !self.caps().same_pixel && !inlining {
                    "use a device that keeps same-pixel reads in the tile, and enable merging"
                } else if graph.passes()[reader.index()].kind != PassKind::Raster {
                    "to keep it in the tile, read it in a raster pass of the same step"
                } else if reads.peek().is_some() && reads.all(|kind| kind != AccessKind::Sampled) {
                    "to keep it in the tile, let the reader share the step"
                } else {
                    general
                }
            }
            _ => general,
        }
    }

    /// Returns whether a raster pass could read a texture at the same pixel: the texture has the size and the layers of
    /// its attachments. True for passes of other kinds, which no size excludes.
    fn fits_pixels(&self, reader: PassId, resource: ResourceId) -> bool {
        let Some(step) = self.pass_steps()[reader.index()].some().map(|step| &self.steps()[step.index()]) else {
            return true;
        };
        let Some(texture) = self.graph().resources()[resource.index()].desc.texture() else { return true };
        let extent = texture.mip_extent(self.frame(), 0);
        step.kind != PassKind::Raster || extent == step.extent && u32::from(texture.layers) == step.layers
    }

    /// Returns the decision as a sentence with names. For passes that were not merged or inlined, appends a hint.
    pub fn explained(&self, decision: &Decision) -> String {
        let sentence = decision.sentence(self.graph());
        let apart = matches!(decision.reason, Reason::Split(..) | Reason::NotInlined(..));
        let hint = if apart { self.hint(decision) } else { "" };
        if hint.is_empty() { sentence } else { format!("{sentence}; {hint}") }
    }
}
