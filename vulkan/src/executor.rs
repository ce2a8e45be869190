//! The executor: prepares a plan, and executes frames of it.

use crate::cx::{Cx, RecordError};
use crate::driver::Thing;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::imports::Imports;
use crate::lanes::{FrameSlot, Lanes};
use crate::layouts::Layouts;
use crate::prepared::{Prepared, check};
use crate::resources::MemoryReport;
use crate::run::Run;
use crate::views::Views;
use ash::vk;
use framegraph::{Counts, Plan, ResourceId};
use framegraph_queues::{Command, PlanStream, Schedule, SharedMemory};
use std::collections::BTreeMap;

/// Options of an executor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExecutorOptions {
    /// Draws into several layers with one view for each layer (`VK_KHR_multiview`, core in Vulkan 1.1), instead of
    /// layers that a vertex or geometry shader selects. The feature must be enabled.
    pub multiview: bool,
    /// Writes timestamps around each step ([`Executor::step_times_us`]).
    pub timing: bool,
    /// States the execution dependency of each image barrier also without the image. It changes nothing for the GPU.
    /// Synchronization validation of 2023 needs it to see chains of barriers of different resources in one heap.
    pub explicit_chains: bool,
}

/// Number of frames that the CPU records ahead of the GPU.
const FRAMES: usize = 2;

/// Executes plans on the engine's device.
///
/// The executor keeps the objects of one plan. Frames of one executor follow each other: the GPU begins a frame when it
/// has finished the previous one, while the CPU records up to two frames ahead.
///
/// Dropping an executor waits for the GPU.
pub struct Executor {
    gpu: Gpu,
    options: ExecutorOptions,
    lanes: Lanes,
    slots: [FrameSlot; FRAMES],
    frame: u64,
    prepared: Option<Prepared>,
    layouts: Layouts,
    views: Views,
    executed: Counts,
    barriers: u64,
    times_us: Vec<Option<f64>>,
    /// A frame began and did not end: it failed, or its recorder panicked.
    dirty: bool,
}

/// An exported resource or the newest image of a history. See [`Executor::exported`] for how long it is valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The image; null for a buffer.
    pub image: vk::Image,
    /// The buffer; null for an image.
    pub buffer: vk::Buffer,
}

impl Executor {
    /// Creates an executor with default options.
    ///
    /// # Errors
    /// Fails if the device is lost or out of memory.
    pub fn new(gpu: &Gpu) -> Result<Self, Error> {
        Self::with(gpu, ExecutorOptions::default())
    }

    /// Creates an executor with options.
    ///
    /// # Errors
    /// Fails if the device is lost or out of memory.
    pub fn with(gpu: &Gpu, options: ExecutorOptions) -> Result<Self, Error> {
        Ok(Self {
            gpu: gpu.clone(),
            options,
            lanes: Lanes::new(gpu)?,
            slots: Default::default(),
            frame: 0,
            prepared: None,
            layouts: Layouts::new(options.explicit_chains),
            views: Views::default(),
            executed: Counts::default(),
            barriers: 0,
            times_us: Vec::new(),
            dirty: false,
        })
    }

    /// Prepares a plan for one queue, or for the queues of a schedule, with the memory that the schedule shares.
    /// Histories with the same name and shape keep their contents. Waits for the GPU.
    ///
    /// # Errors
    /// Fails if the device cannot execute the plan or its schedule; the executor then keeps the earlier plan. Fails if
    /// the device cannot create what the plan needs; the executor then has no plan and no histories.
    ///
    /// # Panics
    /// Panics if `schedule` belongs to another plan.
    pub fn prepare(&mut self, plan: &Plan, schedule: Option<(&Schedule, Option<&SharedMemory>)>) -> Result<(), Error> {
        let commands = match schedule {
            None => plan.stream(),
            Some((schedule, None)) => plan.stream_on(schedule),
            Some((schedule, Some(memory))) => plan.stream_in(schedule, memory),
        };
        self.prepare_stream(plan, schedule.map(|(schedule, _)| schedule), commands)
    }

