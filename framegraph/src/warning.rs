//! Warnings: plans that are valid but probably unintended.

use crate::enum_names::enum_names;
use crate::plan::Plan;

/// A property of a plan that is probably unintended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Warning {
    /// The graph has passes, but none of them runs, because nothing is exported.
    NothingRuns,
}

enum_names! { Warning: NothingRuns "nothing_runs" }

impl Warning {
    /// Returns the problem and a way to fix it.
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::NothingRuns => {
                "no pass runs, because no result is used; export a resource, import the target with \
                 `Exit::Keep`, or declare a side effect"
            }
        }
    }
}

impl Plan {
    /// Returns the warnings about this plan.
    pub fn warnings(&self) -> impl Iterator<Item = Warning> {
        let idle = self.compilation != 0 && self.steps.is_empty() && !self.graph.passes().is_empty();
        idle.then_some(Warning::NothingRuns).into_iter()
    }
}
