//! Why stages were refused.

use super::slot::SlotFault;
use framegraph::DeclareError;

/// A list of stages cannot be changed or declared as asked.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StageError {
    /// No stage has that name.
    #[error("there is no stage `{name}`; the stages are {}", .known.join(", "))]
    Unknown {
        /// The name asked for.
        name: String,
        /// The names that there are, in order.
        known: Vec<&'static str>,
    },
    /// Another stage has that name.
    #[error("there is a stage `{name}` already; choose another name, or replace it")]
    Twice {
        /// The name.
        name: &'static str,
    },
    /// A stage needs what no stage has handed on.
    #[error("stage `{stage}` needs `{slot}`, which no stage before it handed on (`Handles::set`)")]
    Missing {
        /// The stage; `the caller` outside of stages.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
    },
    /// A stage handed on a handle of another frame.
    #[error("stage `{stage}` handed on a `{slot}` of another frame, or of before this one was reset")]
    Foreign {
        /// The stage.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
    },
    /// A stage handed on a texture that the slot cannot hold.
    #[error("stage `{stage}` handed on `{texture}` as `{slot}`: {fault}")]
    Wrong {
        /// The stage.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
        /// Full name of the texture.
        texture: String,
        /// Why not.
        fault: SlotFault,
    },
    /// A stage would write over what an earlier one wrote.
    #[error(
        "stage `{stage}` draws into `{samples}` and averages that into `{slot}`, which would lose what stage `{by}` wrote; \
         insert that stage after `{stage}`, or hand on `{samples}` with the same in it, and `{slot}` as its average"
    )]
    Lost {
        /// The stage that would write.
        stage: &'static str,
        /// Name of the slot whose texture would be written over.
        slot: &'static str,
        /// Name of the slot of its samples.
        samples: &'static str,
        /// The stage that handed the texture on.
        by: &'static str,
    },
    /// The picture did not end where the frame's picture is to go.
    #[error(
        "stage `{stage}` left the picture in `{texture}`, which is not the frame's target; make the stage with \
         `Stage::picture`, and draw into `Handles::target`"
    )]
    OtherTarget {
        /// The stage that handed the picture on last.
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
