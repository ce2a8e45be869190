//! The frame-time controller under simulated loads.

use framegraph_passes::quality::{Controller, percents};
use std::time::Instant;
use tests::measure::controller::{DRIVER, Load, behavior, simulate};
use tests::measure::facts::random::Dice;

const TARGET_MS: f64 = 1000.0 / 60.0;

/// After each of three random loads begins, frames are within the target in one second, and later no rise is undone.
/// Outliers change nothing. Under the noise of a busy machine (±30 %, correlated), the level changes rarely.
#[test]
fn levels_adapt_within_a_second_and_do_not_oscillate() {
    for seed in 0..300 {
        let mut dice = Dice::new(seed);
        let loads = [0; 3].map(|_| Load::random(&mut dice, 900));
        for found in behavior(&simulate(&loads, TARGET_MS, seed, &[]), &loads, TARGET_MS) {
            assert!(found.adapted_ms <= 1000.0 && found.reversals == 0, "{seed}: {found:?} of {loads:?}");
            assert!(found.changes <= 8 && found.wasted < 1.5, "{seed}: {found:?} of {loads:?}");
        }
        for found in behavior(&simulate(&loads, TARGET_MS, seed, &DRIVER), &loads, TARGET_MS) {
            assert!(found.changes <= 15 && found.reversals <= 6, "{seed}: {found:?} of {loads:?}");
        }
    }
}

/// The time grows with the sixth power of the side, where the second is expected. The controller learns it.
#[test]
fn wrong_costs_are_learned() {
    let load = Load { fixed_ms: 0.0, full_ms: 30.0, exponent: 3.0, noise: 0.02, outliers: 0.0, frames: 3000 };
    let mut steps = simulate(&[load], TARGET_MS, 1, &[]);
    let found = behavior(&steps, &[load], TARGET_MS);
    assert!(found[0].changes <= 6 && found[0].reversals <= 1, "{found:?}");
    for (index, step) in steps.iter_mut().enumerate() {
        step.level = index / 100 % 2;
    }
    assert!(behavior(&steps, &[load], TARGET_MS)[0].reversals > 10, "the simulation sees oscillation");
}

#[test]
fn limits_and_invalid_times() {
    let costs = || percents(50.0).into_iter().map(|percent| percent * percent);
    let mut own = Controller::new(12.0, costs());
    let finest = own.level();
    for ms in [f64::NAN, f64::INFINITY, -1.0] {
        (0..30).for_each(|_| assert_eq!(own.report(finest, ms), finest, "{ms}"));
    }
    (0..30).for_each(|_| assert_eq!(own.report(0, 500.0), finest, "a time of another level"));
    for frame in 0..200 {
        let hitch = if frame % 20 < 5 { 500.0 } else { 11.0 };
        assert_eq!(own.report(finest, hitch), finest, "groups of five outliers");
    }
    for _ in 0..100 {
        own.report(own.level(), 500.0);
    }
    assert_eq!(own.level(), 0, "nothing is enough");
    for _ in 0..100 {
        own.report(own.level(), 1.0);
    }
    assert_eq!(own.level(), finest, "there is time for all");
    assert_eq!(Controller::new(12.0, []).report(0, 1.0), 0);
    assert_eq!(percents(40.0)[0], 40.0);
    assert_eq!(percents(100.0), [100.0]);
    // At 240 frames per second, 1 % of a frame is 42 µs.
    let begun = Instant::now();
    for index in 0..10_000 {
        own.report(own.level(), 11.0 + f64::from(index % 7) * 0.2);
    }
    assert!(begun.elapsed().as_secs_f64() / 1e4 < 42e-6, "{:?} for 10,000 frames", begun.elapsed());
}
