//! Answers to what-if questions, compiled from the graph of a plan.

use crate::plan_data::PlanData;
use crate::what_if::{Planner, WhatIf};
use framegraph::{Options, Plan, Scratch, compile};
use std::sync::Arc;

/// A plan whose graph is compiled under other conditions.
pub struct Recompiled(pub Arc<Plan>);

/// Returns the conditions under which a plan was compiled.
pub fn conditions(plan: &Plan) -> WhatIf {
    let Options { frame, order, alias, cull, merge, inline, memoryless, .. } = *plan.options();
    WhatIf { frame: Some(frame), order, alias, cull, merge, inline, memoryless, ..WhatIf::on(plan.caps().clone()) }
}

impl Planner for Recompiled {
    fn name(&self) -> &'static str {
        "frame"
    }

    fn features(&self) -> Vec<(String, bool)> {
        Vec::new()
    }

    fn plan(&self, what_if: &WhatIf) -> Result<PlanData, String> {
        let WhatIf { caps, frame, order, alias, cull, merge, inline, memoryless, .. } = what_if.clone();
        let frame = frame.unwrap_or(self.0.frame());
        let own = *self.0.options();
        let options = Options { frame, order, alias, cull, merge, inline, memoryless, ..own };
        let mut plan = Plan::new();
        compile(self.0.graph(), &caps, &options, &mut Scratch::new(), &mut plan).map_err(|e| e.to_string())?;
        PlanData::of(&plan, "frame").map_err(|e| e.to_string())
    }
}
