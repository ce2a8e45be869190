//! Compilation for the executor's device, and the memory its driver allocated.

use super::Executor;
use crate::placed::not_placed::NotPlaced;
use framegraph::{Alias, CompileErrors, Graph, Options, Plan, Scratch, recompile};

/// Allocated memory in bytes, as reported by the driver and wgpu.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Allocated {
    /// Size of the memory blocks shared by placed textures and buffers.
    pub placed: u64,
    /// Size that the same textures and buffers would need without sharing.
    pub unshared: u64,
    /// Size of everything that wgpu allocated on the device, by any executor; 0 if wgpu does not report it.
    pub by_wgpu: u64,
}

impl Executor {
    /// Compiles a graph like [`framegraph::recompile`], for the executor's device.
    ///
    /// With [`Alias::Heap`], the sizes of placed resources are queried from the driver, and the graph is compiled again
    /// if the driver pads them. If the device cannot place resources, the plan falls back to [`Alias::Pool`], and
    /// [`Executor::not_placed`] returns the reason.
    ///
    /// ```
    /// # use framegraph::{Alias, Graph, Options, Plan, Scratch};
    /// # use framegraph_wgpu::{Executor, Gpu};
    /// # let (gpu, graph, mut plan) = (Gpu::noop()?, Graph::new(), Plan::new());
    /// let mut executor = Executor::new(&gpu);
    /// let options = Options { alias: Alias::Heap, ..Options::for_frame(64, 64) };
    /// executor.compile(&graph, &options, &mut Scratch::new(), &mut plan)?;
    /// if let Some(why) = executor.not_placed() {
    ///     println!("textures of equal shape share memory: {why}");
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Fails like [`framegraph::compile()`].
    pub fn compile(
        &mut self,
        graph: &Graph,
        options: &Options,
        scratch: &mut Scratch,
        plan: &mut Plan,
    ) -> Result<(), CompileErrors> {
        let Self { gpu, arenas, .. } = self;
        if options.alias != Alias::Heap {
            recompile(graph, gpu.caps_ref(), options, scratch, plan)?;
            return Ok(());
        }
        // Each iteration learns more sizes; the first usually learns all.
        for _ in 0..4 {
            recompile(graph, arenas.caps(gpu), options, scratch, plan)?;
            match arenas.ask(gpu, plan) {
                Ok(false) => return Ok(()),
                Ok(true) => {}
                Err(why) => arenas.disable(gpu, why),
            }
        }
        arenas.disable(gpu, NotPlaced::UnstableSizes);
        recompile(graph, arenas.caps(gpu), options, scratch, plan)?;
        Ok(())
    }

    /// Returns why [`Executor::compile`] cannot place resources on this device. `None` if it can, or heap aliasing was
    /// not requested.
    pub fn not_placed(&self) -> Option<&NotPlaced> {
        self.arenas.not_placed()
    }

    /// Returns the memory that is currently allocated.
    pub fn allocated(&self) -> Allocated {
        let by_wgpu = self.gpu.device.generate_allocator_report().map_or(0, |report| report.total_allocated_bytes);
        let [placed, unshared] = self.arenas.allocated_bytes();
        Allocated { placed, unshared, by_wgpu }
    }

    /// Disables aliasing barriers and the split of command buffers. For tests that check that this corrupts images.
    #[cfg(any(test, feature = "testing"))]
    pub fn skip_alias_barriers(&mut self) {
        self.arenas.skip_alias_barriers();
    }
}
