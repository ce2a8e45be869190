//! Pipelines: created ahead of the first frame, cached between runs, and reloaded while the program runs.

use super::{Executor, check};
use crate::device::pipeline_cache::{PipelineCacheError, cache_bytes, open_cache};
use crate::execute::commands::Destination;
use crate::execute::error::ExecuteError;
use crate::execute::steps::Passes;
use crate::frame::Frame;
use crate::pipelines::shader::{Shader, ShaderError};
use crate::resources::imports::Imports;
use framegraph::Plan;

/// Progress of [`Executor::warm_up`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WarmUpProgress<'a> {
    /// Number of finished steps.
    pub done: usize,
    /// Number of steps of the plan.
    pub total: usize,
    /// Name of the first pass in the last finished step.
    pub pass: &'a str,
    /// Number of pipelines created by this call so far.
    pub pipelines: u64,
}

impl Executor {
    /// Creates everything that a frame needs: textures, views, bind groups and pipelines. Use it to compile shaders
    /// before the first frame is shown.
    ///
    /// Records the frame and drops the commands. Nothing is submitted, and histories do not advance. `progress` is
    /// called after each step.
    ///
    /// ```
    /// # use framegraph::{Extent, Format, Intent, Options, Plan, Scratch, TextureDesc, compile};
    /// # use framegraph_wgpu::{Executor, Frame, Gpu, Imports, Raster, Shader};
    /// # const SKY: Shader<'static> = Shader::new("sky", "
    /// #     @vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(0.0); }
    /// #     @fragment fn fs_main() -> @location(0) vec4f { return vec4f(1.0); }");
    /// # let gpu = Gpu::noop()?;
    /// # let (mut executor, mut frame, mut plan) = (Executor::new(&gpu), Frame::<()>::new(), Plan::new());
    /// # let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    /// # let sky = frame.add_fn("sky", |pass| pass.color(sky, Intent::Overwrite), |_, _, cx| {
    /// #     cx.raster_pipeline(&Raster::new(SKY)).map(|_| ())
    /// # })?;
    /// # frame.graph_mut().export(sky)?;
    /// # compile(frame.graph(), &gpu.caps(), &Options::for_frame(8, 8), &mut Scratch::new(), &mut plan)?;
    /// let imports = Imports::new();
    /// executor.warm_up(&plan, &frame, &(), &imports, &mut |at| println!("{}/{}: {}", at.done, at.total, at.pass))?;
    /// let made = executor.objects();
    /// executor.execute(&plan, &frame, &(), &imports)?;
    /// assert_eq!((made.pipelines, executor.objects()), (1, made));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Fails like [`Executor::execute`].
    pub fn warm_up<W: ?Sized>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        progress: &mut dyn FnMut(WarmUpProgress<'_>),
    ) -> Result<(), ExecuteError> {
        check(plan, frame)?;
        let before = self.objects().pipelines;
        let (total, mut done) = (plan.steps().len(), 0);
        let unsent = self.record_frame(
            plan,
            &Passes { frame, world, extra: None },
            imports,
            Destination::Stepwise(&mut |step, pipelines| {
                done += 1;
                let pass = plan.passes_of(step).first().map_or("", |m| plan.graph().pass_name(m.pass));
                progress(WarmUpProgress { done, total, pass, pipelines: pipelines - before });
            }),
        )?;
        drop(unsent);
        self.drop_unused();
        Ok(())
    }

    /// Replaces the source of a shader in all existing and future pipelines. Recorders continue to pass the original
    /// `shader`. Returns the number of recompiled pipelines.
    ///
    /// # Errors
    /// Fails if the new source does not compile or does not match one of the pipelines. Fails with
    /// [`ShaderError::Reload`] if it lacks an entry point, or expects other bindings, vertex inputs or outputs than
    /// `shader`. The old source stays in use.
    pub fn reload_shader(&mut self, shader: &Shader<'_>, text: &str) -> Result<usize, ShaderError> {
        let Self { gpu, caches, .. } = self;
        caches.groups.settle();
        caches.pipelines.reload(&gpu.device, shader, text, &caches.groups)
    }

    /// Uses a driver pipeline cache from now on, so that later runs compile faster. `earlier` is the result of
    /// [`Executor::pipeline_cache_data`] from an earlier run on the same machine and driver.
    ///
    /// Returns whether the device supports pipeline caches. wgpu supports them on Vulkan; most desktop drivers also
    /// have their own cache.
    ///
    /// # Errors
    /// Fails if `earlier` is damaged or belongs to another device. An empty cache is used in that case.
    pub fn use_pipeline_cache(&mut self, earlier: Option<&[u8]>) -> Result<bool, PipelineCacheError> {
        let (cache, refused) = open_cache(&self.gpu, earlier);
        let can = cache.is_some();
        self.caches.pipelines.set_driver_cache(cache);
        refused.map_or(Ok(can), Err)
    }

    /// Returns the data of the pipeline cache, to be written to a file. `None` if there is no cache. Write to a
    /// temporary file and rename it, so that an interrupted write does no damage.
    pub fn pipeline_cache_data(&self) -> Option<Vec<u8>> {
        self.caches.pipelines.driver_cache().and_then(|cache| cache_bytes(&self.gpu, cache))
    }
}
