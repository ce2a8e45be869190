//! What the steps of a frame asked of the caches, in order, with what each request got: the same request of the next frame
//! finds it by comparing alone.

use crate::cache::Last;
use crate::pipelines::bind_groups::LastGroup;
use crate::pipelines::cache::{LastCompute, LastRaster};
use crate::resources::views::LastView;
use framegraph::StepId;

/// The requests of one step, by kind.
#[derive(Debug, Default)]
pub(crate) struct RememberedStep {
    pub(crate) views: InOrder<LastView>,
    pub(crate) groups: InOrder<LastGroup>,
    pub(crate) rasters: InOrder<LastRaster>,
    pub(crate) computes: InOrder<LastCompute>,
}

/// Requests of one kind. Where a frame asks for others, or in another order, they are only slower.
#[derive(Debug)]
pub(crate) struct InOrder<T> {
    last: Vec<T>,
    next: usize,
}

impl<T> Default for InOrder<T> {
    fn default() -> Self {
        Self { last: Vec::new(), next: 0 }
    }
}

impl<K, V> InOrder<Last<K, V>> {
    /// What the request got last that is made now.
    pub(crate) fn next(&mut self) -> &mut Last<K, V> {
        let index = self.next;
        self.next += 1;
        if index == self.last.len() {
            self.last.push(Last::default());
        }
        &mut self.last[index]
    }
}

/// The requests of all steps that one thread records.
#[derive(Debug, Default)]
pub(crate) struct Remembered {
    steps: Vec<RememberedStep>,
    current: usize,
}

impl Remembered {
    /// Begins a step: its first request is its first of the frame before.
    pub(crate) fn begin(&mut self, step: StepId) {
        self.current = step.index();
        if self.steps.len() <= self.current {
            self.steps.resize_with(self.current + 1, RememberedStep::default);
        }
        let RememberedStep { views, groups, rasters, computes } = self.step();
        (views.next, groups.next, rasters.next, computes.next) = (0, 0, 0, 0);
    }

    /// Those of the step that has begun.
    pub(crate) fn step(&mut self) -> &mut RememberedStep {
        &mut self.steps[self.current]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Requests of a steady frame take no more memory the longer it runs, and steps do not share what they remember.
    #[test]
    fn a_step_that_begins_anew_goes_through_the_same_requests() {
        let mut remembered = Remembered::default();
        for _ in 0..3 {
            for (step, requests) in [(StepId::at(1), 2), (StepId::at(0), 3)] {
                remembered.begin(step);
                for _ in 0..requests {
                    remembered.step().views.next();
                    remembered.step().groups.next();
                    remembered.step().rasters.next();
                    remembered.step().computes.next();
                }
            }
        }
        let lengths = |s: &RememberedStep| [s.views.last.len(), s.groups.last.len(), s.rasters.last.len()];
        let computes: Vec<_> = remembered.steps.iter().map(|s| s.computes.last.len()).collect();
        assert_eq!(remembered.steps.iter().map(lengths).collect::<Vec<_>>(), [[3; 3], [2; 3]]);
        assert_eq!(computes, [3, 2]);
    }
}
