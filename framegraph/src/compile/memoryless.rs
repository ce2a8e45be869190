//! Phase 6, last part: attachments that never leave the tile need no memory.

use crate::access::Usage;
use crate::caps::Caps;
use crate::decision::{Decision, MemoryNeed, Reason, Subject};
use crate::graph::Tables;
use crate::options::{Alias, Options};
use crate::plan::{Attachment, Placement, Planned, StoreOp};
use crate::resource::{Dimension, Kind};

/// Marks memoryless resources. Logs for every attachment that is used in one step only why it is or is not memoryless.
#[inline(never)]
pub(crate) fn memoryless(
    graph: &Tables,
    caps: &Caps,
    options: &Options,
    attachments: &mut [Attachment],
    resources: &mut [Planned],
    decisions: &mut Vec<Decision>,
) {
    // Equal lengths, so that one bounds check serves both arrays.
    let resources = &mut resources[..graph.resources.len()];
    for attachment in attachments {
        let row = &mut resources[attachment.resource.index()];
        // The step that attaches the resource is its only step.
        let one_step = row.first == row.last;
        if !one_step || graph.resources[attachment.resource.index()].kind != Kind::Transient {
            continue;
        }
        // Several attachments can be layers of one texture; log the texture once.
        let known = row.placement == Placement::Memoryless;
        let need = match row.placement {
            Placement::Own => Some(MemoryNeed::LoadedOrStored),
            Placement::Memoryless => None,
            _ => need(graph, caps, options, attachment, row),
        };
        let reason = need.map_or(Reason::Memoryless(row.first), Reason::NeedsMemory);
        if need.is_none() {
            row.placement = Placement::Memoryless;
            // This includes planes that no pass uses.
            (attachment.store, attachment.stencil_store) = (StoreOp::Discard, StoreOp::Discard);
        }
        if !known {
            decisions.push(Decision { subject: Subject::Resource(attachment.resource), reason });
        }
    }
}

/// Returns the reason why an attachment of a single step needs memory, if any.
fn need(graph: &Tables, caps: &Caps, options: &Options, attachment: &Attachment, row: &Planned) -> Option<MemoryNeed> {
    let texture = graph.resources[attachment.resource.index()].desc.texture()?;
    if !caps.memoryless || !options.memoryless {
        Some(MemoryNeed::Unsupported)
    } else if attachment.role.is_resolve() {
        Some(MemoryNeed::ResolveTarget)
    } else if texture.mips != 1 || texture.layers != 1 && !caps.memoryless_layers || texture.dimension != Dimension::D2
    {
        Some(MemoryNeed::SeveralParts)
    } else if row.srgb_views && !caps.memoryless_views {
        Some(MemoryNeed::View)
    } else if !row.usage.without(Usage::ATTACHMENT).without(Usage::INPUT_ATTACHMENT).is_empty() {
        // For example, another layer of it is written as storage.
        Some(MemoryNeed::OtherUse)
    } else if !caps.memoryless_saves && caps.placed && options.alias == Alias::Heap {
        Some(MemoryNeed::NotSaved)
    } else {
        // The resource has no contents before or after its step.
        None
    }
}
