//! What is probably not meant: said by every output of a plan, and no error.

use crate::plan::Plan;
use crate::words::words;

/// Something about a plan that its user probably did not mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Warning {
    /// Passes were declared, and none of them runs: nothing says what the frame is for.
    NothingRuns,
}

words! { Warning: NothingRuns "nothing_runs" }

impl Warning {
    /// What is wrong, and what to do about it.
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::NothingRuns => {
                "no pass runs, since nothing that is kept needs one; export what the frame is for, import its target with \
                 `Exit::Keep`, or declare a side effect"
            }
        }
    }
}

impl Plan {
    /// What is probably not meant.
    pub fn warnings(&self) -> impl Iterator<Item = Warning> {
        let idle = self.compilation != 0 && self.steps.is_empty() && !self.graph.passes().is_empty();
        idle.then_some(Warning::NothingRuns).into_iter()
    }
}
