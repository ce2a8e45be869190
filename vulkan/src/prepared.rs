//! Everything that is computed or created once for a plan.

use crate::driver::{Driver, Object};
use crate::error::Error;
use crate::gpu::{DeviceQueue, Gpu};
use crate::limits::{check_caps, check_views};
use crate::owners::check_owners;
use crate::resources::{Resources, Ring};
use crate::subpass::{Subpass, subpasses};
use ash::vk;
use framegraph::{Plan, StepId};
use framegraph_queues::{Command, Schedule};
use std::collections::BTreeMap;

/// A plan with its commands and objects.
pub(crate) struct Prepared {
    pub(crate) plan: Plan,
    pub(crate) commands: Vec<Command>,
    pub(crate) schedule: Option<Schedule>,
    pub(crate) resources: Resources,
    pub(crate) steps: Vec<PreparedStep>,
    /// Framebuffers by step and views.
    pub(crate) framebuffers: BTreeMap<(StepId, Vec<vk::ImageView>), vk::Framebuffer>,
}

/// Subpasses and render pass of a step.
#[derive(Default)]
pub(crate) struct PreparedStep {
    pub(crate) subpasses: Vec<Subpass>,
    /// Subpass of each pass of the step.
    pub(crate) subpass_of: Vec<u32>,
    /// Created when the step is first recorded.
    pub(crate) render_pass: Option<vk::RenderPass>,
}

/// Fails if a plan cannot be executed on the device. Creates nothing.
pub(crate) fn check(
    gpu: &Gpu,
    plan: &Plan,
    schedule: Option<&Schedule>,
    commands: &[Command],
    multiview: bool,
) -> Result<(), Error> {
    if !plan.caps().explicit_barriers {
        return Err(Error::NoBarriers);
    }
    if plan.counts().inlined > 0 {
        return Err(Error::Inlined);
    }
    check_caps(plan.caps(), &gpu.caps())?;
    if multiview {
        check_views(gpu, plan)?;
    }
    let (wanted, given) = (schedule.map_or(1, |schedule| schedule.layout.queues.len()), gpu.shared.queues.len());
    if wanted > given {
        return Err(Error::Queues { wanted, given });
    }
    check_owners(plan, schedule, commands)
}

/// Returns the families of queues for concurrent sharing. Empty for queues of one family, which need none.
pub(crate) fn concurrent_families(queues: &[DeviceQueue]) -> Vec<u32> {
    let mut families: Vec<u32> = queues.iter().map(|queue| queue.family).collect();
    families.sort_unstable();
    families.dedup();
    if families.len() > 1 { families } else { Vec::new() }
}

impl Prepared {
    /// Creates the objects of a plan that [`check`] accepts. Takes over or destroys the histories of an earlier plan.
    pub(crate) fn new(
        gpu: &Gpu,
        plan: &Plan,
        schedule: Option<&Schedule>,
        commands: Vec<Command>,
        rings: Vec<Ring>,
    ) -> Result<Self, Error> {
        let queues = schedule.map_or(1, |schedule| schedule.layout.queues.len());
        let families = concurrent_families(&gpu.shared.queues[..queues]);
        let (mut resources, result) = Resources::new(gpu, plan, &commands, &families, rings);
        if let Err(error) = result {
            resources.destroy(&gpu.shared.driver);
            return Err(error);
        }
        let step = |step: StepId| {
            let (subpasses, subpass_of) = subpasses(plan, step);
            PreparedStep { subpasses, subpass_of, render_pass: None }
        };
        Ok(Self {
            steps: plan.step_ids().map(step).collect(),
            plan: plan.clone(),
            commands,
            schedule: schedule.cloned(),
            resources,
            framebuffers: BTreeMap::new(),
        })
    }

    /// Destroys everything. The GPU must have finished.
    pub(crate) fn destroy(&mut self, driver: &Driver) {
        for framebuffer in std::mem::take(&mut self.framebuffers).into_values() {
            driver.destroy(Object::Framebuffer(framebuffer));
        }
        for pass in self.steps.drain(..).filter_map(|step| step.render_pass) {
            driver.destroy(Object::RenderPass(pass));
        }
        self.resources.destroy(driver);
    }
}
