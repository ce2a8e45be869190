//! Phase 6, last part: attachments that never leave the tile take no memory.

use crate::access::Usage;
use crate::caps::Caps;
use crate::decision::{Decision, MemoryNeed, Reason, Subject};
use crate::graph::Tables;
use crate::options::Options;
use crate::plan::{Attachment, Placement, Planned, StoreOp};
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
    // Rows of one resource: one check of its number serves for both.
    let resources = &mut resources[..graph.resources.len()];
    for attachment in attachments {
        let row = &mut resources[attachment.resource.index()];
        // The step that attaches it is one that touches it, so this is that step.
        let one_step = row.first == row.last;
        if !one_step || graph.resources[attachment.resource.index()].kind != Kind::Transient {
            continue;
        }
        // Several attachments of the step can show layers of one texture; a row says so once.
        let known = row.placement == Placement::Memoryless;
        let need = match row.placement {
            Placement::Own => Some(MemoryNeed::LoadedOrStored),
            Placement::Memoryless => None,
            _ => need(graph, caps, options, attachment, row.usage),
        };
        let reason = need.map_or(Reason::Memoryless(row.first), Reason::NeedsMemory);
        if need.is_none() {
            row.placement = Placement::Memoryless;
            // Also of a plane that no pass touches, there is nothing to keep.
            (attachment.store, attachment.stencil_store) = (StoreOp::Discard, StoreOp::Discard);
        }
        if !known {
            decisions.push(Decision { subject: Subject::Resource(attachment.resource), reason });
        }
    }
}

/// What keeps an attachment of one step in memory, if anything.
fn need(graph: &Tables, caps: &Caps, options: &Options, attachment: &Attachment, usage: Usage) -> Option<MemoryNeed> {
    let texture = graph.resources[attachment.resource.index()].desc.texture()?;
    if !caps.memoryless || !options.memoryless {
        Some(MemoryNeed::Unsupported)
    } else if attachment.role.is_resolve() {
        Some(MemoryNeed::ResolveTarget)
    } else if texture.mips != 1 || texture.layers != 1 && !caps.memoryless_layers || texture.dimension != Dimension::D2
    {
        Some(MemoryNeed::SeveralParts)
    } else if !usage.without(Usage::ATTACHMENT).without(Usage::INPUT_ATTACHMENT).is_empty() {
        // Another layer of it is written as storage, say.
        Some(MemoryNeed::OtherUse)
    } else {
        // What lives in one step finds nothing in memory and leaves nothing there for a later one.
        None
    }
}
