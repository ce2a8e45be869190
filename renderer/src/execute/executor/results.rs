//! Results of the last frame: textures, counts, times and unused declarations.

use super::Executor;
use crate::cache::CacheCounts;
use crate::execute::error::ExecuteError;
use crate::execute::object_counts::ObjectCounts;
use crate::execute::prepared::Caches;
use crate::measure::timing::Timing;
use crate::resources::pool::PoolCounts;
use crate::resources::realize::Physical;
use framegraph::{AccessKind, Buffer, Counts, Join, PassId, Plan, ResourceId, Texture};
use std::sync::atomic::{AtomicBool, Ordering};

/// A declared access that the recorder did not look up, and therefore probably did not bind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnusedAccess {
    /// Pass that declared the access.
    pub pass: PassId,
    /// Resource of the access.
    pub resource: ResourceId,
    /// Kind of access.
    pub kind: AccessKind,
}

impl Executor {
    /// Returns the texture behind any version of `handle`, with the contents after the last frame. `None` if the
    /// resource has no memory. Exported textures keep their contents until the next frame.
    pub fn texture(&self, plan: &Plan, handle: Texture) -> Option<&wgpu::Texture> {
        self.texture_at(plan.graph().resource_of(handle)?)
    }

    /// Returns the texture of a resource. For graphs from files, whose resources are found by name.
    pub fn texture_at(&self, resource: ResourceId) -> Option<&wgpu::Texture> {
        match self.realized.get(resource) {
            Physical::Texture { texture, .. } => Some(texture),
            _ => None,
        }
    }

    /// Returns the buffer behind any version of `handle`, like [`Executor::texture`].
    pub fn buffer(&self, plan: &Plan, handle: Buffer) -> Option<&wgpu::Buffer> {
        self.buffer_at(plan.graph().resource_of_buffer(handle)?)
    }

    /// Returns the buffer of a resource, like [`Executor::texture_at`].
    pub fn buffer_at(&self, resource: ResourceId) -> Option<&wgpu::Buffer> {
        match self.realized.get(resource) {
            Physical::Buffer { buffer, .. } => Some(buffer),
            _ => None,
        }
    }

    /// Returns the operations of the last frame, counted at the wgpu calls. Equal to `plan.counts()` if the frame was
    /// executed as planned.
    pub fn executed(&self) -> Counts {
        self.executed
    }

    /// Returns the number of fills that poisoning added to the last frame; 0 if
    /// [`ExecutorOptions::poison`](crate::ExecutorOptions::poison) is off. [`Executor::executed`] does not include
    /// them.
    pub fn poisoned(&self) -> u32 {
        self.recording.poisoned
    }

    /// Returns the number of objects created since the executor was created.
    pub fn objects(&self) -> ObjectCounts {
        ObjectCounts {
            textures: self.textures.counts().created + self.arenas.counts().created,
            histories: self.histories.created(),
            buffers: self.buffers.counts().created,
            uniform_buffers: self.recording.uniforms.created() + self.threads.uniform_buffers(),
            views: self.caches.views.counts().created,
            bind_groups: self.caches.groups.counts().created,
            samplers: self.caches.samplers.created(),
            pipelines: self.caches.pipelines.counts().created,
            shader_modules: self.caches.pipelines.modules().created(),
        }
    }

    /// Returns hits, creations and memory of the texture pool.
    pub fn texture_pool(&self) -> PoolCounts {
        self.textures.counts()
    }

    /// Returns hits, creations and memory of the buffer pool.
    pub fn buffer_pool(&self) -> PoolCounts {
        self.buffers.counts()
    }

    /// Returns counts of the memory blocks for placed resources ([`framegraph::Alias::Heap`]). Hits, evictions and
    /// objects count blocks; `created` counts placed resources. Bytes are as allocated by the driver.
    pub fn placed_blocks(&self) -> PoolCounts {
        self.arenas.counts()
    }

    /// Returns the size of all history images in bytes, without padding.
    pub fn history_bytes(&self) -> u64 {
        self.histories.bytes()
    }

    /// Returns hits and creations of the view, bind group and pipeline caches.
    pub fn caches(&self) -> [(&'static str, CacheCounts); 3] {
        let Caches { views, groups, pipelines, .. } = &self.caches;
        let found = self.recording.requests.views_found + self.threads.views_found();
        let CacheCounts { hits, created } = views.counts();
        let views = CacheCounts { hits: hits + found, created };
        [("views", views), ("bind groups", groups.counts()), ("pipelines", pipelines.counts())]
    }

    /// Turns measurements of step times on or off ([`ExecutorOptions::timing`](crate::ExecutorOptions::timing)), from
    /// the next frame on. Earlier measurements are removed.
    pub fn set_timing(&mut self, on: bool) {
        self.options.timing = on;
        self.timing.set_enabled(on);
        let measured = on || self.options.trace;
        self.recording.set_measured(measured);
        self.threads.set_measured(measured);
    }

    /// Returns times of steps and frames. Times of steps are measured after [`Executor::set_timing`].
    pub fn timing(&self) -> &Timing {
        &self.timing
    }

    /// Reads measurements that have arrived since the last frame, and returns the times.
    ///
    /// # Errors
    /// Fails if the device is lost.
    pub fn catch_up(&mut self) -> Result<&Timing, ExecuteError> {
        self.timing.catch_up(&self.gpu)?;
        Ok(&self.timing)
    }

    /// Returns accesses that passes of the last frame declared but did not look up. Attachments always count as used.
    pub fn unused_accesses(&self, plan: &Plan) -> impl Iterator<Item = UnusedAccess> {
        let graph = plan.graph();
        let recorded = plan.running().filter(|m| m.join != Join::Inlined);
        recorded.flat_map(move |member| {
            let rows = graph.passes()[member.pass.index()].accesses.range();
            rows.filter_map(move |row| {
                let access = graph.accesses()[row];
                let untouched = |touched: &AtomicBool| !touched.load(Ordering::Relaxed);
                let unused = !access.kind.is_attachment() && self.touched.get(row).is_some_and(untouched);
                unused.then_some(UnusedAccess { pass: member.pass, resource: access.resource, kind: access.kind })
            })
        })
    }
}
