//! Answers to what-if questions, compiled from the graph of a plan.

use crate::plan_data::PlanData;
use crate::what_if::{Planner, WhatIf};
use framegraph::{Plan, Scratch, compile};
use std::sync::Arc;

/// A plan whose graph is compiled under other conditions.
pub struct Recompiled(pub Arc<Plan>);

impl Planner for Recompiled {
    fn name(&self) -> &'static str {
        "frame"
    }

    fn features(&self) -> Vec<(String, bool)> {
        Vec::new()
    }

    fn plan(&self, what_if: &WhatIf) -> Result<PlanData, String> {
        let options = what_if.options(*self.0.options());
        let mut plan = Plan::new();
        compile(self.0.graph(), &what_if.caps, &options, &mut Scratch::new(), &mut plan).map_err(|e| e.to_string())?;
        PlanData::of(&plan, "frame").map_err(|e| e.to_string())
    }
}
