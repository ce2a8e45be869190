//! A plan as the panels see it: plain rows with names, the same for a plan that was just made and for one that was saved.
//!
//! The rows are the fields of the JSON form (`docs/plan-json.md`), which is what any program saves through the library
//! ([`framegraph::dump::json`]). A live plan takes the same way, so that there is one reader and one set of views.

mod data;
mod read;
mod rows;

pub use data::PlanData;
pub use read::{ReadError, read};
pub use rows::*;

use framegraph::Plan;

impl PlanData {
    /// A plan of this program, with the places in its code where passes were declared.
    ///
    /// # Errors
    /// None that a plan can cause: the library's own text is read back.
    pub fn of(plan: &Plan, name: &str) -> Result<Self, ReadError> {
        let mut data = read(framegraph::dump::json(plan, name).as_bytes())?;
        data.declared_at = plan.graph().passes().iter().map(|p| p.location.to_string()).collect();
        data.plan = Some(std::sync::Arc::new(plan.clone()));
        Ok(data)
    }
}
