//! Compiling for the executor's device, and what its driver was asked for in memory.

use super::Executor;
use crate::placed::not_placed::NotPlaced;
use framegraph::{Alias, CompileErrors, Graph, Options, Plan, Scratch, recompile};

/// Memory that a driver gave, in bytes; not what a plan says, but what was allocated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Allocated {
    /// Blocks in which textures and buffers share memory.
    pub placed: u64,
    /// What the driver asks for the same textures and buffers, each in memory of its own.
    pub placed_apart: u64,
    /// Everything that wgpu allocated on the device, by this executor or another; 0 where wgpu does not say.
    pub by_wgpu: u64,
}

impl Executor {
    /// As [`framegraph::recompile`], for this executor's device; with [`Alias::Heap`] the driver is asked for the sizes of what
    /// is placed, and the graph compiled again when it pads them. Where nothing can be placed the plan falls back to
    /// [`Alias::Pool`], and [`Executor::not_placed`] says why.
    ///
    /// ```
    /// # use framegraph::{Alias, Graph, Options, Plan, Scratch};
    /// # use framegraph_wgpu::{Executor, Gpu};
    /// # let (gpu, graph, mut plan) = (Gpu::noop()?, Graph::new(), Plan::new());
    /// let mut executor = Executor::new(&gpu);
    /// let options = Options { alias: Alias::Heap, ..Options::for_frame(64, 64) };
    /// executor.compile(&graph, &options, &mut Scratch::new(), &mut plan)?;
    /// if let Some(why) = executor.not_placed() {
    ///     println!("textures of one shape share memory: {why}");
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`framegraph::compile()`].
    pub fn compile(
        &mut self,
        graph: &Graph,
        options: &Options,
        scratch: &mut Scratch,
        plan: &mut Plan,
    ) -> Result<(), CompileErrors> {
        let Self { gpu, arenas, .. } = self;
        if options.alias != Alias::Heap {
            recompile(graph, &gpu.caps(), options, scratch, plan)?;
            return Ok(());
        }
        // Each turn knows more sizes; the first mostly knows all.
        for _ in 0..4 {
            recompile(graph, arenas.caps(gpu), options, scratch, plan)?;
            match arenas.ask(gpu, plan) {
                Ok(false) => return Ok(()),
                Ok(true) => {}
                Err(why) => arenas.give_up(gpu, why),
            }
        }
        arenas.give_up(gpu, NotPlaced::Restless);
        recompile(graph, arenas.caps(gpu), options, scratch, plan)?;
        Ok(())
    }

    /// Why [`Executor::compile`] places nothing on this device; none where it does, or was not asked to.
    pub fn not_placed(&self) -> Option<&NotPlaced> {
        self.arenas.not_placed()
    }

    /// What the driver gave until now.
    pub fn allocated(&self) -> Allocated {
        let by_wgpu = self.gpu.device.generate_allocator_report().map_or(0, |report| report.total_allocated_bytes);
        let [placed, placed_apart] = self.arenas.allocated_bytes();
        Allocated { placed, placed_apart, by_wgpu }
    }

    /// Breaks sharing on purpose: memory changes hands without a barrier and within one command buffer. For tests that look
    /// for the harm.
    #[cfg(any(test, feature = "testing"))]
    pub fn leave_out_hand_overs(&mut self) {
        self.arenas.leave_out_hand_overs();
    }
}
