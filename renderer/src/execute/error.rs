//! Why a frame could not be executed.

use crate::device::error::DeviceError;
use crate::pipelines::shader::ShaderError;
use crate::resources::imports::ImportError;
use crate::resources::support::Unsupported;
use std::fmt;

/// A setting of an effect that occurs twice in one shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EffectSetting {
    /// An `override` constant, by name.
    Constant(&'static str),
    /// A variable, by `@binding` number.
    Binding(u32),
}

impl fmt::Display for EffectSetting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(name) => write!(f, "the constant `{name}`"),
            Self::Binding(number) => write!(f, "binding {number}"),
        }
    }
}

/// A recorder was refused something, or refused itself.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RecordError {
    /// A handle or token of another graph, or from before a reset.
    #[error("a handle or token is of another graph, or from before the frame was reset; use what `declare` returned")]
    Foreign,
    /// A token of another pass.
    #[error(
        "`{resource}` is touched as `{access}`, which this pass did not declare; declare it, or use the pass's own handle"
    )]
    Undeclared {
        /// The resource.
        resource: String,
        /// The kind of access.
        access: &'static str,
    },
    /// A handle that this pass did not write.
    #[error("the handle names contents that no pass wrote; use the handle that `declare` returned for the write")]
    NotWritten,
    /// The resource is nowhere: memoryless, inlined or unused.
    #[error("`{resource}` has no memory ({why}); only attachments can be used so")]
    Nowhere {
        /// The resource.
        resource: String,
        /// Why not.
        why: &'static str,
    },
    /// Commands of another kind of pass.
    #[error("{asked} was asked for in a {kind} pass; declare the pass's accesses so that it becomes one, or split it")]
    WrongKind {
        /// What was asked for.
        asked: &'static str,
        /// The kind of the open step.
        kind: &'static str,
    },
    /// A pass was made the end of this one's shader, and does not say what it does.
    #[error(
        "`{pass}` is inlined into this pass, but does not say what it does to a color; implement `Record::epilogue` for it, \
         do not declare it point-wise, or compile with `Options::inline` off"
    )]
    NoEpilogue {
        /// The inlined pass.
        pass: String,
    },
    /// Two inlined passes set one constant or binding of an effect to different values.
    #[error(
        "two inlined passes give {0} different values; keep one of them a pass of its own (`PassBuilder::never_merge`)"
    )]
    EffectTwice(EffectSetting),
    /// A shader or pipeline.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The device.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The pass's own reason.
    #[error("{0}")]
    Custom(String),
}

impl RecordError {
    /// A reason of the pass's own.
    pub fn custom(message: impl Into<String>) -> Self {
        Self::Custom(message.into())
    }
}

/// A frame was not executed. Nothing of it reached the GPU, and the next one starts clean.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExecuteError {
    /// The plan is of another frame.
    #[error("the plan was not compiled from this frame as it is declared now; compile it again")]
    OtherPlan,
    /// A pass cannot be recorded.
    #[error("pass `{pass}` has no recorder; add it with `Frame::add` instead of `Graph::add`")]
    NoRecorder {
        /// The pass.
        pass: String,
    },
    /// A recorder failed.
    #[error("pass `{pass}`: {error}")]
    Record {
        /// The pass.
        pass: String,
        /// Why.
        error: RecordError,
    },
    /// Passes were made epilogues of a shader whose recorder did not look.
    #[error(
        "pass `{pass}` declares that its shader takes epilogues, but its recorder did not ask for them; call `Cx::epilogues`"
    )]
    EpilogueIgnored {
        /// The pass.
        pass: String,
    },
    /// More layers are attached at once than the device can draw into.
    #[error(
        "`{resource}` is attached with {layers} layers at once; {adapter} offers {most}; attach one layer in each pass: \
         `texture.layer(n)`"
    )]
    Layers {
        /// The resource.
        resource: String,
        /// How many.
        layers: u16,
        /// How many there may be.
        most: u32,
        /// The adapter in words.
        adapter: String,
    },
    /// wgpu tracks depth and stencil of a texture together.
    #[error(
        "`{resource}` is read in one plane and written in the other by one step; wgpu allows that for no texture with depth \
         and stencil: use two textures, or copy the plane that is read"
    )]
    Planes {
        /// The resource.
        resource: String,
    },
    /// A render pass of wgpu draws into something.
    #[error("raster pass `{pass}` attaches nothing; attach a texture, or declare it as a compute pass")]
    NoAttachment {
        /// The pass.
        pass: String,
    },
    /// Contents cannot be cleared that way.
    #[error("`{resource}` cannot be cleared to that value outside of a render pass; clear to zero, or overwrite it")]
    Clear {
        /// The resource.
        resource: String,
    },
    /// The plan places resources in a heap, which this back end has not.
    #[error("`{resource}` is placed in a heap, which this device has not; compile with `Caps` of this device")]
    Heap {
        /// The resource.
        resource: String,
    },
    /// An import.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// A texture or buffer that the device cannot make.
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    /// The device.
    #[error(transparent)]
    Device(#[from] DeviceError),
}
