//! Data that all views show.

use crate::drawing::Item;
use crate::plan_data::PlanData;
use crate::trace_data::TraceData;
use crate::view::{ViewContext, graph};
use std::sync::Arc;

/// Data that all views show. Large drawings are created on another thread, so plans are shared.
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewData<'a> {
    /// Shown plan.
    pub plan: Option<&'a Arc<PlanData>>,
    /// Plan to compare with.
    pub against: Option<&'a Arc<PlanData>>,
    /// Frame times.
    pub trace: Option<&'a Arc<TraceData>>,
    /// Selected item.
    pub selected: Option<Item>,
    /// Counts changes of the plans and of the trace's file.
    pub generation: u64,
    /// Counts changes of times alone.
    pub times: u64,
}

impl<'a> ViewData<'a> {
    /// Returns the data that views show in addition to the plan.
    pub fn context(&self) -> ViewContext<'a> {
        ViewContext {
            against: self.against.map(|plan| &**plan),
            trace: self.trace.map(|trace| &**trace),
            selected: self.selected,
        }
    }

    /// Returns the selected item and the items related to it.
    pub fn lit(&self) -> Vec<Item> {
        self.selected.zip(self.plan).map(|(item, plan)| graph::lit(plan, item)).unwrap_or_default()
    }
}
