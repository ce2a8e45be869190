//! Phase 6, last part: attachments that never leave the tile take no memory.

use crate::access::Usage;
use crate::caps::Caps;
use crate::decision::{Decision, MemoryNeed, Reason, Subject};
use crate::graph::Tables;
use crate::options::Options;
use crate::plan::{Attachment, LoadOp, Placement, Planned, Role, StoreOp};
use crate::resource::{Dimension, Kind};

/// Marks what is memoryless, and says of every attachment that lives in one step why it is not.
#[inline(never)]
pub(crate) fn memoryless(
    graph: &Tables,
    caps: &Caps,
    options: &Options,
    attachments: &mut [Attachment],
    resources: &mut [Planned],
    decisions: &mut Vec<Decision>,
) {
    for attachment in attachments {
        let row = &mut resources[attachment.resource.index()];
        // The step that attaches it is one that touches it, so this is that step.
        let one_step = row.first == row.last;
        if !one_step || graph.resources[attachment.resource.index()].kind != Kind::Transient {
            continue;
        }
        let need = if row.placement == Placement::Own {
            Some(MemoryNeed::LoadedOrStored)
        } else {
            need(graph, caps, options, attachment, row)
        };
        let reason = match need {
            Some(need) => Reason::NeedsMemory(need),
            None => {
                row.placement = Placement::Memoryless;
                // Also of a plane that no pass touches, there is nothing to keep.
                (attachment.store, attachment.stencil_store) = (StoreOp::Discard, StoreOp::Discard);
                Reason::Memoryless(row.first)
            }
        };
        decisions.push(Decision { subject: Subject::Resource(attachment.resource), reason });
    }
}

/// What keeps an attachment of one step in memory, if anything.
fn need(graph: &Tables, caps: &Caps, options: &Options, attachment: &Attachment, row: &Planned) -> Option<MemoryNeed> {
    let texture = graph.resources[attachment.resource.index()].desc.texture()?;
    // Discarded, or touched by no pass of the step.
    let dropped =
        |load: LoadOp, store: StoreOp| store == StoreOp::Discard || (load, store) == (LoadOp::DontCare, StoreOp::None);
    if !caps.memoryless || !options.memoryless {
        Some(MemoryNeed::Unsupported)
    } else if matches!(attachment.role, Role::Resolve(_)) {
        Some(MemoryNeed::ResolveTarget)
    } else if !row.usage.without(Usage::ATTACHMENT).without(Usage::INPUT_ATTACHMENT).is_empty() {
        Some(MemoryNeed::OtherUse)
    } else if attachment.role == Role::DepthReadOnly {
        Some(MemoryNeed::ReadOnly)
    } else if texture.mips != 1 || texture.layers != 1 || texture.dimension != Dimension::D2 {
        Some(MemoryNeed::SeveralParts)
    } else if attachment.load == LoadOp::Load
        || attachment.stencil_load == LoadOp::Load
        || !dropped(attachment.load, attachment.store)
        || !dropped(attachment.stencil_load, attachment.stencil_store)
    {
        Some(MemoryNeed::LoadedOrStored)
    } else {
        None
    }
}
