//! Errors of stages.

use super::slot::SlotFault;
use framegraph::DeclareError;

/// Error of changing or declaring a list of stages.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StageError {
    /// No stage has this name.
    #[error("there is no stage `{name}`; the stages are {}", .known.join(", "))]
    Unknown {
        /// The requested name.
        name: String,
        /// Existing names, in order.
        known: Vec<&'static str>,
    },
    /// Another stage has this name.
    #[error("there is a stage `{name}` already; choose another name, or replace it")]
    Twice {
        /// The name.
        name: &'static str,
    },
    /// A stage needs a texture that no earlier stage set.
    #[error("stage `{stage}` needs `{slot}`, which no stage before it handed on (`Handles::set`)")]
    Missing {
        /// The stage; `the caller` outside of stages.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
    },
    /// A stage set a handle of another frame.
    #[error("stage `{stage}` handed on a `{slot}` of another frame, or of before this one was reset")]
    Foreign {
        /// The stage.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
    },
    /// A stage set a texture that does not fit the slot.
    #[error("stage `{stage}` handed on `{texture}` as `{slot}`: {fault}")]
    Wrong {
        /// The stage.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
        /// Full name of the texture.
        texture: String,
        /// Reason.
        fault: SlotFault,
    },
    /// A stage would overwrite the result of an earlier one.
    #[error(
        "stage `{stage}` draws into `{samples}` and averages that into `{slot}`, which would lose what stage `{by}` wrote; \
         insert that stage after `{stage}`, or hand on `{samples}` with the same in it, and `{slot}` as its average"
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
        "stage `{stage}` left the picture in `{texture}`, which is not the frame's target; make the stage with \
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
