//! Pipelines ahead of the first frame, kept over runs, and shaders that change while the program runs.

use super::{Executor, check};
use crate::device::pipeline_cache::{PipelineCacheError, cache_bytes, open_cache};
use crate::execute::error::ExecuteError;
use crate::execute::steps::Passes;
use crate::frame::Frame;
use crate::pipelines::shader::{Shader, ShaderError};
use crate::resources::imports::Imports;
use framegraph::Plan;

/// How far [`Executor::warm_up`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WarmUp<'a> {
    /// Steps that are done.
    pub done: usize,
    /// Steps of the plan.
    pub of: usize,
    /// The first pass of the step that was done last.
    pub pass: &'a str,
    /// Pipelines that this call made so far.
    pub pipelines: u64,
}

impl Executor {
    /// Makes everything that a frame takes before it is wanted: textures, views, bind groups, and above all pipelines, whose
    /// shaders drivers compile for long. The frame is recorded and thrown away; nothing is submitted, and histories do not
    /// move. `progress` is told each step.
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
    /// executor.warm_up(&plan, &frame, &(), &imports, &mut |at| println!("{}/{}: {}", at.done, at.of, at.pass))?;
    /// let made = executor.objects();
    /// executor.execute(&plan, &frame, &(), &imports)?;
    /// assert_eq!((made.pipelines, executor.objects()), (1, made));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Executor::execute`].
    pub fn warm_up<W: ?Sized + Sync + 'static>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        progress: &mut dyn FnMut(WarmUp<'_>),
    ) -> Result<(), ExecuteError> {
        check(plan, frame)?;
        let before = self.objects().pipelines;
        let (of, mut done) = (plan.steps().len(), 0);
        let unsent = self.record_frame(
            plan,
            &Passes { frame, world, extra: None },
            imports,
            Some(&mut |step, pipelines| {
                done += 1;
                let pass = plan.passes_of(step).first().map_or("", |m| plan.graph().pass_name(m.pass));
                progress(WarmUp { done, of, pass, pipelines: pipelines - before });
            }),
        )?;
        drop(unsent);
        self.give_up();
        Ok(())
    }

    /// Replaces the text of a shader in all pipelines that were made from it, and in those to come: recorders go on asking
    /// with `shader` as it was compiled into the program. Returns how many pipelines were made anew.
    ///
    /// # Errors
    /// Why the new text does not compile, or which of the pipelines it does not fit. The old text stays in use then.
    pub fn reload_shader(&mut self, shader: &Shader<'_>, text: &str) -> Result<usize, ShaderError> {
        self.caches.pipelines.reload(&self.gpu.device, shader, text)
    }

    /// Has the driver keep what it compiles from now on, so that a later run compiles faster; `earlier` is what
    /// [`Executor::pipeline_bytes`] gave in an earlier run, on the same machine and driver. Returns whether the device can:
    /// wgpu offers it on Vulkan, and most drivers on desktops keep files of their own anyway.
    ///
    /// # Errors
    /// `earlier` is damaged or of another device; pipelines are kept all the same, from nothing.
    pub fn keep_pipelines(&mut self, earlier: Option<&[u8]>) -> Result<bool, PipelineCacheError> {
        let (cache, refused) = open_cache(&self.gpu, earlier);
        let can = cache.is_some();
        self.caches.pipelines.set_driver_cache(cache);
        refused.map_or(Ok(can), Err)
    }

    /// What the driver keeps of the pipelines made since [`Executor::keep_pipelines`], to be written to a file beside and
    /// renamed; none where it keeps nothing.
    pub fn pipeline_bytes(&self) -> Option<Vec<u8>> {
        self.caches.pipelines.driver_cache().and_then(|cache| cache_bytes(&self.gpu, cache))
    }
}
