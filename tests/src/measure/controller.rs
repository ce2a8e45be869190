//! Simulation of the frame-time controller: seeded loads with noise, outliers and scene changes.

use super::facts::random::Dice;
use framegraph_passes::quality::{Controller, percents};
use std::fmt::Write;

/// Number of frames between the start of a frame and the arrival of its time.
const LATENCY: usize = 3;

/// Frame times as a function of the cost of a level, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// Time that no level changes, in ms.
    pub fixed_ms: f64,
    /// Time of the finest level beyond it, in ms.
    pub full_ms: f64,
    /// Exponent of the cost; above 1, the prediction of the controller is too low.
    pub exponent: f64,
    /// Standard deviation of the noise, relative.
    pub noise: f64,
    /// Probability that an outlier starts at a frame.
    pub outliers: f64,
    /// Number of frames with this load.
    pub frames: usize,
}

impl Load {
    /// Returns the time of a frame without noise, in ms.
    pub fn ms(&self, cost: f64) -> f64 {
        self.fixed_ms + self.full_ms * cost.powf(self.exponent)
    }

    /// Returns a random load of 1 to 50 ms. Up to a twenty-fifth of the frames are outliers.
    pub fn random(dice: &mut Dice, frames: usize) -> Self {
        let (whole, fixed) = (dice.scaled(1.0, 50.0), dice.between(0.0, 0.5));
        Self {
            fixed_ms: whole * fixed,
            full_ms: whole * (1.0 - fixed),
            exponent: dice.between(0.7, 1.2),
            noise: dice.between(0.0, 0.05),
            outliers: dice.between(0.0, 0.02),
            frames,
        }
    }
}

/// A simulated frame.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Time since the load changed at the end of the frame, without noise and outliers, in ms.
    pub since_ms: f64,
    /// Index of the load.
    pub load: usize,
    /// Level of the frame.
    pub level: usize,
    /// Time of the frame with its noise, in ms.
    pub ms: f64,
    /// Time of the frame without noise, in ms.
    pub ideal_ms: f64,
}

/// Simulates frames under loads that follow each other. Outliers last 1 to 3 frames and take 2 to 10 times as long.
/// `factors` are measured times relative to their median; if there are some, they are the noise.
pub fn simulate(loads: &[Load], target_ms: f64, seed: u64, factors: &[f64]) -> Vec<Step> {
    let costs: Vec<f64> = percents(50.0).iter().map(|p| p * p / 1e4).collect();
    let (mut controller, mut dice) = (Controller::new(target_ms, costs.clone()), Dice::new(seed));
    let mut steps: Vec<Step> = Vec::new();
    for (index, load) in loads.iter().enumerate() {
        let (mut since_ms, mut slow, mut left) = (0.0, 1.0, 0);
        for frame in 0..load.frames {
            let level = controller.level();
            if left == 0 {
                let starts = dice.chance(load.outliers);
                (slow, left) = (if starts { dice.scaled(2.0, 10.0) } else { 1.0 }, dice.pick(&[1, 2, 3]));
                left = if starts { left } else { 1 };
            }
            left -= 1;
            // The sum of uniform numbers is nearly normal; 6 of them have the variance one half.
            let normal = ((0..6).map(|_| dice.unit()).sum::<f64>() - 3.0) * 2.0_f64.sqrt();
            let noise = match factors {
                [] => (1.0 + load.noise * normal).max(0.1) * slow,
                _ => factors[(frame + seed as usize) % factors.len()],
            };
            let ideal_ms = load.ms(costs[level]);
            since_ms += ideal_ms;
            steps.push(Step { since_ms, load: index, level, ms: ideal_ms * noise, ideal_ms });
            if let Some(late) = steps.len().checked_sub(1 + LATENCY) {
                controller.report(steps[late].level, steps[late].ms);
            }
        }
    }
    steps
}

/// Behavior of the controller under one load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Behavior {
    /// Time after the load changed until no later level takes more than the target, or is the cheapest; in ms.
    pub adapted_ms: f64,
    /// Largest cost ratio by which the level at the end could rise within 80 % of the target; 1 if it could not.
    pub wasted: f64,
    /// Number of level changes.
    pub changes: usize,
    /// Number of falls that follow a rise, after the first second.
    pub reversals: usize,
    /// Level at the end.
    pub level: usize,
}

