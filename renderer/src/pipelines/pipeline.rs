//! Pipelines with their bind group layouts and shader source.

use crate::pipelines::bind_groups::Binding;
use crate::pipelines::binding_error::{BindingError, BindingReason, explain};
use std::sync::Arc;
use wgpu::{BindGroupLayout, Device};

/// A pipeline with its bind group layouts. Dereferences to the wgpu pipeline. Clones are cheap.
#[derive(Clone, Debug)]
pub struct Pipeline<P>(Arc<Made<P>>);

#[derive(Debug)]
struct Made<P> {
    pipeline: P,
    source: Arc<Source>,
    groups: Vec<BindGroupLayout>,
}

/// Name and source of a compiled shader module.
#[derive(Debug)]
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) text: String,
    /// Number of bind groups that the source declares.
    groups: u32,
}

impl Source {
    pub(crate) fn new(device: &Device, name: &str, text: &str) -> Self {
        let groups = named_groups(text, device.limits().max_bind_groups);
        Self { name: name.to_owned(), text: text.to_owned(), groups }
    }
}

/// Returns the highest `@group` index in the source plus 1, at most `max`. Needed because wgpu returns layouts for
/// unused groups as well.
fn named_groups(text: &str, max: u32) -> u32 {
    let index = |behind: &str| {
        let digits = behind.trim_start().split(|c: char| !c.is_ascii_digit()).next()?;
        // A named constant may have any value.
        Some(digits.parse().unwrap_or(max))
    };
    let last = text.split("@group(").skip(1).filter_map(index).max();
    last.map_or(0, |last| last.saturating_add(1).min(max))
}

impl<P> Pipeline<P> {
    /// Creates a pipeline with the given layouts, or with the layouts that wgpu derived from the shader if there are
    /// none.
    pub(crate) fn new(
        pipeline: P,
        source: Arc<Source>,
        given: &[BindGroupLayout],
        layout_of: fn(&P, u32) -> BindGroupLayout,
    ) -> Self {
        let groups = match given {
            [] => (0..source.groups).map(|index| layout_of(&pipeline, index)).collect(),
            _ => given.to_vec(),
        };
        Self(Arc::new(Made { pipeline, source, groups }))
    }

    /// Returns the number of bind groups.
    pub(crate) fn groups(&self) -> usize {
        self.0.groups.len()
    }

    /// Returns bind group `index` of the pipeline, for [`Cx::bind_group`](crate::Cx::bind_group). Creating the group
    /// fails if the pipeline has no group with this index.
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

/// Layout of a bind group with the name of its shader for errors. Can also be created from a [`BindGroupLayout`],
/// without a shader name.
#[derive(Clone, Copy, Debug)]
pub struct Group<'a> {
    layout: Option<&'a BindGroupLayout>,
    index: usize,
    /// Shader, and number of groups of its pipeline.
    of: Option<(&'a Source, usize)>,
}

impl<'a> From<&'a BindGroupLayout> for Group<'a> {
    fn from(layout: &'a BindGroupLayout) -> Self {
        Self { layout: Some(layout), index: 0, of: None }
    }
}

impl<'a> Group<'a> {
    /// Returns the layout of the group.
    ///
    /// # Errors
    /// Fails with [`BindingReason::NoGroup`] if the pipeline has no group with this index.
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

    /// Returns the index of the group in its pipeline; 0 if created from a layout.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Returns the name of the shader; empty if created from a layout.
    pub fn shader(&self) -> &'a str {
        self.of.map_or("", |(source, _)| &source.name)
    }

    /// Explains why wgpu rejected `bindings`.
    pub(crate) fn explain(&self, bindings: &[(u32, Binding)], message: String) -> BindingError {
        let text = self.of.map_or("", |(source, _)| &source.text);
        explain((self.shader(), text), self.index, bindings, message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bind_groups_are_counted_from_the_source() {
        let counted =
            ["fn f() {}", "@group(0) @binding(1) var a", "@group( 2 ) var b; @group(0) var c", "@group(G) var d"];
        assert_eq!(counted.map(|text| named_groups(text, 4)), [0, 1, 3, 4]);
        assert_eq!(named_groups("@group(4294967295) var e", 4), 4);
    }
}
