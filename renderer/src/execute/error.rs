//! Why a frame could not be executed.

use crate::device::adapter::describe;
use crate::device::error::DeviceError;
use crate::named::Named;
use crate::pipelines::binding_error::BindingError;
use crate::pipelines::shader::ShaderError;
use crate::placed::not_placed::NotPlaced;
use crate::resources::imports::ImportError;
use crate::resources::no_memory::NoMemory;
use crate::resources::support::Unsupported;
use framegraph::{AccessKind, PassId, PassKind, ResolveMode, ResourceId};
use std::error::Error;
use std::fmt;
use std::sync::Arc;
use wgpu::AdapterInfo;

/// A setting of an effect that occurs twice in one shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EffectSetting {
    /// An `override` constant, by name.
    Constant(&'static str),
    /// What a variable is bound to, by its name.
    Binding(&'static str),
}

impl fmt::Display for EffectSetting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(name) => write!(f, "the constant `{name}`"),
            Self::Binding(name) => write!(f, "the binding of `{name}`"),
        }
    }
}

/// A recorder was refused something, or refused itself.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum RecordError {
    /// A handle or token of another graph, or from before a reset.
    #[error("a handle or token is of another graph, or from before the frame was reset; use what `declare` returned")]
    Foreign,
    /// A token of another pass.
    #[error(
        "`{resource}` is touched as `{}`, which this pass did not declare; declare it, or use the pass's own handle", .access.word()
    )]
    Undeclared {
        /// The resource concerned.
        resource: Named<ResourceId>,
        /// The kind of access.
        access: AccessKind,
    },
    /// A handle that this pass did not write.
    #[error("the handle names contents that no pass wrote; use the handle that `declare` returned for the write")]
    NotWritten,
    /// No texture or buffer stands behind the resource: it is memoryless, inlined or unused.
    #[error("`{resource}` has no memory ({why}); only attachments can be used so")]
    NoMemory {
        /// The resource concerned.
        resource: Named<ResourceId>,
        /// The reason.
        why: NoMemory,
    },
    /// Commands of another kind of pass.
    #[error(
        "{} was asked for in a {} pass; declare the pass's accesses so that it becomes one, or split it",
        match .asked {
            PassKind::Raster => "a render pass",
            PassKind::Compute => "a compute pass",
            PassKind::Copy => "the encoder",
        },
        .open.word()
    )]
    WrongKind {
        /// The kind of pass whose commands were asked for.
        asked: PassKind,
        /// The kind of the open step.
        open: PassKind,
    },
    /// A pass was made the end of this one's shader, and does not say what it does.
    #[error(
        "`{pass}` is inlined into this pass, but does not say what it does to a color; implement `Record::epilogue` for it, \
         do not declare it point-wise, or compile with `Options::inline` off"
    )]
    NoEpilogue {
        /// The inlined pass.
        pass: Named<PassId>,
    },
    /// Two inlined passes set one constant or binding of an effect to different values.
    #[error(
        "two inlined passes give {0} different values; keep one of them a pass of its own (`PassBuilder::never_merge`)"
    )]
    EffectTwice(EffectSetting),
    /// A view of a texture was refused.
    #[error("wgpu refused a view of `{resource}`: {message}")]
    View {
        /// The resource concerned.
        resource: Named<ResourceId>,
        /// wgpu's reason, on one line.
        message: String,
    },
    /// A bind group was refused, or the pipeline does not have it.
    #[error(transparent)]
    Binding(Box<BindingError>),
    /// A shader or pipeline does not compile.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The device is lost, or refused a call.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// What is to be drawn asks for more than the device can: the input is at fault, not the program or the device.
    #[error("{0}")]
    Content(PassReason),
    /// The pass's own reason.
    #[error("{0}")]
    Custom(PassReason),
}

/// Why a pass could not be recorded, in its own terms: any error, with its fields. Equal to others of the same sentence.
#[derive(Clone)]
pub struct PassReason(Arc<dyn Error + Send + Sync>);

impl PassReason {
    /// The pass's error, if it is of that type.
    pub fn downcast_ref<E: Error + 'static>(&self) -> Option<&E> {
        self.0.downcast_ref()
    }
}

impl PartialEq for PassReason {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_string() == other.0.to_string()
    }
}

impl Eq for PassReason {}

impl fmt::Display for PassReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

impl fmt::Debug for PassReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Debug for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl From<BindingError> for RecordError {
    fn from(error: BindingError) -> Self {
        Self::Binding(Box::new(error))
    }
}

impl RecordError {
    /// A reason of the pass's own: its error, or a sentence.
    pub fn custom(reason: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::Custom(PassReason(reason.into().into()))
    }

    /// What is to be drawn asks for more than the device can: an error that says so.
    pub fn content(reason: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::Content(PassReason(reason.into().into()))
    }
}

