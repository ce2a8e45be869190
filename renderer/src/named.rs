//! Names of passes and resources in errors.

use framegraph::{PassId, Plan, ResourceId, sanitize};
use std::fmt;

/// A pass or resource that an error refers to, by ID and full name. The name outlives the graph. `Display` shortens it
/// to one line with [`framegraph::sanitize::name`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named<I> {
    /// ID in the graph that was executed.
    pub id: I,
    /// Full name, including scopes.
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
    fn names_in_errors_are_short_and_on_one_line() {
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
        for report in errors.map(|error| error.to_string()) {
            assert!(report.starts_with("pass `bl\\u{1b}[31mur\\nxxx"), "{}", &report[..99]);
            // Two names of 120 characters, and wgpu's message of at most 4,000.
            assert!(report.len() < 5000 && !report.contains(char::is_control), "{} bytes", report.len());
        }
    }
}
