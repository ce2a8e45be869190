//! `measure controller`: traces of the frame-time controller, simulated and on the default adapter.

use crate::{Outcome, adapter};
use framegraph_passes::quality::{Controller, percents};
use framegraph_passes::{LightSearch, Settings, Upscale};
use tests::lab::record::Rounds;
use tests::lab::studio::{Ready, Setup, Studio};
use tests::measure::controller::{Load, Step, behavior, simulate, trace};
use tests::measure::facts::random::Dice;

const TARGET_MS: f64 = 1000.0 / 60.0;

/// Prints a simulated trace, a summary of N random simulations (default 1000), and a trace on the adapter.
pub fn run(words: &[&str]) -> Outcome {
    let runs: u64 = match words {
        [] => 1000,
        [count] => count.parse().map_err(|_| format!("{count}: expected a number of simulations"))?,
        _ => return Err("usage: measure controller [N]".into()),
    };
    let load = |fixed_ms, full_ms| Load { fixed_ms, full_ms, exponent: 1.0, noise: 0.03, outliers: 0.02, frames: 240 };
    let loads = [load(3.0, 9.0), load(6.0, 24.0), load(3.0, 9.0)];
    program::line(format_args!("Simulated, target {TARGET_MS:.1} ms, three scenes:\n"));
    program::line(trace(&simulate(&loads, TARGET_MS, 1, &[]), &percents(50.0)));
    let (mut adapted, mut changes, mut reversals) = (Vec::new(), Vec::new(), 0);
    for seed in 0..runs {
        let mut dice = Dice::new(seed);
        let loads = [0; 3].map(|_| Load::random(&mut dice, 900));
        for found in behavior(&simulate(&loads, TARGET_MS, seed, &[]), &loads, TARGET_MS) {
            adapted.push(found.adapted_ms);
            changes.push(found.changes as f64);
            reversals += usize::from(found.reversals > 0);
        }
    }
    adapted.sort_by(f64::total_cmp);
    changes.sort_by(f64::total_cmp);
    let at = |sorted: &[f64], share: f64| sorted[((sorted.len() - 1) as f64 * share) as usize];
    program::line(format_args!(
        "{} random loads: within the target after {:.0} ms (95th percentile), {:.0} ms (greatest); {} changes \
         (median), {} (greatest); {reversals} loads in which a rise was undone after the first second.\n",
        adapted.len(),
        at(&adapted, 0.95),
        at(&adapted, 1.0),
        at(&changes, 0.5),
        at(&changes, 1.0)
    ));
    on_the_driver()?;
    Ok(at(&adapted, 1.0) <= 1000.0 && reversals == 0)
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
