//! Cache of the requests that recorders make, in order, with their results. A request that repeats the last frame's is
//! answered by one comparison.

use crate::execute::cached_step::CachedStep;
use crate::execute::part::ViewPart;
use crate::pipelines::bind_groups::LastGroup;
use crate::pipelines::cache::{LastCompute, LastRaster};
use framegraph::StepId;
use wgpu::TextureView;

/// Requests of one step: its attachments, and requests of recorders by kind.
#[derive(Debug, Default)]
pub(crate) struct StepRequests {
    pub(crate) cached: CachedStep,
    pub(crate) views: RequestList<LastView>,
    pub(crate) groups: RequestList<LastGroup>,
    pub(crate) rasters: RequestList<LastRaster>,
    pub(crate) computes: RequestList<LastCompute>,
}

/// Last result of a view request: access, part and texture stamp, with the view.
#[derive(Debug, Default)]
pub(crate) struct LastView(pub(crate) Option<((usize, ViewPart, u64), TextureView)>);

/// Requests of one kind, in order. Requests that change or move between frames miss the cache and are only slower.
#[derive(Debug)]
pub(crate) struct RequestList<T> {
    last: Vec<T>,
    next: usize,
}

impl<T> Default for RequestList<T> {
    fn default() -> Self {
        Self { last: Vec::new(), next: 0 }
    }
}

impl<T: Default> RequestList<T> {
    /// Advances to the next request and returns its last result.
    pub(crate) fn next(&mut self) -> &mut T {
        let index = self.next;
        self.next += 1;
        if index == self.last.len() {
            self.last.push(T::default());
        }
        &mut self.last[index]
    }

    /// Returns the last result of the current request.
    pub(crate) fn last(&mut self) -> &mut T {
        &mut self.last[self.next - 1]
    }
}

/// Requests of all steps that one thread records.
#[derive(Debug, Default)]
pub(crate) struct RequestCache {
    steps: Vec<StepRequests>,
    current: usize,
    /// Number of frames until views are released.
    left: u64,
    /// Number of view requests answered from this cache since its creation.
    pub(crate) views_found: u64,
}

impl RequestCache {
    /// Begins a frame. Releases views every `max_age` frames, so that the view cache learns which are in use.
    pub(crate) fn begin_frame(&mut self, max_age: u64) {
        match self.left.checked_sub(1) {
            Some(left) => self.left = left,
            None => {
                self.release_views();
                self.left = max_age.saturating_sub(1);
            }
        }
    }

    /// Releases all views.
    pub(crate) fn release_views(&mut self) {
        for step in &mut self.steps {
            step.cached.release_views();
            step.views.last.clear();
        }
    }

    /// Begins a step at the first request of its last recording.
    pub(crate) fn begin(&mut self, step: StepId) {
        self.current = step.index();
        if self.steps.len() <= self.current {
            self.steps.resize_with(self.current + 1, StepRequests::default);
        }
        let StepRequests { views, groups, rasters, computes, .. } = self.step();
        (views.next, groups.next, rasters.next, computes.next) = (0, 0, 0, 0);
    }

    /// Returns the requests of the current step.
    pub(crate) fn step(&mut self) -> &mut StepRequests {
        &mut self.steps[self.current]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that requests of repeated frames take no additional memory, and that steps are separate.
    #[test]
    fn a_repeated_step_repeats_its_requests() {
        let mut cache = RequestCache::default();
        for _ in 0..3 {
            for (step, requests) in [(StepId::at(1), 2), (StepId::at(0), 3)] {
                cache.begin(step);
                for _ in 0..requests {
                    cache.step().views.next();
                    cache.step().groups.next();
                    cache.step().rasters.next();
                    cache.step().computes.next();
                }
            }
        }
        let lengths = |s: &StepRequests| [s.views.last.len(), s.groups.last.len(), s.rasters.last.len()];
        let computes: Vec<_> = cache.steps.iter().map(|s| s.computes.last.len()).collect();
        assert_eq!(cache.steps.iter().map(lengths).collect::<Vec<_>>(), [[3; 3], [2; 3]]);
        assert_eq!(computes, [3, 2]);
    }
}
