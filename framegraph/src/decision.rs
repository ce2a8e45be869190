//! Why the plan is as it is: one record for every decision, with a reason from a closed list.
//!
//! The phases write the log while they decide; dumps, viewer, diff and tests read it. Nothing works a reason out
//! afterwards.

mod hint;

use crate::graph::Graph;
use crate::id::{PassId, ResourceId, StepId};
use serde::{Deserialize, Serialize};

/// What a decision is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Subject {
    /// A declared pass.
    Pass(PassId),
    /// What happens to one resource at the start of a step.
    Load(StepId, ResourceId),
    /// What happens to one resource at the end of a step.
    Store(StepId, ResourceId),
    /// A declared resource.
    Resource(ResourceId),
}

/// One decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Decision {
    /// About what.
    pub subject: Subject,
    /// What was decided, and why.
    pub reason: Reason,
}

/// Everything that a compile can decide, each with its cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Reason {
    /// Kept: it declares a side effect.
    KeptSideEffect,
    /// Kept: it writes an exported resource.
    KeptExport(ResourceId),
    /// Kept: it writes an imported resource that must survive.
    KeptImport(ResourceId),
    /// Kept: it writes a history that later frames read.
    KeptHistory(ResourceId),
    /// Kept: a kept pass reads what it writes.
    KeptReadBy(ResourceId, PassId),
    /// Kept: culling is switched off.
    KeptCullingOff,
    /// Culled: nobody reads this output, nor any other.
    CulledUnread(ResourceId),
    /// Culled: only this culled pass reads what it writes.
    CulledReaderCulled(ResourceId, PassId),
    /// Culled: what it writes is written over before anybody reads it.
    CulledOverwritten(ResourceId, PassId),
    /// Culled: it writes nothing.
    CulledNoOutput,
    /// Moved behind this pass, whose step it shares.
    OrderMerge(PassId),
    /// Runs behind this pass, since in the new order the frame takes fewer steps or bytes.
    OrderBytes(PassId),
    /// Shares the step of this pass: they have the same attachments.
    MergedAttachments(PassId),
    /// Shares the step of this pass: its same-pixel reads stay in the tile.
    MergedSamePixel(PassId),
    /// Became an epilogue of this pass's shader.
    MergedInline(PassId),
    /// Not merged with the step before it.
    Split(PassId, Refusal),
    /// Not made an epilogue of its producer's shader.
    NotInlined(PassId, Refusal),
    /// Cleared: the pass declares it.
    LoadClear,
    /// Cleared: nobody needs what it held, nor what its passes add to it.
    ClearUnneeded,
    /// Don't care: every texel is written.
    LoadOverwritten,
    /// Loaded: this pass wrote contents that are needed.
    LoadWritten(PassId),
    /// Loaded: the contents on entry are needed.
    LoadEntry,
    /// Stored: this pass reads it.
    StoreReadBy(PassId),
    /// Stored: it is exported.
    StoreExport,
    /// Stored: it is imported and must survive.
    StoreImport,
    /// Stored: later frames read it.
    StoreHistory,
    /// Discarded: nobody reads it any more.
    DiscardUnread,
    /// Discarded: it is written over before anybody reads it.
    DiscardOverwritten,
    /// Discarded: it was resolved, and nobody reads the samples.
    DiscardResolved,
    /// Neither stored nor discarded: it was only read, and somebody still needs it, or reads it beside the depth test.
    StoreUnchanged,
    /// Takes no memory: an attachment that lives in this step only.
    Memoryless(StepId),
    /// Takes memory although it lives in one step: this is why.
    NeedsMemory(MemoryNeed),
    /// Never exists: its only reader was made an epilogue of its writer's shader.
    Inlined,
    /// Has a slot of its own, or is the slot's first tenant.
    SlotFirst,
    /// Takes over the slot of this resource.
    SlotAfter(ResourceId),
    /// Placed in the heap above or beside others.
    Placed,
    /// Placed over the memory of this resource, which is dead by then.
    PlacedAfter(ResourceId),
    /// Owned by somebody else.
    External,
    /// Not shared: its contents outlive the frame.
    Persistent,
    /// Not shared: sharing is switched off.
    AliasingOff,
    /// No kept pass touches it.
    Unused,
}

