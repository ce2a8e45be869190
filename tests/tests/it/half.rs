//! The shading library in half floats, on a device that has them: against its mirrors, at inputs that break it, and with
//! what must not pass.

use crate::stage;
use glam::DVec3;
use renderer::wgpu::Gpu;
use shaders::reference::cases::{self, Case, Domain};
use std::error::Error;
use tests::measure::half::{self, Form, LobeError, lobe, lobe_error};
use tests::measure::half_model::HalfModel;
use tests::{mirror, report};

mod hard;

type TestResult = Result<(), Box<dyn Error>>;

/// Points of each function's domain, a quarter of which are corners.
const POINTS: usize = 2048;

/// A device whose shaders can compute in half floats, or the words for why there is none.
fn gpu(test: &str) -> Option<Gpu> {
    let gpu = stage::gpu(test)?;
    if gpu.device.features().contains(wgpu::Features::SHADER_F16) {
        return Some(gpu);
    }
    report::skip(test, &format!("{} has no half floats in shaders", gpu.describe()));
    None
}

fn case(function: &str) -> Result<Case, String> {
    cases::half().find(|case| case.function == function).ok_or(format!("{function} has no case in half floats"))
}

#[test]
fn every_function_of_the_half_build_equals_its_mirror_on_the_device() -> TestResult {
    let Some(gpu) = gpu("every_function_of_the_half_build_equals_its_mirror_on_the_device") else { return Ok(()) };
    let mut failures = Vec::new();
    let mut compared = 0;
    for case in cases::half() {
        match mirror::compare(&gpu, &case, POINTS) {
            Ok(_) => compared += 1,
            Err(error) => failures.push(error.to_string()),
        }
    }
    assert!(failures.is_empty(), "{} of {} differ:\n{}", failures.len(), compared, failures.join("\n"));
    assert!(compared > 25, "only {compared} functions were compared");
    Ok(())
}

/// What the textbook makes of the distribution in half floats lies outside of the bound, and so does a result that is 10 %
/// off where half floats are good to less.
#[test]
fn the_textbook_form_and_results_that_are_off_are_found() -> TestResult {
    let Some(gpu) = gpu("the_textbook_form_and_results_that_are_off_are_found") else { return Ok(()) };
    let cross = case("d_ggx_cross")?;
    assert!(mirror::compare(&gpu, &cross, POINTS).is_ok());
    assert!(mirror::compare(&gpu, &half::textbook(cross), POINTS).is_err(), "1 - noh² passes");
    for name in ["v_smith_ggx_correlated", "f_schlick", "energy_compensation", "v_neubelt"] {
        let case = case(name)?;
        let inputs = case.inputs(POINTS);
        let mut results = mirror::results(&gpu, &case, &inputs)?;
        assert!(case.check(&inputs, &results).is_ok(), "{name}");
        results.iter_mut().for_each(|y| *y *= 1.1);
        assert!(case.check(&inputs, &results).is_err(), "{name} times 1.1 passes");
    }
    Ok(())
}

/// The design's table of D, with what was measured there: median and 99th percentile.
#[test]
fn the_distribution_errs_as_stated() -> TestResult {
    let Some(gpu) = gpu("the_distribution_errs_as_stated") else { return Ok(()) };
    for (roughness, median, p99) in [(0.089, 0.011, 0.085), (0.2, 0.0025, 0.017), (0.5, 0.0010, 0.0041)] {
        let e = lobe_error(&gpu, Form::HalfCross, roughness, 4096)?;
        // Other samples than the design's, and two digits there.
        assert!(e.median < 1.25 * median && e.p99 < 1.25 * p99, "roughness {roughness}: {e:?}");
    }
    let textbook = lobe_error(&gpu, Form::HalfTextbook, 0.089, 4096)?;
    assert!(textbook.median > 0.5, "half floats have lost the angle: {textbook:?}");
    for form in [Form::Textbook, Form::Product, Form::Cross] {
        let e = lobe_error(&gpu, form, 0.089, 4096)?;
        assert!(e.p99 < 0.01, "{form:?}: {e:?}");
    }
    Ok(())
}

/// Devices may make zero of numbers below 6.1e-5. On the CPU, operation by operation, both kinds stay within the bounds that
/// the shader is held to; without the factor on squares they do not.
#[test]
fn bounds_hold_whether_or_not_small_numbers_are_flushed() -> TestResult {
    let (d, v) = (case("d_ggx_cross")?, case("v_smith_ggx_correlated")?);
    for (flush, scale, sound) in [(false, 64.0, true), (true, 64.0, true), (true, 1.0, false)] {
        let model = HalfModel { flush, scale };
        let inputs = d.inputs(4 * POINTS);
        let rows = inputs.chunks_exact(d.input_width()).map(|x| {
            let [n, h] = vectors(x);
            model.d_ggx_cross(n, h, model.round(n.dot(h)), f64::from(x[6])) as f32
        });
        let checked = d.check(&inputs, &rows.collect::<Vec<_>>());
        assert_eq!(checked.is_ok(), sound, "D, {model:?}: {checked:?}");
        let inputs = v.inputs(4 * POINTS);
        let rows = inputs.chunks_exact(3).map(|x| {
            let [nov, nol, alpha] = [0, 1, 2].map(|i| f64::from(x[i]));
            model.v_smith_ggx_correlated(nov, nol, alpha) as f32
        });
        let checked = v.check(&inputs, &rows.collect::<Vec<_>>());
        assert_eq!(checked.is_ok(), sound, "V, {model:?}: {checked:?}");
    }
    Ok(())
}

/// The device computes in half floats, no worse than the model of them.
#[test]
fn the_device_is_as_good_as_the_model() -> TestResult {
    let Some(gpu) = gpu("the_device_is_as_good_as_the_model") else { return Ok(()) };
    let model = HalfModel { flush: false, scale: 64.0 };
    for roughness in [0.089, 0.3] {
        let (rows, truth) = lobe(roughness, 4096, true);
        let values = rows.chunks_exact(7).map(|x| {
            let [n, h] = vectors(x);
            model.d_ggx_cross(n, h, model.round(n.dot(h)), f64::from(x[6]))
        });
        let modelled = LobeError::of(values, truth.into_iter());
        let device = lobe_error(&gpu, Form::HalfCross, roughness, 4096)?;
        assert!(device.median < 1.1 * modelled.median && device.p99 < 1.1 * modelled.p99, "{device:?} {modelled:?}");
    }
    Ok(())
}

fn vectors(x: &[f32]) -> [DVec3; 2] {
    [0, 3].map(|at| DVec3::new(x[at].into(), x[at + 1].into(), x[at + 2].into()))
}
