//! What to change to have a decision otherwise.

use crate::access::{Access, AccessKind, Mode};
use crate::decision::{Decision, Reason, Refusal, Subject};
use crate::graph::{PassFlags, PassKind};
use crate::plan::Plan;

impl Plan {
    /// What to change to have a decision of this plan otherwise; empty where there is nothing to want. Passes, device and
    /// options are asked, so that nothing is advised that is so already or cannot be.
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
                    "choose a device that can, or mend what keeps the pass from being inlined"
                } else if inlining && one_of_each && !samples && !flags.has(PassFlags::SIDE_EFFECT) {
                    general
                } else {
                    "choose a device that can"
                }
            }
            (Reason::StoreReadBy(reader), Subject::Store(_, resource)) => {
                let reads = |a: &&Access| a.resource == resource && a.mode == Mode::Read;
                let mut reads = graph.accesses_of(reader).iter().filter(reads).map(|a| a.kind).peekable();
                if !self.options().merge || !self.caps().same_pixel && !inlining {
                    "choose a device that keeps same-pixel reads in the tile, and leave merging on"
                } else if graph.passes()[reader.index()].kind != PassKind::Raster {
                    "read it in a raster pass that shares the step, to keep it in the tile"
                } else if reads.peek().is_some() && reads.all(|kind| kind != AccessKind::Sampled) {
                    "let the reader share the step, to keep it in the tile"
                } else {
                    general
                }
            }
            _ => general,
        }
    }

    /// A decision of this plan in words, with names; for passes that stay apart with what they would need to share a step.
    pub fn explained(&self, decision: &Decision) -> String {
        let sentence = decision.sentence(self.graph());
        let apart = matches!(decision.reason, Reason::Split(..) | Reason::NotInlined(..));
        let hint = if apart { self.hint(decision) } else { "" };
        if hint.is_empty() { sentence } else { format!("{sentence}; {hint}") }
    }
}
