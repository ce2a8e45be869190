//! Subpasses of a step: the attachments that each pass of a render pass uses, and in which layouts.
//!
//! A step is one `VkRenderPass`. Consecutive passes with the same attachments share a subpass. A pass that reads an
//! attachment at the same pixel begins a subpass, in which the attachment is an input attachment.

use framegraph::{
    Access, AccessKind, Aspect, Attachment, Format, Join, Plan, ResolveMode, ResourceId, Role, StepId, StepPass,
};

/// Use of one attachment in a subpass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Reference {
    /// Index of the step's attachment.
    pub(crate) attachment: u32,
    /// Way in which each plane is used: color or depth, then stencil.
    pub(crate) planes: [PlaneUse; 2],
    /// Planes that an input attachment reads.
    pub(crate) aspect: Aspect,
}

/// Use of one plane of an attachment in a subpass; determines its layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlaneUse {
    /// The layout of the step.
    Step,
    /// Read as an input attachment, not written.
    Input,
    /// Read as an input attachment and written by the same pass.
    Feedback,
}

/// One subpass.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Subpass {
    /// Color attachments by slot.
    pub(crate) colors: Vec<Option<Reference>>,
    /// Targets of color resolves by slot; empty if there is none.
    pub(crate) resolves: Vec<Option<Reference>>,
    pub(crate) depth: Option<Reference>,
    pub(crate) resolved_depth: Option<(Reference, ResolveMode)>,
    /// Input attachments, in the order of the pass's accesses.
    pub(crate) inputs: Vec<Reference>,
    /// Attachments that later subpasses use and this one does not.
    pub(crate) preserve: Vec<u32>,
}

/// Returns the subpasses of a step, and the subpass of each of its passes.
pub(crate) fn subpasses(plan: &Plan, step: StepId) -> (Vec<Subpass>, Vec<u32>) {
    let members = plan.passes_of(step);
    let mut found: Vec<Subpass> = Vec::new();
    let mut of = Vec::new();
    for (at, member) in members.iter().enumerate() {
        if member.join != Join::Inlined {
            let own = match member.join {
                Join::Resolve => resolving(plan, step),
                _ => subpass(plan, step, members, at),
            };
            let same = found.last().is_some_and(|last| *last == own && own.inputs.is_empty());
            if !same {
                found.push(own);
            }
        }
        of.push(found.len().saturating_sub(1) as u32);
    }
    if found.is_empty() {
        found.push(Subpass::default());
    }
    for at in 0..found.len() {
        let attachments = 0..plan.attachments_of(step).len() as u32;
        let used = |subpass: &Subpass, index: u32| subpass.uses(index);
        let unused = |index: &u32| {
            let (before, after) = (&found[..at], &found[at + 1..]);
            !used(&found[at], *index) && before.iter().any(|s| used(s, *index)) && after.iter().any(|s| used(s, *index))
        };
        found[at].preserve = attachments.filter(unused).collect();
    }
    (found, of)
}

impl Subpass {
    /// Returns the references to attachments.
    fn references(&self) -> impl Iterator<Item = &Reference> {
        let resolved = self.resolved_depth.iter().map(|(reference, _)| reference);
        let colors = self.colors.iter().chain(&self.resolves).flatten();
        colors.chain(&self.depth).chain(resolved).chain(&self.inputs)
    }

    /// Returns `true` if the subpass uses an attachment.
    pub(crate) fn uses(&self, attachment: u32) -> bool {
        self.references().any(|reference| reference.attachment == attachment)
    }

    /// Returns `true` if a pass of the subpass reads what it also writes.
    pub(crate) fn has_feedback(&self) -> bool {
        self.references().any(|reference| reference.planes.contains(&PlaneUse::Feedback))
    }
}

/// Returns the subpass of a full-screen resolve: every attachment in its role.
fn resolving(plan: &Plan, step: StepId) -> Subpass {
    let mut subpass = Subpass::default();
    for (attachment, row) in (0..).zip(plan.attachments_of(step)) {
        let reference = Reference { attachment, planes: [PlaneUse::Step; 2], aspect: Aspect::All };
        match row.role {
            Role::Color(slot) | Role::ResolveTarget(slot, _) => put(&mut subpass.colors, slot, reference),
            Role::Depth | Role::DepthReadOnly | Role::ResolveDepth(_) => subpass.depth = Some(reference),
        }
    }
    subpass
}

