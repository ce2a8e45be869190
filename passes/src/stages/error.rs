//! Errors of stages.

use super::slot::SlotFault;
use framegraph::DeclareError;
use std::panic::Location;

/// Error of changing or declaring a list of stages.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StageError {
    /// No stage has this name.
    #[error("unknown stage `{name}`; use one of {}", .known.join(", "))]
    Unknown {
        /// The requested name.
        name: String,
        /// Existing names, in order.
        known: Vec<&'static str>,
    },
    /// Another stage has this name.
    #[error("stage `{name}`: the name is already in use; choose another one, or replace the stage")]
    Twice {
        /// The name.
        name: &'static str,
    },
    /// A stage needs a texture that no earlier stage set.
    #[error("stage `{stage}`: needs `{slot}`, but no earlier stage has set it; call `Handles::set`")]
    Missing {
        /// The stage; `the caller` outside of stages.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
    },
    /// A stage set a handle of another frame.
    #[error(
        "stage `{stage}`: the texture for `{slot}` is of another frame, or older than the last reset (at {}:{}); set one of \
         this frame", .at.file(), .at.line()
    )]
    Foreign {
        /// The stage.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
        /// Code that set the texture.
        at: &'static Location<'static>,
    },
    /// Shadow maps were set without the view that they are drawn for.
    #[error(
        "stage `{stage}`: `{slot}` is set without the view that the shadow maps are drawn for (at {}:{}); use \
         `Handles::sharing_shadows`, or `Handles::with_shadow_maps` with the result of `shadow_maps`",
        .at.file(), .at.line()
    )]
    MapsOfUnknownView {
        /// The stage.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
        /// Code that set the texture.
        at: &'static Location<'static>,
    },
    /// A stage set a texture that does not fit the slot.
    #[error("stage `{stage}`: cannot set `{slot}` to `{texture}`: {fault} (at {}:{})", .at.file(), .at.line())]
    Wrong {
        /// The stage.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
        /// Full name of the texture.
        texture: String,
        /// Reason.
        fault: SlotFault,
        /// Code that set the texture.
        at: &'static Location<'static>,
    },
    /// A stage would overwrite the result of an earlier one.
    #[error(
        "stage `{stage}`: resolving `{samples}` into `{slot}` would overwrite the result of stage `{by}`; \
         insert `{by}` after `{stage}`, or let it write `{samples}` and set `{slot}` to the resolved texture"
    )]
    Lost {
        /// The stage that would write.
        stage: &'static str,
        /// Name of the slot that would be overwritten.
        slot: &'static str,
        /// Name of the slot of its samples.
        samples: &'static str,
        /// The stage that set the texture.
        by: &'static str,
    },
    /// The last picture is not in the frame's target.
    #[error(
        "stage `{stage}`: the picture is in `{texture}`, which is not the frame's target; create the stage with \
         `Stage::picture`, and draw into `Handles::target`"
    )]
    OtherTarget {
        /// The last stage that set the picture.
        stage: &'static str,
        /// Full name of the texture.
        texture: String,
    },
    /// A pass was refused.
    #[error(transparent)]
    Declare(#[from] DeclareError),
}

impl std::fmt::Debug for StageError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