    fn prepare_stream(
        &mut self,
        plan: &Plan,
        schedule: Option<&Schedule>,
        commands: Vec<Command>,
    ) -> Result<(), Error> {
        check(&self.gpu, plan, schedule, &commands, self.options.multiview)?;
        self.recover()?;
        let mut earlier = self.release()?;
        let rings = earlier.as_mut().map_or_else(Vec::new, |earlier| earlier.resources.take_rings());
        if let Some(mut earlier) = earlier {
            earlier.destroy(&self.gpu.shared.driver);
        }
        let kept: Vec<Thing> = rings.iter().flat_map(|ring| ring.things.iter().copied()).collect();
        self.layouts.retain(&kept);
        self.prepared = Some(Prepared::new(&self.gpu, plan, schedule, commands, rings)?);
        Ok(())
    }

    /// Executes one frame of a plan. `record` is called for each pass that runs, in order, with the command buffer and
    /// the resources of the pass. Takes `imports`, which are promised for one frame. Prepares the plan for one queue if another one is prepared.
    ///
    /// # Errors
    /// Fails if an import is not bound, a Vulkan call fails, or `record` returns an error. The frame is then not
    /// complete, and histories start anew. If `record` panics, the next frame starts them anew.
    pub fn execute(
        &mut self,
        plan: &Plan,
        imports: Imports,
        mut record: impl FnMut(&mut Cx<'_>) -> Result<(), RecordError>,
    ) -> Result<(), Error> {
        self.recover()?;
        if self.prepared.as_ref().is_none_or(|prepared| prepared.plan.compilation() != plan.compilation()) {
            self.prepare(plan, None)?;
        }
        if let Some(id) = imports.missing(plan) {
            return Err(Error::Import { resource: plan.graph().resource_name(id).to_owned() });
        }
        let schedule = self.prepared.as_ref().and_then(|prepared| prepared.schedule.as_ref());
        let queues = schedule.map_or(1, |schedule| schedule.layout.queues.len());
        if let Some(pair) = imports.shared(plan, queues) {
            let is_buffer = imports.bound_buffer(pair[0]).is_some();
            let [resource, other] = pair.map(|id| plan.graph().resource_name(id).to_owned());
            return Err(Error::Shared { resource, other, is_buffer });
        }
        self.dirty = true;
        let result = self.run(&imports, &mut record);
        if result.is_ok() {
            self.dirty = false;
        } else {
            // The first error is the cause. If this fails too, the next call tries it again.
            let _ = self.recover();
        }
        result
    }

    /// Drops a frame that did not end, with the prepared plan. Waits for the GPU.
    fn recover(&mut self) -> Result<(), Error> {
        if self.dirty {
            self.lanes.abandon();
            if let Some(mut prepared) = self.release()? {
                prepared.destroy(&self.gpu.shared.driver);
            }
            self.dirty = false;
        }
        Ok(())
    }

    fn run(&mut self, imports: &Imports, record: crate::run::Recorder<'_>) -> Result<(), Error> {
        let slot = &mut self.slots[(self.frame % FRAMES as u64) as usize];
        slot.reclaim(&self.gpu)?;
        let prepared = self.prepared.as_mut().ok_or(Error::NotPrepared)?;
        let steps = prepared.plan.steps().len() as u32;
        if self.options.timing {
            crate::timing::read(&self.gpu, slot, &mut self.times_us)?;
            crate::timing::begin(&self.gpu, slot, steps)?;
        }
        let queues = self.lanes.rows.len();
        let mut run = Run {
            gpu: &self.gpu,
            lanes: &mut self.lanes,
            slot,
            prepared,
            layouts: &mut self.layouts,
            views: &mut self.views,
            imports,
            multiview: self.options.multiview,
            executed: Counts::default(),
            barriers: 0,
            points: BTreeMap::new(),
            open: vec![None; queues],
        };
        run.all(record)?;
        crate::timing::end(run.slot, steps);
        (self.executed, self.barriers) = (run.executed, run.barriers);
        self.frame += 1;
        prepared.resources.advance();
        Ok(())
    }

    /// Waits until the GPU has finished all frames. The CPU can then read what they wrote to mapped memory: each frame
    /// ends with a memory dependency to the host.
    ///
    /// # Errors
    /// Fails if the device is lost.
    pub fn wait(&self) -> Result<(), Error> {
        let points: Vec<_> = self.slots.iter().flat_map(|slot| slot.done.iter().copied()).collect();
        points.iter().try_for_each(|point| self.gpu.shared.driver.wait(&[*point]))
    }

    /// Waits for the GPU, and returns the prepared plan with its objects.
    fn release(&mut self) -> Result<Option<Prepared>, Error> {
        self.wait()?;
        for slot in &mut self.slots {
            slot.reclaim(&self.gpu)?;
        }
        let prepared = self.prepared.take();
        self.views.clear(&self.gpu.shared.driver);
        Ok(prepared)
    }

    /// Counts of the last frame: loads, stores, clears and passes as they were given to Vulkan. Equal to those of the
    /// plan.
    #[must_use]
    pub fn executed(&self) -> Counts {
        self.executed
    }

    /// Number of barriers of the plan that the last frame recorded.
    #[must_use]
    pub fn barriers(&self) -> u64 {
        self.barriers
    }

    /// Number of submissions so far.
    #[must_use]
    pub fn submissions(&self) -> u64 {
        self.lanes.submissions
    }

    /// Memory as the driver reports it; zero without a prepared plan.
    #[must_use]
    pub fn memory(&self) -> MemoryReport {
        let driver = &self.gpu.shared.driver;
        self.prepared.as_ref().map_or_else(MemoryReport::default, |prepared| prepared.resources.report(driver))
    }

    /// Duration of each step in microseconds, of a frame that the GPU has finished; two frames old. Empty without
    /// [`ExecutorOptions::timing`]; `None` for steps on queues without timestamps.
    #[must_use]
    pub fn step_times_us(&self) -> &[Option<f64>] {
        &self.times_us
    }

    /// Returns the object of an export or history, with the contents of the last frame; `None` for other resources.
    /// It stays valid until another plan is prepared, a frame fails, or the executor is dropped. Later frames overwrite it.
    #[must_use]
    pub fn exported(&self, id: ResourceId) -> Option<Exported> {
        let prepared = self.prepared.as_ref()?;
        let thing = prepared.resources.written(&prepared.plan, id)?;
        let (image, buffer) = match thing {
            Thing::Image(image) => (image, vk::Buffer::null()),
            Thing::Buffer(buffer) => (vk::Image::null(), buffer),
        };
        Some(Exported { image, buffer })
    }

    /// Returns the layout of a part of an image after the last frame. Works for exports, histories and the images of
    /// imports. `plane` is 1 for the stencil of a depth-stencil texture, otherwise 0.
    #[must_use]
    pub fn layout(&self, id: ResourceId, image: vk::Image, mip: u32, layer: u32, plane: u32) -> vk::ImageLayout {
        let part = self.prepared.as_ref().and_then(|prepared| {
            let desc = prepared.plan.graph().resources().get(id.index())?.desc;
            let part = crate::shape::Part { mip, layer, plane };
            Some(part.index(desc.texture()?, prepared.plan.frame()))
        });
        part.map_or(vk::ImageLayout::UNDEFINED, |part| self.layouts.get(Thing::Image(image), part))
    }
}

impl Drop for Executor {
    fn drop(&mut self) {
        // After a lost device, everything counts as finished.
        let _ = self.wait();
        let driver = &self.gpu.shared.driver;
        self.slots.iter_mut().for_each(|slot| slot.destroy(&self.gpu));
        self.views.clear(driver);
        if let Some(mut prepared) = self.prepared.take() {
            prepared.destroy(driver);
        }
        self.layouts.clear();
        self.lanes.destroy(&self.gpu);
    }
}

/// Streams other than those of a plan, for tests of validation.
#[cfg(feature = "testing")]
pub mod stream {
    #![allow(unsafe_code, reason = "commands without their barriers race on the GPU")]

    use super::{Command, Error, Executor, Plan, Schedule};

    /// Prepares a plan with these commands instead of those of [`framegraph_queues::stream()`].
    ///
    /// # Safety
    /// The commands are those of the plan's stream, or the device has validation layers and the results are not used.
    ///
    /// # Errors
    /// Fails as [`Executor::prepare`] does.
    pub unsafe fn prepare(
        executor: &mut Executor,
        plan: &Plan,
        schedule: Option<&Schedule>,
        commands: Vec<Command>,
    ) -> Result<(), Error> {
        executor.prepare_stream(plan, schedule, commands)
    }
}
