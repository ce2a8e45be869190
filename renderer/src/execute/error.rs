//! Errors of executing a frame.

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
    /// `override` constant with this name.
    Constant(&'static str),
    /// Binding of the variable with this name.
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

/// Error of a recorder.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum RecordError {
    /// Handle or token of another graph, or from before a reset.
    #[error(
        "the handle or token belongs to another graph or a frame before a reset; use the value that `declare` returned"
    )]
    Foreign,
    /// Token of another pass.
    #[error(
        "`{resource}` is accessed as `{}`, which this pass did not declare; declare it, or use the pass's own handle", .access.word()
    )]
    Undeclared {
        /// Resource of the access.
        resource: Named<ResourceId>,
        /// Kind of access.
        access: AccessKind,
    },
    /// Handle of contents that this pass did not write.
    #[error("no pass wrote the contents that this handle names; use the handle that `declare` returned for the write")]
    NotWritten,
    /// The resource has no texture or buffer: it is memoryless, inlined or unused.
    #[error("`{resource}` cannot be looked up: {why}")]
    NoMemory {
        /// Resource without memory.
        resource: Named<ResourceId>,
        /// Reason.
        why: NoMemory,
    },
    /// Commands of another kind of pass were requested.
    #[error(
        "{} was requested in a {} pass; declare accesses of the requested kind, or split the pass",
        match .requested {
            PassKind::Raster => "a render pass",
            PassKind::Compute => "a compute pass",
            PassKind::Copy => "the encoder",
        },
        .actual.word()
    )]
    WrongKind {
        /// Kind of pass whose commands were requested.
        requested: PassKind,
        /// Kind of the current pass.
        actual: PassKind,
    },
    /// An inlined pass returns no epilogue.
    #[error(
        "`{pass}` is inlined into this pass but returns no epilogue; implement `Record::epilogue` for it, do not declare it \
         point-wise, or compile with `Options::inline` off"
    )]
    NoEpilogue {
        /// Inlined pass.
        pass: Named<PassId>,
    },
    /// Two inlined passes set a constant or binding of one effect to different values.
    #[error(
        "two inlined passes set {0} to different values; keep one of them separate with `PassBuilder::never_merge`"
    )]
    EffectConflict(EffectSetting),
    /// wgpu rejected a texture view.
    #[error("wgpu rejected a view of `{resource}`: {message}")]
    View {
        /// Resource of the view.
        resource: Named<ResourceId>,
        /// Reason given by wgpu, on one line.
        message: String,
    },
    /// wgpu rejected a range of draws ([`Cx::draw_split`](crate::Cx::draw_split)).
    #[error("wgpu rejected the draws from {first} to {end}: {message}")]
    Draws {
        /// First draw of the range.
        first: u32,
        /// End of the range.
        end: u32,
        /// Reason given by wgpu, on one line.
        message: String,
    },
    /// A bind group was rejected, or the pipeline has no such group.
    #[error(transparent)]
    Binding(Box<BindingError>),
    /// A shader or pipeline does not compile.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The device is lost, or rejected a call.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The content exceeds a limit of the device, for example a scene that is too large.
    #[error("{0}")]
    Content(PassReason),
    /// Error of the pass itself.
    #[error("{0}")]
    Custom(PassReason),
}

/// Error of a pass, which may be of any type. Compares equal to errors with the same message.
#[derive(Clone)]
pub struct PassReason(Arc<dyn Error + Send + Sync>);

impl PassReason {
    /// Returns the error if it has the type `E`.
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
    /// Creates an error of the pass itself, from an error or a message.
    pub fn custom(reason: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::Custom(PassReason(reason.into().into()))
    }

    /// Creates an error for content that exceeds a limit of the device.
    pub fn content(reason: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::Content(PassReason(reason.into().into()))
    }
}