/// A frame was not executed. Nothing of it reached the GPU, and the next one starts clean.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExecuteError {
    /// The plan is of another frame.
    #[error("the plan was not compiled from this frame as it is declared now; compile it again")]
    OtherPlan,
    /// A pass cannot be recorded.
    #[error("pass `{pass}` has no recorder; add it with `Frame::add` instead of `Graph::add`")]
    NoRecorder {
        /// The pass concerned.
        pass: Named<PassId>,
    },
    /// A recorder failed.
    #[error("pass `{pass}`: {error}")]
    Record {
        /// The pass concerned.
        pass: Named<PassId>,
        /// What its recorder returned.
        error: RecordError,
    },
    /// wgpu refused the commands of a pass. The error scopes of a frame do not tell passes apart; the frame was recorded
    /// once more to find this one.
    #[error("pass `{pass}`: wgpu refused its commands: {message}")]
    Refused {
        /// The pass concerned.
        pass: Named<PassId>,
        /// wgpu's reason, on one line.
        message: String,
    },
    /// wgpu refused the frame's commands when they were submitted. They were sound when they were finished, so it is about what
    /// they use or what was submitted with them.
    #[error(
        "wgpu refused to submit the frame: {message}; {}", match .import {
            Some(import) => format!("the import `{import}` must be neither destroyed nor mapped until the frame is submitted"),
            None => "the frame's own commands and imports are sound: look at command buffers that were submitted with them, and \
                     at what recorders bind beside what their passes declare".into(),
        }
    )]
    Submission {
        /// The import that cannot be used, where that is the reason.
        import: Option<Named<ResourceId>>,
        /// wgpu's reason, on one line.
        message: String,
    },
    /// Passes were made epilogues of a shader whose recorder did not look.
    #[error(
        "pass `{pass}` declares that its shader takes epilogues, but its recorder did not ask for them; call `Cx::epilogues`"
    )]
    EpilogueIgnored {
        /// The pass concerned.
        pass: Named<PassId>,
    },
    /// More layers are attached at once than the device can draw into.
    #[error(
        "`{resource}` is attached with {layers} layers at once; {} offers {most}; attach one layer in each pass: \
         `texture.layer(n)`",
        describe(.adapter)
    )]
    Layers {
        /// The resource concerned.
        resource: Named<ResourceId>,
        /// Layers that the pass attaches.
        layers: u16,
        /// Layers that the device can draw into at once.
        most: u32,
        /// The adapter of the device.
        adapter: Box<AdapterInfo>,
    },
    /// wgpu tracks depth and stencil of a texture together.
    #[error(
        "`{resource}` is read in one plane and written in the other by one step; wgpu allows that for no texture with depth \
         and stencil: use two textures, or copy the plane that is read"
    )]
    Planes {
        /// The resource concerned.
        resource: Named<ResourceId>,
    },
    /// A render pass of wgpu draws into something.
    #[error("raster pass `{pass}` attaches nothing; attach a texture, or declare it as a compute pass")]
    NoAttachment {
        /// The pass concerned.
        pass: Named<PassId>,
    },
    /// wgpu resolves colors by their average alone while it stores them.
    #[error(
        "`{resource}` gets the resolve `{}` in the store of its step, which this device does not do; compile with `Caps` of \
         this device, and a full-screen pass does it", .mode.word()
    )]
    StoreResolve {
        /// The target.
        resource: Named<ResourceId>,
        /// What is to be made of the samples.
        mode: ResolveMode,
    },
    /// Contents cannot be cleared that way.
    #[error("`{resource}` cannot be cleared to that value outside of a render pass; clear to zero, or overwrite it")]
    Clear {
        /// The resource concerned.
        resource: Named<ResourceId>,
    },
    /// The plan places a resource in a heap that this device has not, or where it does not fit.
    #[error(
        "`{resource}` is placed in a heap that this device has not, or has in other sizes; compile with `Executor::compile`, \
         which asks the driver"
    )]
    Heap {
        /// The resource concerned.
        resource: Named<ResourceId>,
    },
    /// The driver does not make what the plan places in a heap.
    #[error("the frame's textures cannot share one block of memory: {0}; compile with `Alias::Pool`")]
    NotPlaced(#[from] NotPlaced),
    /// The device has no memory left for the frame's textures and buffers.
    #[error("the device is out of memory while making {0}; use a smaller frame, fewer samples or smaller textures")]
    OutOfMemory(Box<MemoryAsked>),
    /// An import is missing, or is not what was declared.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// A texture or buffer that the device cannot make.
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    /// The device is lost, or refused a call.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl fmt::Debug for ExecuteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// What a frame asks of the device's memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MemoryAsked {
    /// All textures and buffers of the plan, in bytes.
    pub bytes: u64,
    /// The largest of them, with its bytes.
    pub largest: Option<(Named<ResourceId>, u64)>,
    /// The adapter of the device.
    pub adapter: AdapterInfo,
}

impl fmt::Display for MemoryAsked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        write!(f, "a frame's textures and buffers ({:.1} MiB", mib(self.bytes))?;
        if let Some((resource, bytes)) = &self.largest {
            write!(f, ", {:.1} MiB of them for `{resource}`", mib(*bytes))?;
        }
        write!(f, ") on {}", describe(&self.adapter))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pass_gets_its_own_error_back() {
        let own = DeviceError::OutOfMemory { doing: "drawing" };
        let RecordError::Content(reason) = RecordError::content(own.clone()) else { panic!("it was the content") };
        assert_eq!(reason.downcast_ref::<DeviceError>(), Some(&own));
        assert_eq!(reason.downcast_ref::<ShaderError>(), None);
        assert_eq!(reason.to_string(), own.to_string());
        assert_eq!(RecordError::custom("no camera"), RecordError::custom(String::from("no camera")));
        assert_ne!(RecordError::custom("no camera"), RecordError::content("no camera"));
    }
}
