//! How many objects of wgpu an executor made.

/// How many wgpu objects were made since the executor was. Equal before and after a frame in the steady state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ObjectCounts {
    /// Textures of the pool, and textures and buffers placed in a heap.
    pub textures: u64,
    /// Images of histories.
    pub histories: u64,
    /// Buffers of the pool.
    pub buffers: u64,
    /// Buffers of constants.
    pub uniform_buffers: u64,
    /// Texture views.
    pub views: u64,
    /// Bind groups.
    pub bind_groups: u64,
    /// Samplers.
    pub samplers: u64,
    /// Pipelines.
    pub pipelines: u64,
    /// Shader modules.
    pub shader_modules: u64,
}

impl ObjectCounts {
    /// What was made since `before`.
    #[must_use]
    pub fn since(&self, before: &Self) -> Self {
        Self {
            textures: self.textures - before.textures,
            histories: self.histories - before.histories,
            buffers: self.buffers - before.buffers,
            uniform_buffers: self.uniform_buffers - before.uniform_buffers,
            views: self.views - before.views,
            bind_groups: self.bind_groups - before.bind_groups,
            samplers: self.samplers - before.samplers,
            pipelines: self.pipelines - before.pipelines,
            shader_modules: self.shader_modules - before.shader_modules,
        }
    }

    /// Each count with its name.
    pub fn rows(&self) -> [(&'static str, u64); 9] {
        let Self {
            textures,
            histories,
            buffers,
            uniform_buffers,
            views,
            bind_groups,
            samplers,
            pipelines,
            shader_modules,
        } = *self;
        [
            ("textures", textures),
            ("images of histories", histories),
            ("buffers", buffers),
            ("uniform buffers", uniform_buffers),
            ("views", views),
            ("bind groups", bind_groups),
            ("samplers", samplers),
            ("pipelines", pipelines),
            ("shader modules", shader_modules),
        ]
    }
}
