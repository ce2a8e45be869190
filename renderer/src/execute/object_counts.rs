//! Number of wgpu objects that an executor created.

/// Number of wgpu objects created since the executor was created. Constant between frames once everything is cached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ObjectCounts {
    /// Pooled textures, and placed textures and buffers.
    pub textures: u64,
    /// Images of histories.
    pub histories: u64,
    /// Pooled buffers.
    pub buffers: u64,
    /// Uniform buffers.
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
    /// Returns the number of objects created since `before`.
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

    /// Returns names and counts, for reports.
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
            ("history images", histories),
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
