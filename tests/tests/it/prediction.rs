//! Prediction of times and errors on held-out scenes.

use tests::measure::facts::random::{Dice, random_case};
use tests::measure::prediction::{FEATURES, OPTIONS, Sample, features, judged, ridge};

/// A law of the features is found exactly, and random values are not predicted.
#[test]
fn laws_are_predicted_on_held_out_scenes() {
    let law = [0.5, 0.3, -0.2, 0.1, 0.4, 0.2, -0.3, 0.6, 0.1];
    let mut dice = Dice::new(1);
    let samples = |of: &mut dyn FnMut(&[f64; FEATURES]) -> f64| {
        let mut all = Vec::new();
        for scene in 0..60 {
            let size_px = [48, 32];
            let features = features(&random_case(scene, 0).scene, size_px);
            let ms = of(&features);
            let option = OPTIONS[0].0.to_owned();
            all.push(Sample { scene, size_px, option, features, ms, steps: ms });
        }
        all
    };
    let ideal = |x: &[f64; FEATURES]| law.iter().zip(x).map(|(w, x)| w * x).sum::<f64>().exp();
    let found = judged(&samples(&mut |x| ideal(x)));
    assert!(found[0].ms[0] < 0.02 && found[0].ms[1] < 0.1, "{:?}", found[0]);
    let noise = judged(&samples(&mut |_| dice.scaled(1.0, 100.0)));
    assert!(noise[0].ms[0] > 0.3, "{:?}", noise[0]);
    let rows: Vec<_> = (0..50).map(|_| std::array::from_fn(|i| if i == 0 { 1.0 } else { dice.unit() })).collect();
    let rows: Vec<_> = rows.into_iter().map(|x: [f64; FEATURES]| (x, ideal(&x).ln())).collect();
    let weights = ridge(&rows, 1e-9);
    assert!(weights.iter().zip(law).all(|(found, own)| (found - own).abs() < 1e-4), "{weights:?}");
}
