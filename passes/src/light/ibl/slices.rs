//! Load-time work as small render graphs, one per slice. Each is executed and awaited, so that loading can report
//! progress and stop between slices.
//!
//! A slice is declared, compiled and executed like a frame, and the compiler derives loads and stores. Slices pass
//! textures on by importing them.

use std::path::Path;

use framegraph::{DeclareError, Graph, Options, Plan, Scratch};
use framegraph_wgpu::{ExecuteError, Executor, ExecutorOptions, Frame, Gpu, Imports};

use super::error::IblError;
use framegraph_scene::progress::{Progress, ProgressFn, Stage, report};

/// Executes slices in order on one device, and reports each.
pub(super) struct Slices<'a, 'p> {
    /// Name of the result, for messages and reports.
    name: &'a str,
    /// Number of finished slices.
    done: usize,
    /// Total number of slices.
    total: usize,
    progress: &'a mut ProgressFn<'p>,
    executor: Executor,
    frame: Frame,
    imports: Imports,
    plan: Plan,
    scratch: Scratch,
}

impl<'a, 'p> Slices<'a, 'p> {
    /// Prepares `total` slices. Executes nothing.
    pub fn new(gpu: &Gpu, name: &'a str, total: usize, progress: &'a mut ProgressFn<'p>) -> Self {
        let options = ExecutorOptions { timing: false, ..ExecutorOptions::default() };
        Self {
            name,
            done: 0,
            total,
            progress,
            executor: Executor::with(gpu, options),
            frame: Frame::new(),
            imports: Imports::new(),
            plan: Plan::new(),
            scratch: Scratch::new(),
        }
    }

    /// Declares, compiles and executes one slice, waits for the device, and reports `item` as done. Returns the result
    /// of `declare`.
    ///
    /// # Errors
    ///
    /// Fails if the graph or its execution fails, the device fails, or the report stops the work.
    pub fn run<T>(
        &mut self,
        item: &str,
        declare: impl FnOnce(&mut Frame, &mut Imports) -> Result<T, DeclareError>,
    ) -> Result<T, IblError> {
        let Self { executor, frame, imports, plan, scratch, .. } = self;
        frame.reset();
        imports.clear();
        let declared = declare(frame, imports)?;
        compile(frame.graph(), executor.gpu(), scratch, plan)?;
        executor.execute(plan, frame, &(), imports).map_err(|error| match error {
            ExecuteError::Device(error) => IblError::Device(error),
            error => IblError::Execute(error),
        })?;
        debug_assert_eq!(executor.executed(), plan.counts(), "a slice is executed as it was planned");
        executor.gpu().wait()?;
        self.done += 1;
        let progress = Progress { stage: Stage::Lighting, done: self.done, total: self.total, item };
        report(self.progress, Path::new(self.name), progress)?;
        Ok(declared)
    }

    /// Returns the texture of a handle of the most recently executed slice.
    pub fn texture(&self, handle: framegraph::Texture) -> Option<&wgpu::Texture> {
        self.executor.texture(&self.plan, handle)
    }
}

/// Compiles the graph of a slice. All its sizes are absolute, so the frame size has no effect.
pub(super) fn compile(graph: &Graph, gpu: &Gpu, scratch: &mut Scratch, plan: &mut Plan) -> Result<(), IblError> {
    Ok(framegraph::compile(graph, &gpu.caps(), &Options::for_frame(1, 1), scratch, plan)?)
}
