//! Plans and times of a live frame.

use super::Session;
use crate::panel::Questions;
use crate::plan_data::PlanData;
use crate::trace_data::TraceData;
use crate::what_if::{Planner, WhatIf};
use std::sync::Arc;

impl Session {
    /// Shows the plan of the live frame and sets its planner.
    ///
    /// The what-if changes are kept. If `changed` is set, the user changed the frame, and the previous plan is kept for
    /// comparison.
    pub fn show_live(&mut self, planner: Arc<dyn Planner>, base: WhatIf, plan: Arc<PlanData>, changed: bool) {
        (self.watch, self.shown) = (None, None);
        let old = if std::mem::replace(&mut self.live, true) { self.base.take() } else { None };
        if changed {
            self.before = old;
        }
        let asked = match &self.questions {
            Some(Questions { base: was, asked, .. }) if asked != was => {
                let features = self.features(&*planner, asked);
                WhatIf { features, ..asked.moved(was, &base) }
            }
            _ => base.clone(),
        };
        let same = asked == base;
        let mut questions = Questions::new(base);
        questions.asked = asked;
        (self.questions, self.planner, self.base) = (Some(questions), Some(planner), Some(plan.clone()));
        if same {
            self.put(plan);
        } else {
            self.generation += 1;
            self.ask();
        }
    }

    /// Closes the plan, so that the live frame shows its own.
    pub fn forget_plan(&mut self) {
        (self.plan, self.planner, self.questions, self.base, self.watch) = (None, None, None, None, None);
        self.shown = None;
        self.generation += 1;
    }

    /// Returns whether the displayed frame is live.
    pub fn is_live(&self) -> bool {
        self.live
    }

    /// Replaces the frame times, and redraws the views that show them.
    pub fn take_times(&mut self, trace: TraceData) {
        self.trace = Some(Arc::new(trace));
        self.times += 1;
    }

    /// Counts changes of times only.
    pub fn times(&self) -> u64 {
        self.times
    }
}
