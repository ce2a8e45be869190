//! State shared by all steps of a frame while it is recorded.

use crate::device::gpu::Gpu;
use crate::measure::timing::Timing;
use crate::pipelines::bind_groups::BindGroupCache;
use crate::pipelines::cache::Pipelines;
use crate::pipelines::samplers::SamplerCache;
use crate::placed::driver::Object;
use crate::resources::realize::Realized;
use crate::resources::views::ViewCache;
use crate::workers::Workers;
use framegraph::Plan;
use std::sync::atomic::AtomicBool;
use wgpu::Texture;

/// Caches of objects that recorders request by description. Kept between frames and shared by reference.
#[derive(Debug, Default)]
pub(crate) struct Caches {
    pub(crate) views: ViewCache,
    pub(crate) groups: BindGroupCache,
    pub(crate) samplers: SamplerCache,
    pub(crate) pipelines: Pipelines,
}

impl Caches {
    /// Begins a frame. Drops views and bind groups that were not requested for `max_age` frames, and pipelines after
    /// `max_pipeline_age` frames.
    pub(crate) fn begin_frame(&mut self, max_age: u64, max_pipeline_age: u64) {
        self.views.begin_frame(max_age);
        self.groups.begin_frame(max_age);
        self.samplers.begin_frame();
        self.pipelines.begin_frame(max_pipeline_age);
    }

    /// Drops all objects that refer to a texture that is being freed.
    pub(crate) fn forget(&mut self, texture: &Texture) {
        self.views.forget(texture);
        self.groups.forget(texture);
    }

    /// Drops all objects that refer to a placed resource that is being freed.
    pub(crate) fn forget_placed(&mut self, object: &Object) {
        match object {
            Object::Texture(placed) => self.forget(placed.texture()),
            Object::Buffer(buffer) => self.groups.forget_buffer(buffer),
        }
    }
}

/// A frame whose textures and buffers exist, ready to be recorded. Several threads may record steps of it at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prepared<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) plan: &'a Plan,
    pub(crate) realized: &'a Realized,
    pub(crate) caches: &'a Caches,
    pub(crate) timing: &'a Timing,
    /// Threads that record parts of a pass.
    pub(crate) workers: Option<&'a Workers>,
    /// For each access of the graph, whether a recorder looked it up.
    pub(crate) touched: &'a [AtomicBool],
    /// True if undefined contents are filled ([`poison`](crate::debug::poison)).
    pub(crate) poison: bool,
}
