//! Clears of resources that are no attachments: storage and targets of copies that a pass declares as cleared, and new
//! images of histories.

use crate::convert::{clear_value, planes};
use crate::driver::{ImageBarrier, Scope, Thing};
use crate::error::Error;
use crate::layouts::parts;
use crate::run::Run;
use crate::shape::{Part, clears};
use ash::vk;
use framegraph::{Access, StepId};

impl Run<'_> {
    /// Clears what the passes of a step declare as cleared, except for attachments, which load operations clear.
    pub(crate) fn clear_resources(&mut self, lane: usize, step: StepId) -> Result<(), Error> {
        let plan = &self.prepared.plan;
        let members = plan.passes_of(step).iter();
        let all = members.flat_map(|member| plan.graph().accesses_of(member.pass)).copied();
        let cleared: Vec<Access> = all.filter(clears).collect();
        if cleared.is_empty() {
            return Ok(());
        }
        // The plan's barriers end at the stages of the pass, not at those of clears.
        self.lanes.commands(self.gpu, self.slot, lane)?;
        self.lanes.rows[lane].pending.memory.push(Scope::ALL);
        let commands = self.lanes.commands(self.gpu, self.slot, lane)?;
        for access in cleared {
            let (Some(thing), plan) = (self.thing(access.resource), &self.prepared.plan) else { continue };
            let driver = &self.gpu.shared.driver;
            match thing {
                Thing::Buffer(buffer) => {
                    let whole = plan.graph().resources()[access.resource.index()].desc.bytes(plan.frame());
                    let part = plan.graph().bytes_of(&access).map_or((0, whole), |part| (part.offset, part.bytes));
                    driver.fill_buffer(commands, buffer, part);
                }
                Thing::Image(image) => {
                    let desc = plan.graph().resources()[access.resource.index()].desc;
                    let Some(desc) = desc.texture() else { continue };
                    let (mips, layers) = (
                        access.range.mip_range(desc.mip_count(plan.frame())),
                        access.range.layer_range(desc.tracked_layers()),
                    );
                    let format = plan.format(access.resource).unwrap_or(desc.format);
                    let range = vk::ImageSubresourceRange {
                        aspect_mask: planes(format, access.range.aspect),
                        base_mip_level: mips.start,
                        level_count: mips.len() as u32,
                        base_array_layer: layers.start,
                        layer_count: layers.len() as u32,
                    };
                    let plane = u32::from(!access.range.aspect.selects_plane(format, 0));
                    let first = Part { mip: mips.start, layer: layers.start, plane };
                    let layout = self.layouts.get(thing, first.index(desc, plan.frame()));
                    let value = plan.graph().clears().get(access.clear as usize).copied();
                    driver.clear_image(commands, image, layout, range, clear_value(value, format));
                }
            }
        }
        self.lanes.rows[lane].pending.memory.push(Scope::ALL);
        self.lanes.commands(self.gpu, self.slot, lane).map(drop)
    }

    /// Clears the images of a new history to zero.
    pub(crate) fn clear_ring(&mut self, at: usize) -> Result<(), Error> {
        let ring = &mut self.prepared.resources.rings[at];
        let Some(desc) = ring.shape.desc.texture().copied() else { return Ok(()) };
        if !std::mem::replace(&mut ring.fresh, false) {
            return Ok(());
        }
        let (things, frame) = (ring.things.clone(), ring.shape.frame);
        let range = vk::ImageSubresourceRange {
            aspect_mask: planes(desc.format, framegraph::Aspect::All),
            level_count: desc.mip_count(frame),
            layer_count: desc.tracked_layers(),
            ..Default::default()
        };
        let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let scope = Scope {
            from: vk::PipelineStageFlags2::ALL_COMMANDS,
            to: vk::PipelineStageFlags2::ALL_TRANSFER,
            to_access: vk::AccessFlags2::TRANSFER_WRITE,
            ..Scope::default()
        };
        for thing in &things {
            let Thing::Image(image) = *thing else { continue };
            let layouts = [vk::ImageLayout::UNDEFINED, target];
            self.lanes.rows[0].pending.images.push(ImageBarrier { scope, image, range, layouts });
            for part in 0..parts(&desc, frame, desc.format) {
                self.layouts.set(*thing, part, target);
            }
        }
        let commands = self.lanes.commands(self.gpu, self.slot, 0)?;
        for thing in &things {
            if let Thing::Image(image) = *thing {
                let zero = vk::ClearValue::default();
                self.gpu.shared.driver.clear_image(commands, image, target, range, zero);
            }
        }
        // Clears are submitted apart: validation layers of 2023 miss that a barrier after the next one waits for them.
        self.lanes.submit(self.gpu, self.slot, 0, &[], &[])?;
        self.lanes.rows[0].pending.memory.push(Scope::ALL);
        self.lanes.commands(self.gpu, self.slot, 0).map(drop)
    }
}