/// Why two passes do not share a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Refusal {
    /// Merging is switched off, or the device has no use for it.
    Disabled,
    /// One of them is a compute or copy pass.
    NotRaster,
    /// A compute or copy pass runs between them.
    ComputeBetween,
    /// The attachments differ in size.
    Extent,
    /// The attachments differ in samples.
    Samples,
    /// The attachments differ in layers.
    Layers,
    /// The color attachments differ, and the device cannot widen a step.
    ColorsDiffer,
    /// The depth attachments differ.
    DepthDiffers,
    /// Together they have more color attachments than a step can have.
    TooManyAttachments,
    /// Together they need more tile memory than there is.
    TileMemory,
    /// The later one samples what the earlier one writes.
    SampledElsewhere,
    /// The later one reads at the same pixel, which this device has to sample.
    SamePixelUnsupported,
    /// The later one clears or overwrites an attachment that the earlier one wrote.
    ClearBetween,
    /// The earlier one resolves an attachment that the later one changes.
    ResolveBetween,
    /// One of them asks to stay alone.
    NeverMerge,
    /// One of them writes storage that the other touches.
    StorageHazard,
    /// The intermediate is read by somebody else, or must survive.
    NeededAsTexture,
    /// The producer blends: its output is final only at the end of the pass.
    Blends,
    /// The consumer is not declared point-wise.
    NotPointwise,
    /// The producer's shader takes no epilogue.
    NoEpilogue,
    /// The shape of the two targets differs beyond the format.
    TargetShape,
    /// The producer adds to older contents of the intermediate, or the consumer to those of its target.
    BuildsOnContents,
    /// The consumer has a side effect, which an epilogue, that records nothing, would lose.
    SideEffect,
}

/// Why an attachment of one step takes memory all the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum MemoryNeed {
    /// The device has no such attachments, or they are switched off.
    Unsupported,
    /// It is used as something other than an attachment.
    OtherUse,
    /// It is a resolve target, which is written to memory.
    ResolveTarget,
    /// It has several levels or layers.
    SeveralParts,
    /// Its contents are loaded or stored.
    LoadedOrStored,
    /// It is a read-only attachment.
    ReadOnly,
}

impl Refusal {
    /// Why, as the end of a sentence.
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::Disabled => "merging is switched off",
            Self::NotRaster => "one of them is no raster pass",
            Self::ComputeBetween => "a compute or copy pass runs between them",
            Self::Extent => "their attachments differ in size",
            Self::Samples => "their attachments differ in samples",
            Self::Layers => "their attachments differ in layers",
            Self::ColorsDiffer => "their color attachments differ",
            Self::DepthDiffers => "their depth attachments differ",
            Self::TooManyAttachments => "together they have too many color attachments",
            Self::TileMemory => "together they need more tile memory than there is",
            Self::SampledElsewhere => "the later one samples what the step writes",
            Self::SamePixelUnsupported => "the device cannot keep a same-pixel read in the tile",
            Self::ClearBetween => "the later one clears or overwrites what the step wrote",
            Self::ResolveBetween => "the step resolves an attachment that the later one changes",
            Self::NeverMerge => "one of them asks to stay alone",
            Self::StorageHazard => "one of them writes storage that the other touches",
            Self::NeededAsTexture => "the intermediate is needed as a texture",
            Self::Blends => "the producer blends",
            Self::NotPointwise => "the consumer is not declared point-wise",
            Self::NoEpilogue => "the producer's shader takes no epilogue",
            Self::TargetShape => "the two targets differ in more than the format",
            Self::BuildsOnContents => "one of them adds to what was there before",
            Self::SideEffect => "the consumer has a side effect",
        }
    }

    /// What to do about it.
    pub const fn hint(self) -> &'static str {
        match self {
            Self::Disabled => "switch merging on",
            Self::NotRaster | Self::ComputeBetween => "move the compute or copy pass before or after both",
            Self::Extent | Self::Samples | Self::Layers => "give both the same shape",
            Self::ColorsDiffer | Self::DepthDiffers => "attach the same textures, or read at the same pixel",
            Self::TooManyAttachments | Self::TileMemory => "pack outputs into fewer or smaller attachments",
            Self::SampledElsewhere => "declare the read `same_pixel` if it reads only its own texel",
            Self::SamePixelUnsupported => "declare the pass point-wise, so that it can be inlined",
            Self::ClearBetween => "use another texture for the later pass",
            Self::ResolveBetween => "resolve in the last pass that writes the attachment",
            Self::NeverMerge => "remove `never_merge`",
            Self::StorageHazard => "use another buffer, or an attachment",
            Self::NeededAsTexture => "let the point-wise pass be the only reader",
            Self::Blends => "blend after the point-wise pass, or accept the full-screen pass",
            Self::NotPointwise => "declare it with `pointwise` if it is",
            Self::NoEpilogue => "declare `takes_epilogue` and assemble the shader from its parts",
            Self::TargetShape => "give both targets the same size and layers",
            Self::BuildsOnContents => "clear or overwrite both targets",
            Self::SideEffect => "move the side effect to a pass of its own",
        }
    }
}

