//! Passes and resources in errors.

use framegraph::{PassId, Plan, ResourceId, sanitize};
use std::fmt;

/// A pass or resource that an error is about: its row in the graph, and its full name, which outlives the graph. Shown on one
/// line and shortened, as [`framegraph::sanitize::name`] has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named<I> {
    /// The row in the graph that was executed.
    pub id: I,
    /// The full name.
    pub name: String,
}

impl Named<PassId> {
    pub(crate) fn pass(plan: &Plan, id: PassId) -> Self {
        Self { id, name: plan.graph().pass_name(id).to_owned() }
    }
}

impl Named<ResourceId> {
    pub(crate) fn resource(plan: &Plan, id: ResourceId) -> Self {
        Self { id, name: plan.graph().resource_name(id).to_owned() }
    }
}

impl<I> fmt::Display for Named<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&sanitize::name(&self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::error::{ExecuteError, RecordError};

    #[test]
    fn names_in_errors_stay_on_their_line_and_are_cut() {
        let long = format!("bl\u{1b}[31mur\n{}", "x".repeat(1 << 20));
        let pass = Named { id: PassId::at(0), name: long.clone() };
        let resource = Named { id: ResourceId::at(0), name: long.clone() };
        let refused = crate::device::error::one_line(&format!("Texture '{long}'\n\nCaused by:\n  '{long}'"));
        let errors = [
            ExecuteError::NoRecorder { pass: pass.clone() },
            ExecuteError::Record {
                pass: pass.clone(),
                error: RecordError::View { resource, message: refused.clone() },
            },
            ExecuteError::Refused { pass, message: refused },
        ];
        for told in errors.map(|error| error.to_string()) {
            assert!(told.starts_with("pass `bl\\u{1b}[31mur\\nxxx"), "{}", &told[..99]);
            // Two names of 120 characters, and what wgpu said: 4,000.
            assert!(told.len() < 5000 && !told.contains(char::is_control), "{} bytes", told.len());
        }
    }
}