/// Error of a frame that was not executed. Nothing of it was submitted, and the next frame starts clean.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExecuteError {
    /// The plan belongs to another frame.
    #[error("the plan was not compiled from the current declaration of this frame; compile it again")]
    OtherPlan,
    /// A pass has no recorder.
    #[error("pass `{pass}` has no recorder; add it with `Frame::add` instead of `Graph::add`")]
    NoRecorder {
        /// Pass without a recorder.
        pass: Named<PassId>,
    },
    /// A recorder failed.
    #[error("pass `{pass}`: {error}")]
    Record {
        /// Pass of the recorder.
        pass: Named<PassId>,
        /// Error that the recorder returned.
        error: RecordError,
    },
    /// wgpu rejected the commands of a pass. The frame was recorded again to find the pass.
    #[error("pass `{pass}`: wgpu rejected its commands: {message}")]
    Refused {
        /// Rejected pass.
        pass: Named<PassId>,
        /// Reason given by wgpu, on one line.
        message: String,
    },
    /// wgpu rejected the submission of the frame, although its commands were valid. The cause is a resource that they
    /// use, or another command buffer of the submission.
    #[error(
        "wgpu rejected the submission of the frame: {message}; {}", match .import {
            Some(import) => format!("the import `{import}` must be neither destroyed nor mapped until the frame is submitted"),
            None => "the frame's commands and imports are valid: check other command buffers of the submission, and undeclared \
                     resources that recorders bind".into(),
        }
    )]
    Submission {
        /// Import that cannot be used, if that is the cause.
        import: Option<Named<ResourceId>>,
        /// Reason given by wgpu, on one line.
        message: String,
    },
    /// A pass has inlined passes, but its recorder did not request the epilogues.
    #[error("pass `{pass}` declares `takes_epilogue`, but its recorder ignores its epilogues; call `Cx::epilogues`")]
    EpilogueIgnored {
        /// Pass that ignores its epilogues.
        pass: Named<PassId>,
    },
    /// More layers are attached at once than the device supports.
    #[error(
        "`{resource}` is attached with {layers} layers at once, but {} supports {max}; attach one layer per pass with \
         `texture.layer(n)`",
        describe(.adapter)
    )]
    Layers {
        /// Attached resource.
        resource: Named<ResourceId>,
        /// Number of layers that the pass attaches.
        layers: u16,
        /// Maximum number of layers that the device can attach at once.
        max: u32,
        /// Adapter of the device.
        adapter: Box<AdapterInfo>,
    },
    /// A step reads one plane of a depth-stencil texture and writes the other, which wgpu does not support.
    #[error(
        "a step reads one plane of `{resource}` and writes the other, which wgpu does not support for depth-stencil textures; \
         use two textures, or copy the plane that is read"
    )]
    Planes {
        /// Depth-stencil resource.
        resource: Named<ResourceId>,
    },
    /// A raster pass has no attachments, which wgpu does not support.
    #[error("raster pass `{pass}` has no attachments; attach a texture, or declare it as a compute pass")]
    NoAttachment {
        /// Pass without attachments.
        pass: Named<PassId>,
    },
    /// The plan has a resolve mode other than average in a store operation, which wgpu does not support.
    #[error(
        "`{resource}` is resolved with mode `{}` in a store operation, which this device does not support; compile with the \
         `Caps` of this device, which use a full-screen pass", .mode.word()
    )]
    StoreResolve {
        /// Resolve target.
        resource: Named<ResourceId>,
        /// Resolve mode.
        mode: ResolveMode,
    },
    /// The contents cannot be cleared to the requested value.
    #[error("`{resource}` cannot be cleared to this value outside of a render pass; clear it to zero, or overwrite it")]
    Clear {
        /// Resource to clear.
        resource: Named<ResourceId>,
    },
    /// The plan places a resource in a heap that does not exist on this device, or where it does not fit.
    #[error(
        "`{resource}` is placed in a heap that this device does not have, or has in another size; compile with \
         `Executor::compile`, which queries the driver"
    )]
    Heap {
        /// Placed resource.
        resource: Named<ResourceId>,
    },
    /// The frame cannot be recorded into one command encoder.
    #[error(
        "textures of the frame share memory, which needs several command buffers; compile with `Alias::Pool`, or record \
         with `Executor::record`"
    )]
    SharedMemory,
    /// The driver cannot create the placed resources.
    #[error("the frame's textures cannot share one block of memory: {0}; compile with `Alias::Pool`")]
    NotPlaced(#[from] NotPlaced),
    /// The device is out of memory for the textures and buffers of the frame.
    #[error("the device is out of memory while creating {0}; use a smaller frame, fewer samples or smaller textures")]
    OutOfMemory(Box<MemoryRequest>),
    /// An import is missing, or does not match its declaration.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// The device does not support a texture or buffer.
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    /// The device is lost, or rejected a call.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl fmt::Debug for ExecuteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Memory that a frame needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MemoryRequest {
    /// Size of all textures and buffers of the plan, in bytes.
    pub bytes: u64,
    /// Largest resource, with its size in bytes.
    pub largest: Option<(Named<ResourceId>, u64)>,
    /// Adapter of the device.
    pub adapter: AdapterInfo,
}

impl fmt::Display for MemoryRequest {
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
