//! Selection of a quality level at run time, from measured frame times.

/// Number of frame times that a decision uses.
const WINDOW: usize = 15;
/// Number of consecutive frames over the target after which the level falls at once.
const FAST: usize = 6;
/// Factor on the target that each of these frames exceeds.
const FAR: f64 = 1.15;
/// Largest ratio between these times, except for one of them.
const ALIKE: f64 = 1.5;
/// Fraction of the target that a new level may take.
const AIM: f64 = 0.9;
/// Factor by which each failed rise increases the prediction of later ones, at least.
const MIN_GROWTH: f64 = 1.3;
/// Greatest product of these factors.
const MAX_GROWTH: f64 = 16.0;
/// Factor on the distance between the median and the fourth-largest time, which a rise leaves free.
const SPREADS: f64 = 2.0;
/// Number of frames for which a rise is on trial.
const TRIAL: u32 = 240;
/// Factor on the time of a level below which the scene counts as another one.
const CHEAPER: f64 = 0.6;
/// Number of frames for which the previous level predicts costs.
const RECENT: u32 = 120;

/// Chooses one of several quality levels, so that frames stay within a time. Levels are a ladder of scales
/// ([`percents`]) or the sets of [`Offers::front`](super::Offers::front). No measurement before the first frame is
/// needed: only the ratio of the levels' costs is given.
///
/// The level falls if 6 consecutive frames of similar times exceed the target by 15 %, or if the median of 15 frames
/// exceeds it. It rises if a high estimate of the time, scaled by the ratio of costs, stays below 90 % of the target. The
/// estimate lies above the median by twice the distance to the fourth-largest of 15 times. A frame with costs
/// `a + b × cost` and `a ≥ 0` never takes more than this prediction. Therefore a fall follows a rise only if the scene
/// changes or noise is large and correlated. Each such fall raises later predictions by 30 % or more, until the time
/// falls by 40 %. Single outliers are ignored, also in groups of up to 5 frames.
///
/// [`Controller::report`] takes less than 3,000 instructions.
#[derive(Clone, Debug)]
pub struct Controller {
    target_ms: f64,
    costs: Vec<f64>,
    level: usize,
    /// Times at the present level; the newest is last.
    times: [f64; WINDOW],
    count: usize,
    /// Frames since the level changed.
    age: u32,
    /// Cost and time of the previous level.
    before: Option<[f64; 2]>,
    /// Predicted time of a level that was entered from below.
    predicted_ms: Option<f64>,
    /// Learned factor on the predicted time of a rise.
    growth: f64,
    /// Median of the first full window of the level.
    settled_ms: Option<f64>,
}

impl Controller {
    /// Creates a controller for frames of `target_ms` milliseconds. `costs` has the relative cost of each level, above
    /// 0, from the cheapest to the finest; invalid costs count as the cost before them. The first level is the finest.
    pub fn new(target_ms: f64, costs: impl IntoIterator<Item = f64>) -> Self {
        let mut ascending = Vec::new();
        for cost in costs {
            let least = ascending.last().copied().unwrap_or(1e-6);
            ascending.push(if cost.is_finite() { cost.max(least) } else { least });
        }
        let level = ascending.len().saturating_sub(1);
        Self {
            target_ms: target_ms.max(1e-6),
            costs: ascending,
            level,
            times: [0.0; WINDOW],
            count: 0,
            age: 0,
            before: None,
            predicted_ms: None,
            growth: 1.0,
            settled_ms: None,
        }
    }

    /// Returns the level of the next frame; 0 is the cheapest.
    pub fn level(&self) -> usize {
        self.level
    }

