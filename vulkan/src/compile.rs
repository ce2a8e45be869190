//! Compilation with the driver's sizes of textures.

use crate::error::Error;
use crate::gpu::Gpu;
use crate::prepared::concurrent_families;
use crate::resources::requirements;
use crate::shape::Shape;
use framegraph::{Alias, Caps, Desc, Extent, Graph, Options, Placement, Plan, ResourceId, Scratch, compile};
use framegraph_queues::{Schedule, SharedMemory, share_memory_with};

impl Gpu {
    /// Compiles a graph for the device. With [`Alias::Heap`], the plan uses the driver's sizes and alignments.
    ///
    /// `caps` are those of [`Gpu::caps`], possibly with fewer capabilities.
    ///
    /// # Errors
    /// Fails if the graph is invalid, or the driver cannot create one of its resources.
    pub fn compile(
        &self,
        graph: &Graph,
        caps: &Caps,
        options: &Options,
        scratch: &mut Scratch,
        plan: &mut Plan,
    ) -> Result<(), Error> {
        compile(graph, caps, options, scratch, plan)?;
        if options.alias != Alias::Heap {
            return Ok(());
        }
        let mut caps = Caps { texture_alignment_bytes: 1, buffer_alignment_bytes: 1, ..caps.clone() };
        for (id, row) in graph.resource_ids().zip(plan.resources()) {
            if !matches!(row.placement, Placement::Heap { .. }) {
                continue;
            }
            let needs = requirements(self, plan, id, &[])?;
            let Desc::Texture(mut desc) = Shape::of(plan, id, &[]).desc else {
                caps.buffer_alignment_bytes = caps.buffer_alignment_bytes.max(needs.alignment);
                continue;
            };
            caps.texture_alignment_bytes = caps.texture_alignment_bytes.max(needs.alignment);
            let [width, height] = desc.extent.texels(options.frame);
            desc.extent = Extent::Absolute { width, height };
            // The size of textures of one descriptor depends on their usage.
            match caps.padded.iter_mut().find(|(known, _)| *known == desc) {
                Some((_, bytes)) => *bytes = (*bytes).max(needs.size),
                None => caps.padded.push((desc, needs.size)),
            }
        }
        compile(graph, &caps, options, scratch, plan)?;
        Ok(())
    }

    /// Shares memory according to a schedule, with the driver's sizes. The plan is compiled without aliasing
    /// ([`framegraph_queues::replan`]).
    ///
    /// # Errors
    /// Fails if the driver cannot create one of the resources.
    ///
    /// # Panics
    /// Panics if `schedule` belongs to another plan.
    pub fn share_memory(&self, plan: &Plan, schedule: &Schedule) -> Result<SharedMemory, Error> {
        let mut alignment = 1;
        let mut sizes: Vec<u64> = plan.resources().iter().map(|row| row.bytes).collect();
        let families = concurrent_families(&self.shared.queues);
        for (at, row) in plan.resources().iter().enumerate() {
            if matches!(row.placement, Placement::Slot(_) | Placement::Heap { .. }) {
                let needs = requirements(self, plan, ResourceId::at(at), &families)?;
                (sizes[at], alignment) = (sizes[at].max(needs.size), alignment.max(needs.alignment));
            }
        }
        Ok(share_memory_with(plan, schedule, alignment, &sizes))
    }
}
