//! Render passes of steps.

use crate::convert::{load, planes, resolve_mode, store, vk_format};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::subpass::{PlaneUse, Reference, Subpass};
use ash::vk;
use framegraph::{Aspect, Format, LoadOp, Plan, StepId, StoreOp};

/// Layouts of an attachment in its step: color or depth, then stencil.
pub(crate) type StepLayouts = [vk::ImageLayout; 2];

/// Stages and accesses of attachments.
const STAGES: vk::PipelineStageFlags = vk::PipelineStageFlags::from_raw(
    vk::PipelineStageFlags::FRAGMENT_SHADER.as_raw()
        | vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT.as_raw()
        | vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS.as_raw()
        | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS.as_raw(),
);
const WRITES: vk::AccessFlags = vk::AccessFlags::from_raw(
    vk::AccessFlags::COLOR_ATTACHMENT_WRITE.as_raw() | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
);
const USES: vk::AccessFlags = vk::AccessFlags::from_raw(
    WRITES.as_raw()
        | vk::AccessFlags::INPUT_ATTACHMENT_READ.as_raw()
        | vk::AccessFlags::COLOR_ATTACHMENT_READ.as_raw()
        | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ.as_raw(),
);

/// Returns `true` for layouts of planes that the step does not write. The plan has planes without a use in them.
fn is_read_only(layout: vk::ImageLayout) -> bool {
    let depth = [vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL, vk::ImageLayout::DEPTH_READ_ONLY_OPTIMAL];
    depth.contains(&layout) || layout == vk::ImageLayout::STENCIL_READ_ONLY_OPTIMAL
}

/// Returns the load operation of a plane. `DONT_CARE` would write a plane without a use.
fn load_op(op: LoadOp, layout: vk::ImageLayout) -> vk::AttachmentLoadOp {
    load(if op == LoadOp::DontCare && is_read_only(layout) { LoadOp::Load } else { op })
}

/// Returns the store operation of a plane. `DONT_CARE` would write a plane without a use.
fn store_op(op: StoreOp, layout: vk::ImageLayout, has_none: bool) -> vk::AttachmentStoreOp {
    store(if op == StoreOp::Discard && is_read_only(layout) { StoreOp::None } else { op }, has_none)
}

/// Returns the layout of a plane in a subpass.
fn layout(format: Format, number: usize, usage: PlaneUse, step: vk::ImageLayout) -> vk::ImageLayout {
    match usage {
        PlaneUse::Step => step,
        PlaneUse::Feedback => vk::ImageLayout::GENERAL,
        PlaneUse::Input if !format.is_depth_stencil() => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        PlaneUse::Input if format.planes() == 1 => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        PlaneUse::Input if number == 0 => vk::ImageLayout::DEPTH_READ_ONLY_OPTIMAL,
        PlaneUse::Input => vk::ImageLayout::STENCIL_READ_ONLY_OPTIMAL,
    }
}

/// Returns the layout in which a pass reads an input attachment.
pub(crate) fn input_layout(format: Format, reference: &Reference) -> vk::ImageLayout {
    let number = usize::from(reference.aspect == Aspect::Stencil && format.planes() > 1);
    layout(format, number, reference.planes[number], vk::ImageLayout::UNDEFINED)
}

/// Number and format of the planes of an attachment.
fn format_of(plan: &Plan, step: StepId, attachment: u32) -> Format {
    let row = &plan.attachments_of(step)[attachment as usize];
    plan.format(row.resource).unwrap_or(Format::R8Unorm)
}