fn subpass(plan: &Plan, step: StepId, members: &[StepPass], at: usize) -> Subpass {
    let graph = plan.graph();
    let own = graph.accesses_of(members[at].pass);
    let mut subpass = Subpass::default();
    let inputs: Vec<&Access> = own.iter().filter(|access| is_in_tile(plan, members, at, access)).collect();
    // Planes that the pass reads as input attachments, and those of them that it writes.
    let planes = |attachment: &Attachment| {
        let format = plan.format(attachment.resource).unwrap_or(Format::R8Unorm);
        let of = |number: u32| {
            let on = |access: &&Access| {
                shows(attachment, access) && access.range.aspect.selects_plane(format, number.min(format.planes() - 1))
            };
            let written = own.iter().filter(|a| a.kind.is_attachment() && a.mode.writes()).any(|a| on(&a));
            match (inputs.iter().any(on), written) {
                (false, _) => PlaneUse::Step,
                (true, false) => PlaneUse::Input,
                (true, true) => PlaneUse::Feedback,
            }
        };
        [of(0), of(1)]
    };
    let reference = |access: &Access| {
        let mut rows = (0..).zip(plan.attachments_of(step));
        let (attachment, row) = rows.find(|(_, row)| shows(row, access))?;
        // Resolves whose result is not needed are not performed.
        let needed = !row.role.is_resolve() || row.stores();
        needed.then(|| Reference { attachment, planes: planes(row), aspect: Aspect::All })
    };
    for access in own {
        match access.kind {
            AccessKind::Color => {
                if let Some(found) = reference(access) {
                    put(&mut subpass.colors, access.slot, found);
                }
            }
            AccessKind::Depth | AccessKind::DepthReadOnly => subpass.depth = subpass.depth.or(reference(access)),
            AccessKind::Resolve if access.slot == Access::DEPTH => {
                subpass.resolved_depth = reference(access).map(|found| (found, access.resolve));
            }
            AccessKind::Resolve => {
                if let Some(found) = reference(access) {
                    put(&mut subpass.resolves, access.slot, found);
                }
            }
            _ => {}
        }
    }
    subpass.inputs.extend(
        inputs.iter().filter_map(|access| Some(Reference { aspect: access.range.aspect, ..reference(access)? })),
    );
    if !subpass.resolves.is_empty() {
        subpass.resolves.resize(subpass.colors.len(), None);
    }
    subpass
}

fn put(rows: &mut Vec<Option<Reference>>, slot: u8, reference: Reference) {
    let slot = usize::from(slot);
    if rows.len() <= slot {
        rows.resize(slot + 1, None);
    }
    rows[slot] = Some(reference);
}

/// Returns `true` if the access refers to the subresource of the attachment.
fn shows(attachment: &Attachment, access: &Access) -> bool {
    attachment.resource == access.resource
        && attachment.mip == access.range.mip
        && attachment.layer == access.range.layer
}

/// Returns `true` if a same-pixel read of the pass at `at` stays in the tile. The pass must have joined because of
/// same-pixel reads, and earlier passes of the step must have attached every plane that it reads.
pub(crate) fn is_in_tile(plan: &Plan, members: &[StepPass], at: usize, access: &Access) -> bool {
    let graph = plan.graph();
    let format = |id: ResourceId| plan.format(id).unwrap_or(Format::R8Unorm);
    let attached = |number: u32| {
        let mut earlier = members[..at].iter().flat_map(|member| graph.accesses_of(member.pass));
        earlier.any(|a| {
            let same =
                (a.resource, a.range.mip, a.range.layer) == (access.resource, access.range.mip, access.range.layer);
            let attaches = a.kind.is_attachment() && a.kind != AccessKind::Resolve;
            same && attaches && a.range.aspect.selects_plane(format(a.resource), number)
        })
    };
    let planes = 0..format(access.resource).planes();
    let mut read = planes.filter(|number| access.range.aspect.selects_plane(format(access.resource), *number));
    access.kind == AccessKind::SamePixel && members[at].join == Join::SamePixel && read.all(attached)
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::{Caps, Extent, Graph, Intent, Options, Scratch, TextureDesc, compile};

    #[test]
    fn same_pixel_reads_begin_a_subpass_with_an_input_attachment() -> Result<(), Box<dyn std::error::Error>> {
        let mut graph = Graph::new();
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
        let [hdr, ldr] = ["hdr", "ldr"].map(|name| graph.texture(name, desc));
        let hdr = graph.add_fn("scene", |p| p.color(hdr, Intent::Overwrite))?;
        let hdr = graph.add_fn("sky", |p| p.color(hdr, Intent::Modify))?;
        let ldr = graph.add_fn("grade", |p| {
            p.same_pixel(hdr)?;
            p.color(ldr, Intent::Overwrite)
        })?;
        graph.export(ldr)?;
        let (caps, mut plan) = (Caps { inline: false, ..Caps::tiler() }, Plan::new());
        compile(&graph, &caps, &Options::for_frame(8, 8), &mut Scratch::new(), &mut plan)?;
        assert_eq!(plan.steps().len(), 1);
        let (subpasses, of) = subpasses(&plan, StepId::at(0));
        assert_eq!(of, [0, 0, 1], "the sky is drawn in the subpass of the scene");
        assert_eq!(subpasses[1].inputs.len(), 1);
        assert_eq!(subpasses[1].inputs[0].planes[0], PlaneUse::Input);
        assert_eq!(subpasses[1].colors.len(), 1);
        assert!(!subpasses[1].has_feedback());
        Ok(())
    }
}
