//! Balances the steps of a frame over threads, and decides whether recording on several threads is faster.
//!
//! The decision is measured. A few frames are recorded on one thread with each step timed, then as many with the steps
//! distributed evenly by their times. The faster way is kept until the next trial.
//!
//! Frames that take less time than waking threads are never split. Time that trials lose against the better way is
//! accumulated, and limits how often there are trials, also across plans.

use std::ops::Range;
use std::time::Duration;

/// Number of frames after a change that fill caches and are not measured.
const WARM_UP: u32 = 3;
/// Number of measured frames of each way.
const MEASURED: u32 = 5;
/// Minimum number of frames between two trials.
const HELD: u32 = 1000;
/// Another trial starts only if earlier ones lost less than this share of the total time.
const LOST: f64 = 0.02;
/// Minimum recording time for splitting a frame.
const WORTH: Duration = Duration::from_micros(60);
/// Splitting is kept only if it takes less than this share of the single-threaded time.
const GAIN: f64 = 0.95;

/// Decides how the frames of one plan are recorded. See the [module documentation](self).
#[derive(Debug, Default)]
pub(crate) struct ThreadBalancer {
    /// Number of the current plan.
    plan: u64,
    phase: Phase,
    /// Number of frames in the current phase.
    frames: u32,
    /// Minimum time of each step on one thread.
    steps: Vec<Duration>,
    /// Minimum frame times, single-threaded and split.
    best: [Duration; 2],
    /// Step ranges of the parts.
    parts: Vec<Range<u32>>,
    /// Frame time of the way that a trial is compared with; `None` in the first frames of a plan.
    expected: Option<Duration>,
    /// Total time of all frames of all plans, and the share lost by trials.
    spent: [Duration; 2],
    /// Splits every frame evenly by step count, for tests.
    always_split: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Phase {
    /// Single-threaded, with each step timed.
    #[default]
    Single,
    /// Split, during a trial.
    Trial,
    /// Single-threaded until the next trial.
    KeepSingle,
    /// Split until the next trial.
    KeepSplit,
}

impl ThreadBalancer {
    /// Begins a frame of the plan with this number. `may_begin` says for each step whether a part may begin with it;
    /// true for the first. Returns whether steps must be timed.
    pub(crate) fn begin_frame(&mut self, plan: u64, may_begin: &[bool], threads: usize) -> bool {
        if self.always_split {
            self.parts = even_parts(&vec![Duration::from_secs(1); may_begin.len()], may_begin, threads);
            self.phase = Phase::KeepSplit;
            return false;
        }
        let cut = |part: &Range<u32>| !may_begin.get(part.start as usize).is_some_and(|may| *may);
        if self.plan != plan || self.steps.len() != may_begin.len() || self.parts.iter().any(cut) {
            let steps = vec![Duration::MAX; may_begin.len()];
            *self = Self { plan, steps, best: [Duration::MAX; 2], spent: self.spent, ..Self::default() };
        }
        let over = match self.phase {
            Phase::Single | Phase::Trial => WARM_UP + MEASURED,
            Phase::KeepSingle | Phase::KeepSplit => HELD,
        };
        if self.frames == over {
            self.enter(self.next(threads), may_begin, threads);
        }
        self.phase == Phase::Single
    }

    /// Begins a single-threaded frame without time measurements and returns true, if one is due. Otherwise does nothing
    /// and returns false.
    pub(crate) fn begin_unmeasured(&mut self, plan: u64, steps: usize) -> bool {
        let begin_unmeasured = self.phase == Phase::KeepSingle && self.frames < HELD;
        let begin_unmeasured = begin_unmeasured && self.plan == plan && self.steps.len() == steps;
        self.frames += u32::from(begin_unmeasured);
        if begin_unmeasured && self.best[0] != Duration::MAX {
            self.spent[0] += self.best[0];
        }
        begin_unmeasured
    }

    /// Splits all frames regardless of cost, for tests.
    #[cfg(all(feature = "threads", any(test, feature = "testing")))]
    pub(crate) fn always_split(&mut self) {
        self.always_split = true;
    }

    /// Returns the step ranges to record, one per thread, in order. Empty if the frame is recorded on one thread.
    pub(crate) fn parts(&self) -> &[Range<u32>] {
        match self.phase {
            Phase::Trial | Phase::KeepSplit => &self.parts,
            Phase::Single | Phase::KeepSingle => &[],
        }
    }

    /// Ends a frame with its recording time, and the times of its steps if they were measured.
    pub(crate) fn end_frame(&mut self, took: Duration, steps: impl Iterator<Item = (usize, Duration)>) {
        self.frames += 1;
        self.spent[0] += took;
        if let (Some(expected), Phase::Single | Phase::Trial) = (self.expected, self.phase) {
            self.spent[1] += took.saturating_sub(expected);
        }
        if self.frames <= WARM_UP {
            return;
        }
        match self.phase {
            Phase::Single => {
                self.best[0] = self.best[0].min(took);
                for (step, took) in steps {
                    self.steps[step] = self.steps[step].min(took);
                }
            }
            Phase::Trial => self.best[1] = self.best[1].min(took),
            Phase::KeepSingle | Phase::KeepSplit => {}
        }
    }