impl MemoryNeed {
    /// Why, as the end of a sentence.
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::Unsupported => "the device has no memoryless attachments",
            Self::OtherUse => "it is used as something other than an attachment",
            Self::ResolveTarget => "it is a resolve target",
            Self::SeveralParts => "it has several levels or layers",
            Self::LoadedOrStored => "its contents are loaded or stored",
            Self::ReadOnly => "it is attached read-only",
        }
    }
}

impl Decision {
    /// The decision in words, with names.
    pub fn sentence(&self, graph: &Graph) -> String {
        let subject = match self.subject {
            Subject::Pass(p) => format!("pass `{}`", graph.pass_name(p)),
            Subject::Load(s, r) => {
                format!("load of `{}` in step {}", graph.resource_name(r), s.index())
            }
            Subject::Store(s, r) => format!("store of `{}` in step {}", graph.resource_name(r), s.index()),
            Subject::Resource(r) => format!("resource `{}`", graph.resource_name(r)),
        };
        format!("{subject}: {}", self.reason.sentence(graph))
    }
}

impl Reason {
    /// What was decided and why, with names.
    pub fn sentence(&self, graph: &Graph) -> String {
        let p = |id: PassId| graph.pass_name(id);
        let r = |id: ResourceId| graph.resource_name(id);
        match *self {
            Self::KeptSideEffect => "kept, it declares a side effect".into(),
            Self::KeptExport(x) => format!("kept, it writes `{}`, which is exported", r(x)),
            Self::KeptImport(x) => format!("kept, it writes `{}`, which is imported and must survive", r(x)),
            Self::KeptHistory(x) => format!("kept, it writes `{}`, which later frames read", r(x)),
            Self::KeptReadBy(x, y) => format!("kept, `{}` reads `{}`", p(y), r(x)),
            Self::KeptCullingOff => "kept, culling is switched off".into(),
            Self::CulledUnread(x) => format!("culled, nobody reads `{}`", r(x)),
            Self::CulledReaderCulled(x, y) => {
                format!("culled, only `{}` reads `{}`, and it is culled", p(y), r(x))
            }
            Self::CulledOverwritten(x, y) => {
                format!("culled, `{}` writes over `{}` before anybody reads it", p(y), r(x))
            }
            Self::CulledNoOutput => "culled, it writes nothing and declares no side effect".into(),
            Self::OrderMerge(x) => format!("moved behind `{}`, to share its step", p(x)),
            Self::OrderBytes(x) => {
                format!("runs behind `{}`, the frame takes fewer steps or bytes in this order", p(x))
            }
            Self::MergedAttachments(x) => format!("merged with `{}`, same attachments", p(x)),
            Self::MergedSamePixel(x) => {
                format!("merged with `{}`, its reads stay in the tile", p(x))
            }
            Self::MergedInline(x) => format!("inlined into the shader of `{}`", p(x)),
            Self::Split(x, why) => format!("not merged with `{}`: {}; {}", p(x), why.sentence(), why.hint()),
            Self::NotInlined(x, why) => format!("not inlined into `{}`: {}; {}", p(x), why.sentence(), why.hint()),
            Self::LoadClear => "cleared".into(),
            Self::ClearUnneeded => "cleared, nobody needs what it held nor what is added".into(),
            Self::LoadOverwritten => "don't care, every texel is written".into(),
            Self::LoadWritten(x) => format!("loaded, `{}` wrote contents that are needed", p(x)),
            Self::LoadEntry => "loaded, the contents on entry are needed".into(),
            Self::StoreReadBy(x) => format!("stored, `{}` reads it", p(x)),
            Self::StoreExport => "stored, it is exported".into(),
            Self::StoreImport => "stored, it is imported and must survive".into(),
            Self::StoreHistory => "stored, later frames read it".into(),
            Self::DiscardUnread => "discarded, nobody reads it any more".into(),
            Self::DiscardOverwritten => "discarded, it is written over before anybody reads it".into(),
            Self::DiscardResolved => "discarded, it was resolved and nobody reads the samples".into(),
            Self::StoreUnchanged => "left in memory, it was only read".into(),
            Self::Memoryless(_) => "takes no memory, it lives in one step".into(),
            Self::NeedsMemory(why) => format!("takes memory, {}", why.sentence()),
            Self::Inlined => "never exists, its reader was inlined".into(),
            Self::SlotFirst => "first tenant of its slot".into(),
            Self::SlotAfter(x) => format!("takes over the slot of `{}`", r(x)),
            Self::Placed => "placed in the heap".into(),
            Self::PlacedAfter(x) => format!("placed over the memory of `{}`", r(x)),
            Self::External => "owned outside of the graph".into(),
            Self::Persistent => "not shared, its contents outlive the frame".into(),
            Self::AliasingOff => "not shared, sharing is switched off".into(),
            Self::Unused => "no kept pass touches it".into(),
        }
    }
}