/// Creates the render pass of a step. Attachments have the given layouts before and after it.
pub(crate) fn render_pass(
    gpu: &Gpu,
    plan: &Plan,
    step: StepId,
    subpasses: &[Subpass],
    layouts: &[StepLayouts],
    multiview: bool,
) -> Result<vk::RenderPass, Error> {
    let has_none = gpu.shared.features.store_op_none;
    let attachments = plan.attachments_of(step);
    let mut stencils: Vec<_> = layouts
        .iter()
        .map(|[_, stencil]| {
            vk::AttachmentDescriptionStencilLayout::default()
                .stencil_initial_layout(*stencil)
                .stencil_final_layout(*stencil)
        })
        .collect();
    let mut rows = Vec::new();
    for ((row, layouts), stencil) in attachments.iter().zip(layouts).zip(&mut stencils) {
        let format = plan.format(row.resource).unwrap_or(Format::R8Unorm);
        let desc = plan.graph().resources()[row.resource.index()].desc;
        let samples = desc.texture().map_or(1, |desc| desc.samples);
        let description = vk::AttachmentDescription2::default()
            .format(vk_format(row.view.unwrap_or(format)))
            .samples(vk::SampleCountFlags::from_raw(samples.into()))
            .load_op(load_op(row.load, layouts[0]))
            .store_op(store_op(row.store, layouts[0], has_none))
            .stencil_load_op(load_op(row.stencil_load, layouts[1]))
            .stencil_store_op(store_op(row.stencil_store, layouts[1], has_none))
            .initial_layout(layouts[0])
            .final_layout(layouts[0]);
        rows.push(if format.planes() > 1 { description.push_next(stencil) } else { description });
    }
    let mut lists: Vec<ReferenceLists> =
        subpasses.iter().map(|s| ReferenceLists::new(s, |a| format_of(plan, step, a), layouts)).collect();
    let mut resolves: Vec<_> = subpasses.iter().map(depth_resolve).collect();
    let references: Vec<Vec<vk::AttachmentReference2<'_>>> = lists.iter_mut().map(ReferenceLists::all).collect();
    let mask = if multiview { multiview_mask(plan, step) } else { 0 };
    let mut descriptions = Vec::new();
    for ((subpass, all), resolve) in subpasses.iter().zip(&references).zip(&mut resolves) {
        let (colors, rest) = all.split_at(subpass.colors.len());
        let (targets, rest) = rest.split_at(subpass.resolves.len());
        let (inputs, rest) = rest.split_at(subpass.inputs.len());
        let mut row = vk::SubpassDescription2::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .view_mask(mask)
            .color_attachments(colors)
            .input_attachments(inputs)
            .preserve_attachments(&subpass.preserve);
        if !targets.is_empty() {
            row = row.resolve_attachments(targets);
        }
        let mut rest = rest.iter();
        if subpass.depth.is_some()
            && let Some(depth) = rest.next()
        {
            row = row.depth_stencil_attachment(depth);
        }
        if let (Some(resolve), Some(target)) = (resolve.as_mut(), rest.next()) {
            resolve.p_depth_stencil_resolve_attachment = target;
            row = row.push_next(resolve);
        }
        descriptions.push(row);
    }
    let dependencies = dependencies(subpasses, mask != 0);
    let info =
        vk::RenderPassCreateInfo2::default().attachments(&rows).subpasses(&descriptions).dependencies(&dependencies);
    gpu.shared.driver.render_pass(&info)
}

/// Returns the mask of the views of a step with several layers.
pub(crate) fn multiview_mask(plan: &Plan, step: StepId) -> u32 {
    match plan.steps()[step.index()].layers {
        0 | 1 => 0,
        layers => u32::MAX >> (32 - layers.min(32)),
    }
}

/// References of a subpass in one list: colors, resolves, inputs, depth, resolved depth.
struct ReferenceLists {
    rows: Vec<Option<(u32, StepLayouts, vk::ImageAspectFlags, bool)>>,
    stencils: Vec<vk::AttachmentReferenceStencilLayout<'static>>,
}