    fn next(&self, threads: usize) -> Phase {
        let may_lose = self.spent[1].as_secs_f64() <= LOST * self.spent[0].as_secs_f64();
        match self.phase {
            Phase::KeepSplit if !may_lose => Phase::KeepSplit,
            Phase::KeepSingle | Phase::KeepSplit => Phase::Single,
            Phase::Single if !may_lose || self.best[0] < WORTH || threads.min(self.steps.len()) < 2 => {
                Phase::KeepSingle
            }
            Phase::Single => Phase::Trial,
            Phase::Trial if self.best[1].as_secs_f64() < GAIN * self.best[0].as_secs_f64() => Phase::KeepSplit,
            Phase::Trial => Phase::KeepSingle,
        }
    }

    fn enter(&mut self, phase: Phase, may_begin: &[bool], threads: usize) {
        let known = self.best.into_iter().min().filter(|best| *best != Duration::MAX);
        self.expected = known.or(self.expected);
        match phase {
            Phase::Single => {
                self.steps.fill(Duration::MAX);
                self.best = [Duration::MAX; 2];
            }
            Phase::Trial => {
                self.best[1] = Duration::MAX;
                self.steps.iter_mut().filter(|took| **took == Duration::MAX).for_each(|took| *took = Duration::ZERO);
                let parts = even_parts(&self.steps, may_begin, threads);
                // Parts of the last trial are kept if they are nearly as even, since their request caches are filled.
                if !(self.parts.len() == parts.len()
                    && longest(&self.parts, &self.steps) <= longest(&parts, &self.steps).mul_f64(1.1))
                {
                    self.parts = parts;
                }
            }
            Phase::KeepSingle | Phase::KeepSplit => {}
        }
        (self.phase, self.frames) = (phase, 0);
    }
}

/// Returns the time of the longest part.
fn longest(parts: &[Range<u32>], steps: &[Duration]) -> Duration {
    let time = |part: &Range<u32>| steps[part.start as usize..part.end as usize].iter().sum();
    parts.iter().map(time).max().unwrap_or_default()
}

/// Splits the steps into at most `count` consecutive parts, such that the longest is as short as possible.
fn even_parts(steps: &[Duration], may_begin: &[bool], count: usize) -> Vec<Range<u32>> {
    // Steps that cannot be separated form one block.
    let mut blocks: Vec<(Range<u32>, Duration)> = Vec::new();
    for (step, (took, may)) in (0..).zip(steps.iter().zip(may_begin)) {
        match blocks.last_mut().filter(|_| !may) {
            Some((block, time)) => (block.end, *time) = (step + 1, *time + *took),
            None => blocks.push((step..step + 1, *took)),
        }
    }
    // Finds the smallest bound that `count` parts satisfy by bisection. Filling each part up to the bound is optimal.
    let filled = |bound: Duration| {
        let mut parts: Vec<(Range<u32>, Duration)> = Vec::new();
        for (block, took) in &blocks {
            match parts.last_mut().filter(|(_, time)| *time + *took <= bound) {
                Some((part, time)) => (part.end, *time) = (block.end, *time + *took),
                None => parts.push((block.clone(), *took)),
            }
        }
        parts
    };
    let mut low = blocks.iter().map(|(_, took)| *took).max().unwrap_or_default();
    let mut high: Duration = steps.iter().sum();
    while high > low {
        let middle = low + (high - low) / 2;
        if filled(middle).len() <= count { high = middle } else { low = middle + Duration::from_nanos(1) }
    }
    filled(high).into_iter().map(|(part, _)| part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn us(time: u64) -> Duration {
        Duration::from_micros(time)
    }

    #[test]
    fn parts_are_optimally_even() {
        let steps = [5, 1, 1, 1, 8, 2, 2].map(us);
        assert_eq!(even_parts(&steps, &[true; 7], 2), [0..4, 4..7]);
        let may = [true, true, true, true, false, true, true];
        assert_eq!(even_parts(&steps, &may, 2), [0..3, 3..7], "step 4 is not separated from step 3");
        assert_eq!(
            longest(&even_parts(&steps, &may, 9), &steps),
            us(9),
            "no part is shorter than an unsplittable block"
        );
        assert_eq!(even_parts(&steps, &[true; 7], 3), [0..4, 4..5, 5..7]);
        assert_eq!(even_parts(&steps, &[true; 7], 1).len(), 1);
        assert_eq!(
            longest(&even_parts(&steps, &[true; 7], 20), &steps),
            us(8),
            "no part is shorter than the longest step"
        );
        assert_eq!(even_parts(&[Duration::ZERO; 3], &[true; 3], 2).len(), 1);
        // Compares with all ways to split into three parts.
        let steps = [3, 9, 4, 4, 2, 7, 1, 6].map(us);
        let sum = |range: Range<usize>| steps[range].iter().sum::<Duration>();
        let all = (0..=8).flat_map(|a| (a..=8).map(move |b| (a, b)));
        let least = all.map(|(a, b)| sum(0..a).max(sum(a..b)).max(sum(b..8))).min();
        assert_eq!(Some(longest(&even_parts(&steps, &[true; 8], 3), &steps)), least);
    }

    /// Returns the total time of many frames that take the given times, and the number of split frames.
    fn simulated(alone: [Duration; 4], shared: Duration) -> (Duration, usize) {
        let (mut balancer, mut spent, mut in_parts) = (ThreadBalancer::default(), Duration::ZERO, 0);
        let one: Duration = alone.iter().sum();
        for _ in 0..20_000 {
            if balancer.begin_unmeasured(7, 4) {
                spent += one;
                continue;
            }
            let timed = balancer.begin_frame(7, &[true; 4], 2);
            let parts = balancer.parts();
            assert!(parts.is_empty() || parts[0].start == 0 && parts.last().is_some_and(|part| part.end == 4));
            let took = if parts.is_empty() { one } else { shared };
            in_parts += usize::from(!parts.is_empty());
            spent += took;
            balancer.end_frame(took, alone.iter().copied().enumerate().filter(|_| timed));
        }
        (spent, in_parts)
    }

    /// Checks that at most 3 % is lost against the better way (6 % near break-even).
    #[test]
    fn the_better_way_is_found_and_trials_cost_little() {
        let alone = [20, 200, 100, 80].map(us);
        for shared in [210, 300, 375, 400, 410, 800] {
            let (spent, in_parts) = simulated(alone, us(shared));
            let best = 20_000 * us(shared.min(400));
            let allowed = if shared < 380 { 1.03 } else { 1.06 };
            assert!(spent.as_secs_f64() <= allowed * best.as_secs_f64(), "{spent:?} for {best:?} at {shared} µs");
            assert_eq!(in_parts > 15_000, shared < 380, "{in_parts} frames were split at {shared} µs");
        }
        let (_, in_parts) = simulated([5, 5, 5, 5].map(us), us(1));
        assert_eq!(in_parts, 0, "frames of 20 µs are never split");
    }

    /// Checks that trials cost at most 3 % in addition to the first trial, however slow threads are and however often
    /// plans change.
    #[test]
    fn lost_time_limits_the_number_of_trials() {
        let steps = [20, 200, 100, 80].map(us);
        let one: Duration = steps.iter().sum();
        for (slower, change_every) in [(2, 20_000), (10, 20_000), (100, 20_000), (2, 17), (10, 17), (10, 40)] {
            let (mut balancer, mut spent, mut trials) = (ThreadBalancer::default(), Duration::ZERO, 0_u32);
            for frame in 0..20_000_u64 {
                let plan = frame / change_every;
                if balancer.begin_unmeasured(plan, 4) {
                    spent += one;
                    continue;
                }
                let timed = balancer.begin_frame(plan, &[true; 4], 2);
                let shared = !balancer.parts().is_empty();
                let took = if shared { one * slower } else { one };
                trials += u32::from(shared);
                spent += took;
                balancer.end_frame(took, steps.iter().copied().enumerate().filter(|_| timed));
            }
            let first = (WARM_UP + MEASURED) * slower * one;
            let most = 1.03 * (20_000 * one).as_secs_f64() + first.as_secs_f64();
            assert!(
                trials > 0 && spent.as_secs_f64() <= most,
                "{spent:?} of {most} s, {slower} {change_every} {trials}"
            );
        }
    }

    #[test]
    fn another_plan_is_measured_again() {
        let mut balancer = ThreadBalancer::default();
        for frame in 0..30 {
            balancer.begin_frame(1, &[true; 2], 2);
            let took = if balancer.parts().is_empty() { us(400) } else { us(200) };
            balancer.end_frame(took, [(0, us(200)), (1, us(200))].into_iter());
            assert!(frame < 8 || balancer.parts() == [0..1, 1..2], "frame {frame}");
        }
        assert!(balancer.begin_frame(2, &[true; 2], 2) && balancer.parts().is_empty());
        assert!(
            !(0..50).any(|_| {
                balancer.begin_frame(2, &[true; 2], 1);
                balancer.end_frame(us(400), [(0, us(200)), (1, us(200))].into_iter());
                !balancer.parts().is_empty()
            }),
            "one thread never splits"
        );
    }
}
