//! White furnace tests of the standard frame: energy is preserved, and disabled compensation loses a known share.

use crate::light_document::numbers;
use crate::stage::gpu;
use framegraph_passes::{Quality, Shading};
use framegraph_scene::{Environment, Light, Material};
use framegraph_shader_mirrors::dfg::Visibility;
use glam::{DVec3, Vec3};
use std::error::Error;
use tests::measure::board::Seen;
use tests::measure::cards::{Card, Wall};
use tests::measure::furnace::{F0, frame_errors, truth};
use truth::albedo::{Masking, ggx};

type TestResult = Result<(), Box<dyn Error>>;

const ROUGHNESS: [f64; 8] = [0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0];
const NOV: [f64; 5] = [0.1, 0.3, 0.5, 0.8, 1.0];

/// Returns perfect conductors at every roughness and angle.
fn mirrors() -> Wall {
    let card = |r: f64| NOV.map(|nov| Card { material: Material::metal("furnace", Vec3::ONE, r as f32), nov });
    Wall { cards: ROUGHNESS.into_iter().flat_map(card).collect(), ..Wall::default() }
}

/// Returns the largest difference between a card and the environment beside it, in 8-bit steps.
fn codes_apart(seen: &[Seen]) -> u8 {
    let (beside, cards) = seen.split_last().expect("something is seen");
    let apart = |card: &Seen| (0..3).map(|c| card.code[c].abs_diff(beside.code[c])).max();
    cards.iter().filter_map(apart).max().unwrap_or(0)
}

/// A perfect conductor in uniform light is invisible, to one 8-bit step. Without compensation, it loses the share of
/// multiple scattering, which for the exact term is 1 - E by quadrature.
#[test]
fn a_perfect_conductor_vanishes_in_even_light() -> TestResult {
    let Some(gpu) = gpu("a_perfect_conductor_vanishes_in_even_light") else { return Ok(()) };
    let environment = Environment::uniform(DVec3::new(1.0, 0.5, 0.25))?;
    let wall = mirrors();
    for quality in Quality::ALL {
        let seen = wall.render(&gpu, &environment, &quality.shading())?;
        assert!(codes_apart(&seen) <= 1, "{quality:?}: {} codes", codes_apart(&seen));
        // The picture shows the environment's radiance, rather than any uniform color.
        let beside = seen.last().map(|s| s.nits).unwrap_or_default();
        assert!((beside - DVec3::new(1.0, 0.5, 0.25)).abs().max_element() < 1e-3, "{beside}");

        let lossy = Shading { compensate_image: false, ..quality.shading() };
        let seen = wall.render(&gpu, &environment, &lossy)?;
        assert!(codes_apart(&seen) > 20, "{quality:?} without compensation");
        let masking = if quality == Quality::Low { Masking::Hammon } else { Masking::Smith };
        for (card, seen) in wall.cards.iter().zip(&seen) {
            let [_, kept] = ggx(card.nov, card.material.roughness.into(), masking);
            // Half floats, a 64² table, and 11 bits of the cube.
            assert!((seen.nits.x - kept).abs() < 4e-3, "{quality:?} {card:?}: {} for {kept}", seen.nits.x);
        }
    }
    Ok(())
}

/// Mean and largest errors of compensation against a random walk match the design (accuracy 1.3), at both qualities.
#[test]
fn compensation_in_the_frame_has_the_stated_error() -> TestResult {
    let Some(gpu) = gpu("compensation_in_the_frame_has_the_stated_error") else { return Ok(()) };
    let truth = truth(4000);
    let errors = frame_errors(&gpu, &Quality::High.shading(), &truth)?;
    // f0 = 1, 0.9, 0.6, 0.3, 0.04; 4000 walks have an error of up to 2 %.
    for ((e, f0), (mean, worst)) in
        errors.iter().zip(F0).zip([(0.0, 0.0), (0.005, 0.047), (0.016, 0.145), (0.021, 0.13), (0.034, -0.08)])
    {
        assert!((e.mean - mean).abs() < 0.006 && (e.worst - worst).abs() < 0.025, "f0 = {f0}: {e:?}");
    }
    for (e, printed) in errors.iter().zip(numbers("White furnace through", &["high", "on"])) {
        assert!((e.mean - printed[0]).abs() < 0.006 && (e.worst - printed[1]).abs() < 0.025, "{e:?} for {printed:?}");
    }
    let [none, ..] = frame_errors(&gpu, &Shading { compensate_image: false, ..Shading::default() }, &truth)?;
    assert!(none.mean > 0.15 && (none.worst + 0.69).abs() < 0.015, "the loss that is known: {none:?}");
    Ok(())
}

/// Direct lights are compensated like image-based light: the ratio of on to off is 1/E. A table of the wrong term is
/// detected.
#[test]
fn lights_are_compensated_by_the_table_of_their_term() -> TestResult {
    let Some(gpu) = gpu("lights_are_compensated_by_the_table_of_their_term") else { return Ok(()) };
    let dark = Environment::uniform(DVec3::ZERO)?;
    let light = Light::directional("lamp", Vec3::new(0.0, 0.0, -1.0), 4.0);
    let wall = Wall { light: Some(light), ..mirrors() };
    let ratios = |shading: Shading| -> Result<Vec<f64>, Box<dyn Error>> {
        let on = wall.render(&gpu, &dark, &Shading { compensate_punctual: true, ..shading })?;
        let off = wall.render(&gpu, &dark, &Shading { compensate_punctual: false, ..shading })?;
        Ok(on.iter().zip(off).map(|(on, off)| on.nits.x / off.nits.x).collect())
    };
    let apart = |ratios: &[f64], masking| {
        let rough = wall.cards.iter().zip(ratios).filter(|(card, _)| card.material.roughness >= 0.5 && card.nov >= 0.3);
        let share = |(card, ratio): (&Card, &f64)| {
            let [_, kept] = ggx(card.nov, card.material.roughness.into(), masking);
            (ratio * kept - 1.0).abs()
        };
        rough.map(share).fold(0.0, f64::max)
    };
    let high = apart(&ratios(Quality::High.shading())?, Masking::Smith);
    let low = apart(&ratios(Quality::Low.shading())?, Masking::Hammon);
    // Two half floats, and a 64² table.
    assert!(high < 6e-3 && low < 6e-3, "{high} {low}");
    let mixed = Shading { table: Visibility::Exact, ..Quality::Low.shading() };
    let mixed = apart(&ratios(mixed)?, Masking::Hammon);
    assert!(mixed > 0.05, "the other term's table is {mixed} off");
    Ok(())
}
