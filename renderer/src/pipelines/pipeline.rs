//! A pipeline with the layouts of its bind groups and the text that it was made from.

use crate::device::error::ErrorScopes;
use crate::pipelines::bind_groups::Binding;
use crate::pipelines::binding_error::{BindingError, BindingReason, explain};
use std::sync::Arc;
use wgpu::{BindGroupLayout, Device};

/// A pipeline with the layouts of its bind groups; dereferences to the wgpu pipeline. Cloning is cheap.
#[derive(Clone, Debug)]
pub struct Pipeline<P>(Arc<Made<P>>);

#[derive(Debug)]
struct Made<P> {
    pipeline: P,
    source: Arc<Source>,
    groups: Vec<BindGroupLayout>,
}

/// What a shader module was compiled from.
#[derive(Debug)]
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) text: String,
}

impl<P> Pipeline<P> {
    /// With the layouts that were given, or those that wgpu read off the shader.
    pub(crate) fn new(
        device: &Device,
        pipeline: P,
        source: Arc<Source>,
        given: &[BindGroupLayout],
        layout_of: fn(&P, u32) -> BindGroupLayout,
    ) -> Self {
        // wgpu tells how many there are by refusing the first that there is not.
        let there = |index| {
            let scopes = ErrorScopes::open(device);
            let layout = layout_of(&pipeline, index);
            scopes.close("a layout").is_ok().then_some(layout)
        };
        let groups = match given {
            [] => (0..device.limits().max_bind_groups).map_while(there).collect(),
            _ => given.to_vec(),
        };
        Self(Arc::new(Made { pipeline, source, groups }))
    }

    /// Bind group `index` of the pipeline, for [`Cx::bind_group`](crate::Cx::bind_group), which refuses an index that the
    /// pipeline does not have.
    pub fn group(&self, index: usize) -> Group<'_> {
        let Made { source, groups, .. } = &*self.0;
        Group { layout: groups.get(index), index, of: Some((source, groups.len())) }
    }
}

impl<P> std::ops::Deref for Pipeline<P> {
    type Target = P;
    fn deref(&self) -> &P {
        &self.0.pipeline
    }
}

/// A raster pipeline.
pub type RasterPipeline = Pipeline<wgpu::RenderPipeline>;
/// A compute pipeline.
pub type ComputePipeline = Pipeline<wgpu::ComputePipeline>;

/// A bind group that is to be made: its layout, and the shader that it is for. A layout of one's own becomes one too, and
/// errors name no shader then.
#[derive(Clone, Copy, Debug)]
pub struct Group<'a> {
    layout: Option<&'a BindGroupLayout>,
    index: usize,
    /// The shader, and how many groups its pipeline has.
    of: Option<(&'a Source, usize)>,
}

impl<'a> From<&'a BindGroupLayout> for Group<'a> {
    fn from(layout: &'a BindGroupLayout) -> Self {
        Self { layout: Some(layout), index: 0, of: None }
    }
}

impl<'a> Group<'a> {
    /// The layout of the group.
    ///
    /// # Errors
    /// [`BindingReason::NoGroup`] when the pipeline has no group of that index.
    pub fn layout(&self) -> Result<&'a BindGroupLayout, BindingError> {
        let groups = self.of.map_or(0, |(_, groups)| groups);
        self.layout.ok_or_else(|| BindingError {
            shader: self.shader().to_owned(),
            group: self.index,
            binding: None,
            variable: None,
            reason: BindingReason::NoGroup { groups },
        })
    }

    /// Index of the group in its pipeline; 0 for a layout of one's own.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Name of the shader; empty for a layout of one's own.
    pub fn shader(&self) -> &'a str {
        self.of.map_or("", |(source, _)| &source.name)
    }

    /// What wgpu's refusal of `bindings` means.
    pub(crate) fn explain(&self, bindings: &[(u32, Binding)], message: String) -> BindingError {
        let text = self.of.map_or("", |(source, _)| &source.text);
        explain((self.shader(), text), self.index, bindings, message)
    }
}