/// Returns the behavior under each load.
pub fn behavior(steps: &[Step], loads: &[Load], target_ms: f64) -> Vec<Behavior> {
    let costs: Vec<f64> = percents(50.0).iter().map(|p| p * p / 1e4).collect();
    let of = |(index, load): (usize, &Load)| {
        let own: Vec<_> = steps.iter().filter(|step| step.load == index).collect();
        let mut found = Behavior { wasted: 1.0, ..Behavior::default() };
        let mut rose = false;
        for pair in own.windows(2) {
            let [from, to] = [pair[0].level, pair[1].level];
            found.changes += usize::from(from != to);
            if pair[1].since_ms > 1000.0 {
                found.reversals += usize::from(to < from && rose);
                rose |= to > from;
            }
        }
        let over = own.iter().rev().find(|step| step.ideal_ms > 1.02 * target_ms && step.level > 0);
        found.adapted_ms = over.map_or(0.0, |step| step.since_ms);
        found.level = own.last().map_or(0, |step| step.level);
        let finer = costs[found.level..].iter().filter(|cost| load.ms(**cost) <= 0.8 * target_ms);
        found.wasted = finer.fold(1.0, |most, cost| f64::max(most, cost / costs[found.level]));
        found
    };
    loads.iter().enumerate().map(of).collect()
}

/// Returns the changes of level as a Markdown table, with the median time of the frames at each level.
pub fn trace(steps: &[Step], percents: &[f64]) -> String {
    let mut text = String::from(
        "| scene | after, ms | frames | scale, % | median, ms | greatest, ms |\n| ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    let same = |a: &Step, b: &Step| (a.load, a.level) == (b.load, b.level);
    let mut since_ms = 0.0;
    for part in steps.chunk_by(same) {
        if part[0].since_ms < since_ms {
            since_ms = 0.0;
        }
        let mut times: Vec<f64> = part.iter().map(|step| step.ms).collect();
        times.sort_by(f64::total_cmp);
        let [median, most] = [times[times.len() / 2], times[times.len() - 1]];
        let (scene, frames, percent) = (part[0].load + 1, part.len(), percents[part[0].level]);
        let _ = writeln!(text, "| {scene} | {since_ms:.0} | {frames} | {percent:.0} | {median:.1} | {most:.1} |");
        since_ms = part[part.len() - 1].since_ms;
    }
    text
}

/// Frame times of `spheres` on a software driver, relative to their median; the machine had other work. `measure
/// controller` prints such times.
pub const DRIVER: [f64; 120] = [
    1.59, 1.19, 0.80, 1.69, 0.92, 0.87, 1.24, 0.91, 0.58, 0.92, 0.60, 0.94, 0.80, 0.90, 0.77, 0.74, 1.23, 1.05, 0.96,
    0.93, 0.75, 1.21, 1.13, 0.94, 0.71, 0.82, 0.62, 0.63, 0.84, 0.90, 1.18, 0.81, 0.84, 0.89, 0.89, 0.82, 0.91, 1.32,
    0.98, 1.05, 0.96, 0.53, 0.76, 0.87, 0.78, 0.76, 0.83, 0.72, 0.75, 1.13, 1.10, 1.04, 1.11, 1.02, 1.15, 1.19, 1.38,
    1.10, 1.23, 1.31, 0.96, 1.14, 1.08, 1.56, 2.30, 1.00, 1.42, 1.47, 1.69, 2.07, 1.09, 0.99, 1.21, 0.84, 1.22, 1.01,
    1.13, 1.13, 1.95, 1.31, 1.50, 1.45, 1.19, 1.21, 0.97, 0.96, 0.90, 0.89, 1.08, 1.14, 1.15, 1.06, 1.27, 0.67, 0.98,
    0.98, 0.79, 0.96, 0.92, 1.03, 1.20, 0.89, 0.92, 0.94, 0.95, 0.91, 1.11, 1.40, 0.94, 0.96, 1.19, 1.41, 1.26, 1.03,
    0.84, 1.34, 1.69, 1.51, 1.51, 0.95,
];
