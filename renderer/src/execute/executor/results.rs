//! What an executor has to show for its last frame: textures, counts, times, and what was declared in vain.

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

/// An access that a pass declared and its recorder did not look up, so that it was probably not bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnusedAccess {
    /// The pass that declared it.
    pub pass: PassId,
    /// The resource that it declared to access.
    pub resource: ResourceId,
    /// The kind of access.
    pub kind: AccessKind,
}

impl Executor {
    /// The physical texture behind any version of `handle`, as the frame executed last left it; `None` when it has none.
    /// An exported texture stays as it is until the next frame.
    pub fn texture(&self, plan: &Plan, handle: Texture) -> Option<&wgpu::Texture> {
        self.texture_at(plan.graph().resource_of(handle)?)
    }

    /// As [`Executor::texture`], by the row of the graph: for graphs from files, whose resources are found by name.
    pub fn texture_at(&self, resource: ResourceId) -> Option<&wgpu::Texture> {
        match self.realized.get(resource) {
            Physical::Texture { texture, .. } => Some(texture),
            _ => None,
        }
    }

    /// As [`Executor::texture`], for a buffer.
    pub fn buffer(&self, plan: &Plan, handle: Buffer) -> Option<&wgpu::Buffer> {
        self.buffer_at(plan.graph().resource_of_buffer(handle)?)
    }

    /// As [`Executor::texture_at`], for a buffer.
    pub fn buffer_at(&self, resource: ResourceId) -> Option<&wgpu::Buffer> {
        match self.realized.get(resource) {
            Physical::Buffer { buffer, .. } => Some(buffer),
            _ => None,
        }
    }

    /// What the frame executed last really did, counted where wgpu is called; to be compared with `plan.counts()`.
    pub fn executed(&self) -> Counts {
        self.executed
    }

    /// How many fills of undefined contents the frame executed last added; 0 unless it was asked to
    /// ([`ExecutorOptions::poison`](crate::ExecutorOptions::poison)). These fills are no part of [`Executor::executed`].
    pub fn poisoned(&self) -> u32 {
        self.recording.poisoned
    }

    /// Objects made since the beginning.
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

    /// Hits, creations and memory of the pool of textures.
    pub fn texture_pool(&self) -> PoolCounts {
        self.textures.counts()
    }

    /// The same of buffers.
    pub fn buffer_pool(&self) -> PoolCounts {
        self.buffers.counts()
    }

    /// The same of the blocks of memory in which textures and buffers are placed ([`framegraph::Alias::Heap`]): hits, evictions
    /// and objects are blocks, `created` is what was placed in them, and bytes are those that the driver gave.
    pub fn placed_blocks(&self) -> PoolCounts {
        self.arenas.counts()
    }

    /// Bytes of the images of all histories, without padding.
    pub fn history_bytes(&self) -> u64 {
        self.histories.bytes()
    }

    /// Hits and creations of the caches of views, bind groups and pipelines.
    pub fn caches(&self) -> [(&'static str, CacheCounts); 3] {
        let Caches { views, groups, pipelines, .. } = &self.caches;
        let found = self.recording.remembered.views_found + self.threads.views_found();
        let CacheCounts { hits, created } = views.counts();
        let views = CacheCounts { hits: hits + found, created };
        [("views", views), ("bind groups", groups.counts()), ("pipelines", pipelines.counts())]
    }

    /// Times of steps and frames.
    pub fn timing(&self) -> &Timing {
        &self.timing
    }

    /// Reads the times that have arrived since the last frame, and returns them.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn catch_up(&mut self) -> Result<&Timing, ExecuteError> {
        self.timing.catch_up(&self.gpu)?;
        Ok(&self.timing)
    }

    /// What the passes of the frame executed last declared and did not look up. Attachments are used by being attached.
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