impl ReferenceLists {
    fn new(subpass: &Subpass, format: impl Fn(u32) -> Format, layouts: &[StepLayouts]) -> Self {
        let resolved = subpass.resolved_depth.map(|(reference, _)| reference);
        let own = |reference: &Reference| {
            let (format, step) = (format(reference.attachment), layouts[reference.attachment as usize]);
            let of = |number: usize| layout(format, number, reference.planes[number], step[number]);
            let aspect = planes(format, reference.aspect);
            (reference.attachment, [of(0), of(1)], aspect, format.planes() > 1)
        };
        let lists = subpass.colors.iter().chain(&subpass.resolves).map(|row| row.as_ref().map(own));
        let others = subpass.inputs.iter().chain(&subpass.depth).chain(&resolved).map(|row| Some(own(row)));
        let rows: Vec<_> = lists.chain(others).collect();
        let stencil = |row: &Option<(u32, StepLayouts, vk::ImageAspectFlags, bool)>| {
            let layout = row.map_or(vk::ImageLayout::UNDEFINED, |(_, layouts, ..)| layouts[1]);
            vk::AttachmentReferenceStencilLayout::default().stencil_layout(layout)
        };
        let stencils = rows.iter().map(stencil).collect();
        Self { rows, stencils }
    }

    fn all(&mut self) -> Vec<vk::AttachmentReference2<'_>> {
        let one = |(row, stencil): (&Option<(u32, StepLayouts, vk::ImageAspectFlags, bool)>, _)| match row {
            None => vk::AttachmentReference2::default().attachment(vk::ATTACHMENT_UNUSED),
            Some((attachment, layouts, aspect, two)) => {
                let row =
                    vk::AttachmentReference2::default().attachment(*attachment).layout(layouts[0]).aspect_mask(*aspect);
                if *two { row.push_next(stencil) } else { row }
            }
        };
        self.rows.iter().zip(&mut self.stencils).map(one).collect()
    }
}

fn depth_resolve(subpass: &Subpass) -> Option<vk::SubpassDescriptionDepthStencilResolve<'static>> {
    let (_, mode) = subpass.resolved_depth?;
    let row = vk::SubpassDescriptionDepthStencilResolve::default();
    Some(row.depth_resolve_mode(resolve_mode(mode)).stencil_resolve_mode(vk::ResolveModeFlags::NONE))
}

/// Returns the dependencies between subpasses that share an attachment, and around a step whose subpasses change
/// layouts.
fn dependencies(subpasses: &[Subpass], multiview: bool) -> Vec<vk::SubpassDependency2<'static>> {
    let between = |from: u32, to: u32, flags: vk::DependencyFlags| {
        vk::SubpassDependency2::default()
            .src_subpass(from)
            .dst_subpass(to)
            .src_stage_mask(STAGES)
            .dst_stage_mask(STAGES)
            .src_access_mask(WRITES)
            .dst_access_mask(USES)
            .dependency_flags(flags)
    };
    let local = if multiview { vk::DependencyFlags::VIEW_LOCAL } else { vk::DependencyFlags::empty() };
    let region = vk::DependencyFlags::BY_REGION | local;
    let mut rows = Vec::new();
    let count = subpasses.len() as u32;
    for to in 0..count {
        for from in 0..to {
            let (a, b) = (&subpasses[from as usize], &subpasses[to as usize]);
            // Subpasses follow each other even if they share no attachment, as their passes do in the graph.
            if from + 1 == to || (0..32).any(|index| a.uses(index) && b.uses(index)) {
                rows.push(between(from, to, region));
            }
        }
        if subpasses[to as usize].has_feedback() {
            rows.push(between(to, to, region));
        }
    }
    if count > 1 || subpasses.iter().any(Subpass::has_feedback) {
        let none = vk::DependencyFlags::empty();
        rows.push(between(vk::SUBPASS_EXTERNAL, 0, none));
        rows.extend((1..count).map(|to| between(vk::SUBPASS_EXTERNAL, to, none)));
        rows.extend((0..count).map(|from| between(from, vk::SUBPASS_EXTERNAL, none)));
    }
    rows
}
