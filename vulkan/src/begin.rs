//! Beginning of steps: framebuffers, clear values, render passes, labels and timestamps.

use crate::convert::clear_value;
use crate::driver::Thing;
use crate::error::Error;
use crate::render_pass::{StepLayouts, multiview_mask, render_pass};
use crate::run::{Run, until_the_end};
use crate::shape::Part;
use crate::views::Viewed;
use ash::vk;
use framegraph::{Attachment, ClearValue, Format, LoadOp, PassKind, Plan, Range, ResourceId, StepId, StoreOp};

impl Run<'_> {
    /// Begins a step on a queue.
    pub(crate) fn begin(&mut self, lane: usize, step: StepId) -> Result<(), Error> {
        self.clear_resources(lane, step)?;
        let commands = self.lanes.commands(self.gpu, self.slot, lane)?;
        self.open[lane] = Some((step, 0));
        self.executed.steps += 1;
        let driver = &self.gpu.shared.driver;
        driver.begin_label(commands, &step_name(&self.prepared.plan, step));
        if let Some((pool, ..)) = self.slot.queries {
            let first = 2 * step.index() as u32;
            driver.reset_timestamps(commands, pool, first, 2);
            driver.timestamp(commands, pool, first);
        }
        if self.prepared.plan.steps()[step.index()].kind == PassKind::Raster {
            self.begin_render_pass(commands, step)?;
        }
        Ok(())
    }

    fn begin_render_pass(&mut self, commands: vk::CommandBuffer, step: StepId) -> Result<(), Error> {
        let plan = &self.prepared.plan;
        let row = plan.steps()[step.index()];
        let (mut views, mut layouts, mut clears, mut imported) = (Vec::new(), Vec::new(), Vec::new(), false);
        for attachment in plan.attachments_of(step) {
            let id = attachment.resource;
            let import = self.imports.rows.get(&id).map(|row| row.thing);
            let thing = import.or_else(|| self.prepared.resources.of(id));
            let Some(Thing::Image(image)) = thing else { return Err(Error::NotPrepared) };
            let viewed = Viewed { image, resource: id, imported: import.is_some() };
            imported |= import.is_some();
            views.push(self.views.attached(&self.gpu.shared.driver, plan, viewed, &range_of(attachment))?);
            layouts.push(self.step_layouts(plan, id, attachment, Thing::Image(image)));
            clears.push(clear(plan, attachment));
        }
        let prepared = &mut self.prepared.steps[step.index()];
        let pass = match prepared.render_pass {
            Some(pass) => pass,
            None => {
                let made = render_pass(self.gpu, plan, step, &prepared.subpasses, &layouts, self.multiview)?;
                prepared.render_pass = Some(made);
                made
            }
        };
        let [width, height] = row.extent.map(|side| side.max(1));
        let key = (step, views);
        let framebuffer = match self.prepared.framebuffers.get(&key) {
            Some(known) => *known,
            None => {
                let layers = if self.multiview && multiview_mask(plan, step) != 0 { 1 } else { row.layers.max(1) };
                let info = vk::FramebufferCreateInfo::default()
                    .render_pass(pass)
                    .attachments(&key.1)
                    .width(width)
                    .height(height)
                    .layers(layers);
                let made = self.gpu.shared.driver.framebuffer(&info)?;
                if imported {
                    until_the_end(self.slot, made);
                } else {
                    self.prepared.framebuffers.insert(key, made);
                }
                made
            }
        };
        let area = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(pass)
            .framebuffer(framebuffer)
            .render_area(area)
            .clear_values(&clears);
        self.gpu.shared.driver.begin_render_pass(commands, &info);
        self.gpu.shared.driver.viewport(commands, [width, height]);
        self.count(step);
        Ok(())
    }

    /// Returns the layouts of an attachment: color or depth, then stencil.
    fn step_layouts(&self, plan: &Plan, id: ResourceId, attachment: &Attachment, thing: Thing) -> StepLayouts {
        let desc = plan.graph().resources()[id.index()].desc;
        let Some(desc) = desc.texture() else { return StepLayouts::default() };
        let planes = plan.format(id).unwrap_or(desc.format).planes();
        let of = |plane: u32| {
            let part = Part { mip: attachment.mip.into(), layer: attachment.layer.into(), plane };
            self.layouts.get(thing, part.index(desc, plan.frame()))
        };
        [of(0), of(planes - 1)]
    }

    /// Counts the operations of a render pass as they were given to Vulkan.
    fn count(&mut self, step: StepId) {
        let plan = &self.prepared.plan;
        let subpasses = &self.prepared.steps[step.index()].subpasses;
        self.executed.render_passes += 1;
        for (index, row) in (0..).zip(plan.attachments_of(step)) {
            let resolve = row.role.is_resolve();
            if resolve && !subpasses.iter().any(|subpass| subpass.uses(index)) {
                continue;
            }
            let loads = |op| row.load == op || row.stencil_load == op;
            let stores = |op| row.store == op || row.stencil_store == op;
            let counts = &mut self.executed;
            counts.unresolves += u32::from(loads(LoadOp::Load));
            counts.clears += u32::from(loads(LoadOp::Clear));
            counts.resolves += u32::from(stores(StoreOp::Store));
            counts.discards += u32::from(stores(StoreOp::Discard) && !stores(StoreOp::Store));
            counts.multisample_resolves += u32::from(resolve);
        }
    }
}

fn step_name(plan: &Plan, step: StepId) -> String {
    let passes = plan.passes_of(step).iter();
    let names: Vec<_> = passes.map(|member| plan.graph().pass_name(member.pass)).collect();
    names.join(" + ")
}

fn range_of(attachment: &Attachment) -> Range {
    Range {
        mip: attachment.mip,
        mips: 1,
        layer: attachment.layer,
        layers: attachment.layers,
        view: attachment.view,
        ..Range::ALL
    }
}

fn clear(plan: &Plan, attachment: &Attachment) -> vk::ClearValue {
    let value: Option<ClearValue> = match attachment.clear {
        Attachment::ZERO => None,
        index => plan.graph().clears().get(index as usize).copied(),
    };
    clear_value(value, plan.format(attachment.resource).unwrap_or(Format::R8Unorm))
}
