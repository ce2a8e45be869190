//! Phase 6, last part: attachments that never leave the tile take no memory.

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
    for at in 0..attachments.len() {
        let attachment = &attachments[at];
        let row = &mut resources[attachment.resource.index()];
        let resource = attachment.resource;
        // The step that attaches it is one that touches it, so this is that step.
        let one_step = row.first == row.last;
        if !one_step || graph.resources[attachment.resource.index()].kind != Kind::Transient {
            continue;
        }
        let need = match row.placement {
            Placement::Own => Some(MemoryNeed::LoadedOrStored),
            // Another attachment of the step shows other layers of it, and its row says so.
            Placement::Memoryless => {
                drop_all(&mut attachments[at]);
                continue;
            }
            _ => need(graph, caps, options, attachments, attachment),
        };
        let reason = match need {
            Some(need) => Reason::NeedsMemory(need),
            None => {
                row.placement = Placement::Memoryless;
                drop_all(&mut attachments[at]);
                Reason::Memoryless(row.first)
            }
        };
        decisions.push(Decision { subject: Subject::Resource(resource), reason });
    }
}

/// Also of a plane that no pass touches, there is nothing to keep.
fn drop_all(attachment: &mut Attachment) {
    (attachment.store, attachment.stencil_store) = (StoreOp::Discard, StoreOp::Discard);
}

/// What keeps an attachment of one step in memory, if anything.
fn need(
    graph: &Tables,
    caps: &Caps,
    options: &Options,
    attachments: &[Attachment],
    attachment: &Attachment,
) -> Option<MemoryNeed> {
    let texture = graph.resources[attachment.resource.index()].desc.texture()?;
    if !caps.memoryless || !options.memoryless {
        Some(MemoryNeed::Unsupported)
    } else if matches!(attachment.role, Role::Resolve(_)) {
        Some(MemoryNeed::ResolveTarget)
    } else if texture.mips != 1 || texture.layers != 1 && !caps.memoryless_layers || texture.dimension != Dimension::D2
    {
        Some(MemoryNeed::SeveralParts)
    } else if texture.layers == 1 {
        leaves_tile(attachment).then_some(MemoryNeed::LoadedOrStored)
    } else {
        // Its layers can be several attachments.
        let of_texture = |a: &&Attachment| a.resource == attachment.resource;
        attachments.iter().filter(of_texture).any(leaves_tile).then_some(MemoryNeed::LoadedOrStored)
    }
}

/// Whether a plane of the attachment is loaded, or neither discarded nor left alone by all passes of the step.
fn leaves_tile(attachment: &Attachment) -> bool {
    let planes = [(attachment.load, attachment.store), (attachment.stencil_load, attachment.stencil_store)];
    let untouched = (LoadOp::DontCare, StoreOp::None);
    planes.iter().any(|ops| ops.0 == LoadOp::Load || ops.1 != StoreOp::Discard && *ops != untouched)
}
