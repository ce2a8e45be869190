//! `measure controller`: traces of the frame-time controller, simulated and on the default adapter.

use crate::{Outcome, adapter};
use framegraph_passes::quality::{Controller, percents};
use framegraph_passes::{LightSearch, Settings, Upscale};
use tests::lab::record::Rounds;
use tests::lab::studio::{Ready, Setup, Studio};
use tests::measure::controller::{DRIVER, Load, Step, behavior, simulate, trace};
use tests::measure::facts::random::Dice;

const TARGET_MS: f64 = 1000.0 / 60.0;

/// Prints a simulated trace, summaries of N random simulations (default 1000) with random and with measured noise, and
/// a trace on the adapter.
pub fn run(words: &[&str]) -> Outcome {
    let runs: u64 = match words {
        [] => 1000,
        [count] => count.parse().map_err(|_| format!("{count}: expected a number of simulations"))?,
        _ => return Err("usage: measure controller [N]".into()),
    };
    if runs == 0 {
        return Err("0: expected at least one simulation".into());
    }
    let load = |fixed_ms, full_ms| Load { fixed_ms, full_ms, exponent: 1.0, noise: 0.03, outliers: 0.02, frames: 240 };
    let loads = [load(3.0, 9.0), load(6.0, 24.0), load(3.0, 9.0)];
    program::line(format_args!("Simulated, target {TARGET_MS:.1} ms, three scenes:\n"));
    program::line(trace(&simulate(&loads, TARGET_MS, 1, &[]), &percents(50.0)));
    let own = Summary::of(runs, &[]);
    program::line(format_args!(
        "{} random loads: within the target after {:.0} ms (95th percentile), {:.0} ms (greatest); {} changes \
         (median), {} (greatest); {} loads in which a rise was undone after the first second.\n",
        own.adapted_ms.len(),
        at(&own.adapted_ms, 0.95),
        at(&own.adapted_ms, 1.0),
        at(&own.changes, 0.5),
        at(&own.changes, 1.0),
        own.undone_loads
    ));
    let replayed = Summary::of(runs, &DRIVER);
    program::line(format_args!(
        "{} random loads with the noise of a software driver on a busy machine: {} rises undone after the first \
         second, in {} loads; {} loads slower than a second, {:.0} ms at most; {} changes (median), {} (greatest).\n",
        replayed.adapted_ms.len(),
        replayed.undone,
        replayed.undone_loads,
        replayed.adapted_ms.iter().filter(|ms| **ms > 1000.0).count(),
        at(&replayed.adapted_ms, 1.0),
        at(&replayed.changes, 0.5),
        at(&replayed.changes, 1.0)
    ));
    on_the_driver()?;
    Ok(at(&own.adapted_ms, 1.0) <= 1000.0 && own.undone_loads == 0)
}

/// Behavior under many random loads.
#[derive(Debug, Default)]
struct Summary {
    /// Times until frames are within the target, ascending, in ms.
    adapted_ms: Vec<f64>,
    /// Numbers of level changes per load, ascending.
    changes: Vec<f64>,
    /// Number of rises that were undone after the first second.
    undone: usize,
    /// Number of loads with such rises.
    undone_loads: usize,
}

impl Summary {
    /// Simulates three loads per run, with `factors` as noise if there are some.
    fn of(runs: u64, factors: &[f64]) -> Self {
        let mut all = Self::default();
        for seed in 0..runs {
            let mut dice = Dice::new(seed);
            let loads = [0; 3].map(|_| Load::random(&mut dice, 900));
            for found in behavior(&simulate(&loads, TARGET_MS, seed, factors), &loads, TARGET_MS) {
                all.adapted_ms.push(found.adapted_ms);
                all.changes.push(found.changes as f64);
                all.undone += found.reversals;
                all.undone_loads += usize::from(found.reversals > 0);
            }
        }
        all.adapted_ms.sort_by(f64::total_cmp);
        all.changes.sort_by(f64::total_cmp);
        all
    }
}

/// Returns the value below which a share of the sorted values lies.
fn at(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share) as usize]
}

fn on_the_driver() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = adapter()?;
    let studio = Studio::new(&gpu, [192, 128], Rounds::QUICK);
    let settings = Settings { shadows: None, occlusion: None, samples: 1, ..Settings::DEFAULT };
    let setup = |scene| Setup {
        scene,
        ev100: 14.5,
        settings,
        light: settings.shading.light(framegraph_passes::light::shading::Quality::Low),
        lights: LightSearch::default(),
        sun: None,
    };
    let mut scenes = [studio.prepare(&setup("spheres"), [320, 240])?, studio.prepare(&setup("columns"), [1280, 960])?];
    let median = |ready: &mut Ready| {
        let mut times = Vec::new();
        for _ in 0..41 {
            times.push(ready.draw(&gpu)?);
        }
        let mut sorted = times.split_off(10);
        sorted.sort_by(f64::total_cmp);
        Ok::<_, Box<dyn std::error::Error>>((sorted[sorted.len() / 2], sorted))
    };
    let [small_ms, large_ms] = [median(&mut scenes[0])?.0, median(&mut scenes[1])?.0];
    let target_ms = 0.6 * large_ms;
    program::line(format_args!(
        "`spheres` at 320×240 takes {small_ms:.1} ms, `columns` at 1280×960 {large_ms:.1} ms; target {target_ms:.1} ms:\n"
    ));
    let scales = percents(50.0);
    let mut controller = Controller::new(target_ms, scales.iter().map(|percent| percent * percent));
    let mut steps = Vec::new();
    for (load, of) in [0, 1, 0].into_iter().enumerate() {
        let (mut since_ms, mut drawn) = (0.0, usize::MAX);
        for _ in 0..120 {
            let level = controller.level();
            if drawn != level {
                let percent = scales[level] as u16;
                let upscale = (percent < 100).then_some(Upscale { percent, ..Upscale::DEFAULT });
                studio.change(&mut scenes[of], &Settings { upscale, ..settings })?;
                drawn = level;
            }
            let ms = scenes[of].draw(&gpu)?;
            since_ms += ms;
            steps.push(Step { since_ms, load, level, ms, ideal_ms: ms });
            controller.report(level, ms);
        }
    }
    program::line(trace(&steps, &scales));
    program::line("Frame times of the last scene, relative to their median:");
    let mut last: Vec<f64> = steps[240..].iter().map(|step| step.ms).collect();
    let shown = last.clone();
    last.sort_by(f64::total_cmp);
    let relative: Vec<_> = shown.iter().map(|ms| format!("{:.2}", ms / last[60])).collect();
    program::line(relative.join(", "));
    Ok(())
}