    /// Adds the time of a frame that was drawn at `level`, and returns the level of the next frame. Times may arrive
    /// several frames late. Invalid times and times of other levels are ignored.
    pub fn report(&mut self, level: usize, ms: f64) -> usize {
        if level != self.level || self.costs.is_empty() || !ms.is_finite() || ms < 0.0 {
            return self.level;
        }
        self.times.copy_within(1.., 0);
        self.times[WINDOW - 1] = ms;
        (self.count, self.age) = ((self.count + 1).min(WINDOW), self.age.saturating_add(1));
        let mut latest = [0.0; FAST];
        latest.copy_from_slice(&self.times[WINDOW - FAST..]);
        latest.sort_unstable_by(f64::total_cmp);
        let [least, typical, most] = [0, FAST / 2, FAST - 2].map(|at| latest[at]);
        // The times of a slow scene are similar; those of a group of outliers are not.
        if self.count >= FAST && least > FAR * self.target_ms && most < ALIKE * least {
            self.fall(typical);
        } else if self.count == WINDOW {
            let mut sorted = self.times;
            sorted.sort_unstable_by(f64::total_cmp);
            let median = sorted[WINDOW / 2];
            let high = median + SPREADS * (sorted[WINDOW - 4] - median);
            if self.settled_ms.is_some_and(|settled| median < CHEAPER * settled) {
                // Another scene; the learned factor was that of the old one.
                (self.growth, self.settled_ms) = (1.0, None);
            }
            self.settled_ms.get_or_insert(median);
            if median > self.target_ms {
                self.fall(median);
            } else {
                self.rise(median, high);
            }
        }
        self.level
    }

    fn fall(&mut self, ms: f64) {
        match self.predicted_ms {
            Some(predicted) if self.age < TRIAL => {
                self.growth = (self.growth * (1.05 * ms / predicted).max(MIN_GROWTH)).min(MAX_GROWTH);
            }
            _ => {}
        }
        let slope = self.slope(ms, true);
        let fits = |level: &usize| self.after(ms, slope, *level) <= AIM * self.target_ms;
        let to = (0..self.level).rev().find(fits).unwrap_or(0);
        self.change(to, ms, None);
    }

    /// Enters the finest level that fits, if `high` allows it: the median plus twice the distance from it to the
    /// fourth-largest time. Three outliers have no effect.
    fn rise(&mut self, median: f64, high: f64) {
        let slope = self.slope(median, false);
        let own = self.costs[self.level];
        let reach = self.before.filter(|_| self.age < RECENT).map_or(f64::INFINITY, |[cost, _]| 3.0 * (own - cost));
        let fits = |level: &usize| {
            let step = self.costs[*level] - own;
            let safe = high * self.growth * self.costs[*level] / own;
            let seen = self.growth * (high + slope * step);
            safe <= AIM * self.target_ms || (step <= reach && self.growth == 1.0 && seen <= AIM * self.target_ms)
        };
        if let Some(to) = (self.level + 1..self.costs.len()).rev().find(fits) {
            let predicted = self.after(median, median / own, to);
            self.change(to, median, Some(predicted));
        }
    }

    /// Returns the time per unit of cost: from this and the previous level if it is known, and otherwise for a time
    /// in proportion to the cost. Noise cannot make a fall too small or a rise free.
    fn slope(&self, ms: f64, falls: bool) -> f64 {
        let whole = ms / self.costs[self.level];
        match self.before {
            Some([cost, before_ms]) if self.age < RECENT && (cost > self.costs[self.level]) == falls => {
                let found = (before_ms - ms) / (cost - self.costs[self.level]);
                if falls { found.clamp(0.1 * whole, whole) } else { (1.3 * found).clamp(0.2 * whole, whole) }
            }
            _ => whole,
        }
    }

    fn after(&self, ms: f64, slope: f64, level: usize) -> f64 {
        ms + slope * (self.costs[level] - self.costs[self.level])
    }

    fn change(&mut self, to: usize, ms: f64, predicted_ms: Option<f64>) {
        if to != self.level {
            self.before = Some([self.costs[self.level], ms]);
            (self.level, self.count, self.age) = (to, 0, 0);
            (self.predicted_ms, self.settled_ms) = (predicted_ms, None);
        }
    }
}

/// Returns the scales of dynamic resolution in percent of width and height, in steps of 5, from `min_percent` (25 to
/// 100) to 100. The cost of a scale is the square of it.
pub fn percents(min_percent: f64) -> Vec<f64> {
    let least = if min_percent.is_finite() { min_percent.clamp(25.0, 100.0) } else { 100.0 };
    let mut all: Vec<f64> = (0..16).map(|step| 100.0 - 5.0 * f64::from(step)).take_while(|p| *p > least).collect();
    all.push(least);
    all.reverse();
    all
}
