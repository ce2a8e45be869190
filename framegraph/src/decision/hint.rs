//! What can be done about a decision that somebody would rather have otherwise.

use super::{MemoryNeed, Reason};

impl Reason {
    /// What to change to have it otherwise; empty where there is nothing to want.
    pub const fn hint(self) -> &'static str {
        match self {
            Self::CulledUnread(_) | Self::CulledReaderCulled(..) => {
                "read it, export it, or declare a side effect, if it matters"
            }
            Self::CulledOverwritten(..) => "let the later pass modify it, if the contents matter",
            Self::CulledNoOutput => "declare a side effect, if it does anything",
            Self::KeptCullingOff => "switch culling on",
            Self::Split(_, why) | Self::NotInlined(_, why) => why.hint(),
            Self::LoadWritten(_) => "clear or overwrite it, or let the pass share the step of its writer",
            Self::ClearUnneeded => "read it, export it, or leave it out of the pass",
            Self::LoadEntry => "clear or overwrite it, or import it without contents",
            Self::StoreReadBy(_) => {
                "read it at the same pixel, or let the reader share the step, to keep it in the tile"
            }
            Self::NeedsMemory(need) => need.hint(),
            Self::AliasingOff => "switch sharing on",
            Self::Unused => "remove it, or the condition that culls its passes",
            Self::KeptSideEffect
            | Self::KeptExport(_)
            | Self::KeptImport(_)
            | Self::KeptHistory(_)
            | Self::KeptReadBy(..)
            | Self::OrderMerge(_)
            | Self::OrderBytes(_)
            | Self::MergedAttachments(_)
            | Self::MergedSamePixel(_)
            | Self::MergedInline(_)
            | Self::LoadClear
            | Self::LoadOverwritten
            | Self::StoreExport
            | Self::StoreImport
            | Self::StoreHistory
            | Self::DiscardUnread
            | Self::DiscardOverwritten
            | Self::DiscardResolved
            | Self::StoreUnchanged
            | Self::Memoryless(_)
            | Self::Inlined
            | Self::SlotFirst
            | Self::SlotAfter(_)
            | Self::Placed
            | Self::PlacedAfter(_)
            | Self::External
            | Self::Persistent => "",
        }
    }
}

impl MemoryNeed {
    /// What to change so that the attachment needs no memory.
    pub const fn hint(self) -> &'static str {
        match self {
            Self::Unsupported => "ask a device that has them, or switch them on",
            Self::OtherUse => "use it as an attachment only",
            Self::ResolveTarget => "inline its reader into the pass that draws it",
            Self::SeveralParts => "split it into textures of one level and layer",
            Self::LoadedOrStored => "clear or overwrite it, and let nobody read it after the step",
            Self::ReadOnly => "let a pass of the same step write it",
        }
    }
}
