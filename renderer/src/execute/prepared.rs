//! What recording reads: everything that is settled before the first step and shared by all of them.

use crate::device::gpu::Gpu;
use crate::measure::timing::Timing;
use crate::pipelines::bind_groups::BindGroupCache;
use crate::pipelines::cache::Pipelines;
use crate::pipelines::samplers::SamplerCache;
use crate::placed::driver::Object;
use crate::resources::realize::Realized;
use crate::resources::views::ViewCache;
use framegraph::Plan;
use std::sync::atomic::AtomicBool;
use wgpu::Texture;

/// Objects that recorders ask for by description, kept from frame to frame and shared by reference.
#[derive(Debug, Default)]
pub(crate) struct Caches {
    pub(crate) views: ViewCache,
    pub(crate) groups: BindGroupCache,
    pub(crate) samplers: SamplerCache,
    pub(crate) pipelines: Pipelines,
}

impl Caches {
    /// Begins a frame and drops views and bind groups that no frame asked for during `max_age` frames, and pipelines after
    /// `max_pipeline_age`.
    pub(crate) fn begin_frame(&mut self, max_age: u64, max_pipeline_age: u64) {
        self.views.begin_frame(max_age);
        self.groups.begin_frame(max_age);
        self.samplers.begin_frame();
        self.pipelines.begin_frame(max_pipeline_age);
    }

    /// Drops what holds a texture that is given up.
    pub(crate) fn forget(&mut self, texture: &Texture) {
        self.views.forget(texture);
        self.groups.forget(texture);
    }

    /// The same of what was placed in memory that is given up.
    pub(crate) fn forget_placed(&mut self, object: &Object) {
        match object {
            Object::Texture(placed) => self.forget(placed.texture()),
            Object::Buffer(buffer) => self.groups.forget_buffer(buffer),
        }
    }
}

/// A frame whose textures and buffers are there, ready to be recorded. Several threads may record steps of it at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prepared<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) plan: &'a Plan,
    pub(crate) realized: &'a Realized,
    pub(crate) caches: &'a Caches,
    pub(crate) timing: &'a Timing,
    /// By access of the graph: whether a recorder looked it up.
    pub(crate) touched: &'a [AtomicBool],
    /// Contents that may be anything are filled ([`poison`](crate::debug::poison)).
    pub(crate) poison: bool,
}
