//! A pipeline with the layouts of its bind groups and the text that it was made from.

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
    /// Bind groups that its variables name, from 0 to the last.
    groups: u32,
}

impl Source {
    pub(crate) fn new(device: &Device, name: &str, text: &str) -> Self {
        let groups = named_groups(text, device.limits().max_bind_groups);
        Self { name: name.to_owned(), text: text.to_owned(), groups }
    }
}

/// The last group that a text names, counted from 1; never more than there may be. wgpu has layouts for all that there may
/// be, and does not tell which of them are used.
fn named_groups(text: &str, most: u32) -> u32 {
    let index = |behind: &str| {
        let digits = behind.trim_start().split(|c: char| !c.is_ascii_digit()).next()?;
        // Not a number: a constant's name, which may stand for any group.
        Some(digits.parse().unwrap_or(most))
    };
    let last = text.split("@group(").skip(1).filter_map(index).max();
    last.map_or(0, |last| last.saturating_add(1).min(most))
}

impl<P> Pipeline<P> {
    /// With the layouts that were given, or those that wgpu read off the shader.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_counted_as_the_text_names_them() {
        let counted =
            ["fn f() {}", "@group(0) @binding(1) var a", "@group( 2 ) var b; @group(0) var c", "@group(G) var d"];
        assert_eq!(counted.map(|text| named_groups(text, 4)), [0, 1, 3, 4]);
        assert_eq!(named_groups("@group(4294967295) var e", 4), 4);
    }
}
