//! Barriers as data, for back ends with explicit synchronization.

use crate::enum_names::{bits, enum_names};
use crate::id::{ResourceId, StepId};

/// Layout or usage of a subresource. Covers the Vulkan image layouts that a graph can request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum State {
    /// Contents are undefined.
    #[default]
    Undefined,
    /// Unknown state at the start of the frame: an import without a declared state ([`Entry::Left`]), or a history
    /// image as the earlier frame left it.
    ///
    /// [`Entry::Left`]: crate::Entry::Left
    Entry,
    /// Color attachment or resolve target.
    ColorAttachment,
    /// Depth or depth-stencil attachment that is written.
    DepthAttachment,
    /// Read-only depth or depth-stencil attachment; may be sampled at the same time.
    DepthReadOnly,
    /// Same-pixel read in the tile (input attachment).
    InputAttachment,
    /// Sampled texture or texel fetch in a shader.
    Sampled,
    /// Storage texture or buffer in a shader.
    Storage,
    /// Uniform buffer in a shader.
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

enum_names! {
    State:
    Undefined "undefined", Entry "entry", ColorAttachment "color_attachment", DepthAttachment "depth_attachment",
    DepthReadOnly "depth_read_only", InputAttachment "input_attachment", Sampled "sampled", Storage "storage",
    Uniform "uniform", VertexInput "vertex_input", Indirect "indirect", CopySource "copy_source", CopyTarget "copy_target"
}

impl State {
    /// Every state.
    pub const ALL: [Self; 13] = {
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
    /// Pipeline stages, as a set of bits. Serialized as a list of names.
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
        /// Vertex and index fetch.
        VERTEX_INPUT = 32 "vertex_input";
        /// Fetch of indirect arguments.
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

    /// Parses a list of stage names.
    fn try_from(names: Vec<String>) -> Result<Self, String> {
        let stage = |name: &String| {
            let known = Self::NAMES.iter().find(|(_, n)| n == name);
            known.map(|(s, _)| *s).ok_or_else(|| {
                let names: Vec<_> = Self::NAMES.iter().map(|(_, n)| *n).collect();
                format!("unknown stage `{name}`; use one of {}", names.join(", "))
            })
        };
        names.iter().try_fold(Self::NONE, |all, name| Ok(all.union(stage(name)?)))
    }
}

/// One barrier: consecutive subresources of one resource change their state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Barrier {
    /// The step that the barrier precedes.
    pub before: StepId,
    /// The resource whose subresources change their state.
    pub resource: ResourceId,
    /// First subresource: `(plane · layers + layer) · mips + mip`.
    pub first_part: u32,
    /// Number of consecutive subresources.
    pub parts: u32,
    /// The state before the barrier.
    pub from: State,
    /// The state after the barrier.
    pub to: State,
    /// Stages to wait for: of step `after`, or of the work of an import's owner ([`Entry::Left`]). Empty if there is
    /// nothing to wait for.
    ///
    /// Does not include earlier frames: a back end that overlaps frames has to wait for their uses of the same memory.
    ///
    /// [`Entry::Left`]: crate::Entry::Left
    pub from_stages: Stages,
    /// The stages that wait.
    pub to_stages: Stages,
    /// The step to wait for; none for work before the frame. If other steps lie in between, a split barrier can span
    /// them.
    pub after: StepId,
    /// The previous resource in the same memory if this is an aliasing barrier; otherwise none.
    pub aliases: ResourceId,
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
