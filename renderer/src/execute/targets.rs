//! Attachments of the current step as pipelines see them: formats, samples and size.

use crate::device::format::texture_format;
use framegraph::{Format, MAX_COLORS, Plan, Role, StepId};
use std::num::NonZeroU32;
use wgpu::TextureFormat;

/// Attachment formats and sizes of a step. Pipelines must match them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Targets {
    /// Formats of the color attachments, by slot.
    pub colors: [Option<Format>; MAX_COLORS as usize],
    /// Format of the depth-stencil attachment.
    pub depth: Option<Format>,
    /// True if the depth attachment is read-only; pipelines must not write it.
    pub depth_read_only: bool,
    /// Samples per texel.
    pub samples: u32,
    /// Number of layers attached at once. Each draw is repeated for every layer; shaders get the layer in
    /// `@builtin(view_index)`.
    pub layers: u32,
    /// Width and height in texels.
    pub extent: [u32; 2],
}

impl Targets {
    /// Returns the targets of a step. A step without attachments has one sample and no formats.
    ///
    /// # Panics
    /// Panics if `step` is not a step of the plan.
    pub fn of(plan: &Plan, step: StepId) -> Self {
        let row = &plan.steps()[step.index()];
        let (samples, layers) = (u32::from(row.samples.max(1)), row.layers.max(1));
        let mut targets = Self { samples, layers, extent: row.extent, ..Self::default() };
        for attachment in plan.attachments_of(step) {
            let format = attachment.view.or(plan.format(attachment.resource));
            match attachment.role {
                Role::Color(slot) => targets.colors[usize::from(slot)] = format,
                Role::Depth => targets.depth = format,
                Role::DepthReadOnly => (targets.depth, targets.depth_read_only) = (format, true),
                Role::ResolveTarget(..) | Role::ResolveDepth(_) => {}
            }
        }
        targets
    }

    /// Returns wgpu's multiview mask; `None` for a single layer.
    pub(crate) fn multiview_mask(&self) -> Option<NonZeroU32> {
        NonZeroU32::new(u32::MAX.unbounded_shr(u32::BITS - self.layers.min(u32::BITS))).filter(|_| self.layers > 1)
    }

    /// Returns the wgpu format of the depth-stencil attachment.
    pub(crate) fn depth_format(&self) -> Option<TextureFormat> {
        self.depth.map(texture_format)
    }
}
