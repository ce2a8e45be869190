//! Barriers as data: what a back end with explicit synchronisation says between steps.

use crate::id::{ResourceId, StepId};
use crate::words::{bits, words};

/// The layout or kind of use that a part is in; one of them for each image layout of Vulkan that a graph can ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum State {
    /// Contents are of no use.
    #[default]
    Undefined,
    /// As whoever had it before the frame left it: the owner of an import that does not say ([`Entry::Left`] does), or the
    /// earlier frame that wrote or read an image of a history.
    ///
    /// [`Entry::Left`]: crate::Entry::Left
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

words! {
    State:
    Undefined "undefined", Entry "entry", ColorAttachment "color_attachment", DepthAttachment "depth_attachment",
    DepthReadOnly "depth_read_only", InputAttachment "input_attachment", Sampled "sampled", Storage "storage",
    Uniform "uniform", VertexInput "vertex_input", Indirect "indirect", CopySource "copy_source", CopyTarget "copy_target"
}

#[cfg(feature = "testing")]
impl State {
    /// Every state.
    pub(crate) const ALL: [Self; 13] = {
        use State::*;
        [
            Undefined,
            Entry,
            ColorAttachment,
            DepthAttachment,
            DepthReadOnly,
            InputAttachment,
            Sampled,
            Storage,
            Uniform,
            VertexInput,
            Indirect,
            CopySource,
            CopyTarget,
        ]
    };
}

bits! {
    /// The parts of the pipeline that make an access; a set of bits. In files, a list of the names.
    #[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
    #[cfg_attr(feature = "files", serde(try_from = "Vec<String>", into = "Vec<&'static str>"))]
    Stages {
        /// Vertex and fragment shaders.
        SHADER = 1 "shader";
        /// Color attachment output, resolves included.
        COLOR = 2 "color";
        /// Depth and stencil tests.
        DEPTH = 4 "depth";
        /// The compute shader stage.
        COMPUTE = 8 "compute";
        /// Copies between textures and buffers.
        COPY = 16 "copy";
        /// Reading of vertices and indices.
        VERTEX_INPUT = 32 "vertex_input";
        /// Reading of indirect arguments.
        INDIRECT = 64 "indirect";
    }
}

impl From<Stages> for Vec<&'static str> {
    fn from(stages: Stages) -> Self {
        stages.names().collect()
    }
}

impl TryFrom<Vec<String>> for Stages {
    type Error = String;

    /// The set of stages of these names.
    fn try_from(names: Vec<String>) -> Result<Self, String> {
        let stage = |name: &String| {
            let known = Self::NAMES.iter().find(|(_, n)| n == name);
            known.map(|(s, _)| *s).ok_or_else(|| {
                let names: Vec<_> = Self::NAMES.iter().map(|(_, n)| *n).collect();
                format!("there is no stage `{name}`; stages are {}", names.join(", "))
            })
        };
        names.iter().try_fold(Self::NONE, |all, name| Ok(all.union(stage(name)?)))
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
    /// The stages that must be over before: of step `after`, or of the work of the owner of an import ([`Entry::Left`]).
    /// Empty when nothing of either is waited for. Earlier frames are not named: whoever overlaps frames waits for their
    /// uses of the same memory.
    ///
    /// [`Entry::Left`]: crate::Entry::Left
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
    fn words_are_the_names_of_the_states() {
        for (index, state) in State::ALL.into_iter().enumerate() {
            assert_eq!(state as usize, index, "{state}");
            assert_eq!(format!("{state:?}").to_lowercase(), state.word().replace('_', ""));
        }
    }
}
