//! Barriers as data: what a back end with explicit synchronisation says between steps.

use crate::id::{ResourceId, StepId};

/// The layout or kind of use that a part is in; one of them for each image layout of Vulkan that a graph can ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum State {
    /// Contents are of no use.
    #[default]
    Undefined,
    /// As whoever had it before the frame left it.
    Entry,
    /// Color attachment or resolve target.
    ColorAttachment,
    /// Depth or depth-stencil attachment that is written.
    DepthAttachment,
    /// Depth or depth-stencil attachment that is only tested; may be sampled meanwhile.
    DepthReadOnly,
    /// Read at the same pixel, in the tile.
    InputAttachment,
    /// Read in a shader through a sampler or by texel fetch.
    Sampled,
    /// Storage texture or buffer, read or written in a shader.
    Storage,
    /// Uniform buffer, read in a shader.
    Uniform,
    /// Vertex or index buffer.
    VertexInput,
    /// Arguments of indirect draws and dispatches.
    Indirect,
    /// Source of copies.
    CopySource,
    /// Target of copies.
    CopyTarget,
}

impl State {
    /// Every state with its word, in the order of declaration.
    pub(crate) const WORDS: [(Self, &'static str); 13] = [
        (Self::Undefined, "undefined"),
        (Self::Entry, "entry"),
        (Self::ColorAttachment, "color_attachment"),
        (Self::DepthAttachment, "depth_attachment"),
        (Self::DepthReadOnly, "depth_read_only"),
        (Self::InputAttachment, "input_attachment"),
        (Self::Sampled, "sampled"),
        (Self::Storage, "storage"),
        (Self::Uniform, "uniform"),
        (Self::VertexInput, "vertex_input"),
        (Self::Indirect, "indirect"),
        (Self::CopySource, "copy_source"),
        (Self::CopyTarget, "copy_target"),
    ];

    /// The word that dumps use.
    pub const fn word(self) -> &'static str {
        Self::WORDS[self as usize].1
    }
}

/// The parts of the pipeline that make an access; a set of bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Stages(u16);

impl Stages {
    /// The empty set.
    pub const NONE: Self = Self(0);
    /// Vertex and fragment shaders.
    pub const SHADER: Self = Self(1);
    /// Color attachment output, resolves included.
    pub const COLOR: Self = Self(2);
    /// Depth and stencil tests.
    pub const DEPTH: Self = Self(4);
    /// The compute shader stage.
    pub const COMPUTE: Self = Self(8);
    /// Copies between textures and buffers.
    pub const COPY: Self = Self(16);
    /// Reading of vertices and indices.
    pub const VERTEX_INPUT: Self = Self(32);
    /// Reading of indirect arguments.
    pub const INDIRECT: Self = Self(64);

    pub(crate) const NAMES: [(Self, &'static str); 7] = [
        (Self::SHADER, "shader"),
        (Self::COLOR, "color"),
        (Self::DEPTH, "depth"),
        (Self::COMPUTE, "compute"),
        (Self::COPY, "copy"),
        (Self::VERTEX_INPUT, "vertex_input"),
        (Self::INDIRECT, "indirect"),
    ];

    /// The stages of either.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether every stage of `other` is in `self`.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// The names of the stages, in a fixed order.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        Self::NAMES.into_iter().filter(move |(s, _)| self.contains(*s)).map(|(_, n)| n)
    }
}

/// One barrier: consecutive parts of one resource change their use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Barrier {
    /// It stands in front of this step.
    pub before: StepId,
    /// The resource whose parts change their use.
    pub resource: ResourceId,
    /// First part: `(plane · layers + layer) · mips + mip`.
    pub first_part: u32,
    /// How many consecutive parts.
    pub parts: u32,
    /// The state that they were in.
    pub from: State,
    /// The state that they must be in.
    pub to: State,
    /// The stages that must be over before: empty when nothing of this frame is waited for.
    pub from_stages: Stages,
    /// The stages that wait.
    pub to_stages: Stages,
    /// The step whose work is waited for; none for what happened before the frame. Where it is not the step in front, a
    /// split barrier can span the steps between.
    pub after: StepId,
    /// The tenant that had the memory last, when this use takes it over; none otherwise.
    pub hand_over: ResourceId,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_stand_in_the_order_of_the_states() {
        for (index, (state, word)) in State::WORDS.into_iter().enumerate() {
            assert_eq!(state as usize, index, "{word}");
            assert_eq!(format!("{state:?}").to_lowercase(), word.replace('_', ""));
        }
    }
}
