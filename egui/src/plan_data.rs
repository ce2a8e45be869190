//! A plan as named rows, for live and saved plans alike.
//!
//! The rows are the fields of the JSON form (`docs/reference/plan-json.md`), which programs save with [`framegraph::dump::json`]. A
//! live plan is converted through JSON too, so one reader and one set of views suffice.

mod data;
mod part;
mod read;
mod rows;

pub use data::PlanData;
pub use read::{ReadError, read};
pub use rows::*;

use framegraph::Plan;

impl PlanData {
    /// Converts a plan of this process, with the source locations of its passes.
    ///
    /// # Errors
    /// No known cause, since the library reads its own output.
    pub fn of(plan: &Plan, name: &str) -> Result<Self, ReadError> {
        let mut data = read(framegraph::dump::json(plan, name).as_bytes())?;
        data.declared_at = plan.graph().passes().iter().map(|p| p.location.to_string()).collect();
        data.plan = Some(std::sync::Arc::new(plan.clone()));
        Ok(data)
    }
}
