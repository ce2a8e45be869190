//! Drawings of the views, created when a view is first shown; those of large plans on a separate thread.

use super::view_data::ViewData;
use crate::drawing::{Drawing, Ink};
use crate::job::Job;
use crate::plan_data::PlanData;
use crate::view::{self, View, ViewContext};
use std::collections::BTreeMap;
use std::time::Duration;

/// Characters per line in the inspector.
const LETTERS: usize = 100;
/// Minimum number of passes whose drawings are created on a separate thread.
const MANY: usize = 250;
/// Maximum time to wait for a drawing in one frame.
const PATIENCE: Duration = Duration::from_millis(10);

/// Cached drawings.
#[derive(Default)]
pub(super) struct Drawings {
    made: BTreeMap<View, Drawing>,
    jobs: BTreeMap<View, Job<Drawing>>,
    /// Generation and times of the drawn data.
    of: [u64; 2],
}

impl Drawings {
    /// Drops outdated drawings.
    pub fn refresh(&mut self, data: ViewData<'_>) {
        let now = [data.generation, data.times];
        // If only times changed, views without times keep their drawings.
        let only_times = self.of[0] == now[0];
        let kept = |view: &View| only_times && !matches!(view, View::Timeline | View::Trace | View::Queues);
        if self.of != now {
            self.made.retain(|view, _| kept(view));
            self.jobs.retain(|view, _| kept(view));
            self.of = now;
        }
    }

    /// Returns the drawing of a view; `None` while it is created on another thread, which calls `wake` at the end.
    pub fn get(&mut self, view: View, data: ViewData<'_>, wake: impl FnOnce() + Send + 'static) -> Option<&Drawing> {
        if !self.made.contains_key(&view) {
            let passes = data.plan.map_or(0, |plan| plan.form.passes.len());
            if passes < MANY || !view.is_of_a_plan() {
                self.made.insert(view, drawn(view, data));
            } else {
                let job = self.jobs.entry(view).or_insert_with(|| background(view, data, wake));
                let drawing = job.wait(PATIENCE)?.unwrap_or_else(|()| failed(&job.failure()));
                self.jobs.remove(&view);
                self.made.insert(view, drawing);
            }
        }
        self.made.get(&view)
    }

    /// Returns an existing drawing.
    pub fn existing(&self, view: View) -> Option<&Drawing> {
        self.made.get(&view)
    }
}

/// Returns a drawing that shows an error, so that the work is not repeated in every frame.
fn failed(message: &str) -> Drawing {
    let mut drawing = Drawing::default();
    drawing.text([8.0, 16.0], 12.0, Ink::Worse, message);
    drawing
}

/// Creates the drawing of a view on this thread.
pub fn drawn(view: View, data: ViewData<'_>) -> Drawing {
    let none = PlanData::default();
    let context = ViewContext { selected: None, ..data.context() };
    view::drawing(view, data.plan.map_or(&none, |plan| plan), context, LETTERS)
}

/// Creates the drawing of a view on another thread.
fn background(view: View, data: ViewData<'_>, wake: impl FnOnce() + Send + 'static) -> Job<Drawing> {
    let (plan, against, trace) = (data.plan.cloned().unwrap_or_default(), data.against.cloned(), data.trace.cloned());
    Job::start(format!("drawing {}", view.word()), wake, move |_| {
        let context = ViewContext { against: against.as_deref(), trace: trace.as_deref(), selected: None };
        view::drawing(view, &plan, context, LETTERS)
    })
}
