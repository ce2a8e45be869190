//! The shading library in half floats, on a device that supports them: compared with mirrors, at hard inputs, and with
//! negative controls.

use crate::stage;
use framegraph_passes::Precision;
use framegraph_shader_mirrors::cases::{self, Case, Domain};
use framegraph_wgpu::Gpu;
use glam::DVec3;
use std::error::Error;
use tests::measure::half::{self, Form, LobeError, lobe, lobe_error};
use tests::measure::half_model::HalfModel;
use tests::measure::half_table::{self, POINTS, Studio};
use tests::mirror;

mod hard;

type TestResult = Result<(), Box<dyn Error>>;

/// Returns a device with half floats in shaders; otherwise reports `test` as skipped.
fn gpu(test: &str) -> Option<Gpu> {
    let gpu = stage::gpu(test)?;
    if gpu.device.features().contains(wgpu::Features::SHADER_F16) {
        return Some(gpu);
    }
    test_report::skip(test, &format!("{} has no half floats in shaders", gpu.describe()));
    None
}

fn case(function: &str) -> Result<Case, String> {
    cases::half().find(|case| case.function == function).ok_or(format!("{function} has no case in half floats"))
}

/// Also compares the document's table.
#[test]
fn every_function_of_the_half_build_equals_its_mirror_on_the_device() -> TestResult {
    let test = "every_function_of_the_half_build_equals_its_mirror_on_the_device";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let rows = half_table::mirrors(&gpu)?;
    assert!(rows.len() > 25, "only {} functions were compared", rows.len());
    let documented = documented("Functions");
    let names = |row: &[&'static str]| row.first().copied().map(str::to_owned);
    let found: Vec<_> = documented.iter().filter_map(|row| names(row)).collect();
    assert_eq!(found, rows.iter().map(|row| row.name.clone()).collect::<Vec<_>>());
    if on_the_documents_adapter(test, &gpu) {
        for (row, told) in rows.iter().zip(documented) {
            same(&row.name, told[1], row.full.absolute);
            same(&row.name, told[3], row.half.absolute);
        }
    }
    Ok(())
}

const DOCUMENT: &str = include_str!("../../../docs/measurements/half-floats.md");

/// Returns the cells of the table below a heading.
fn documented(heading: &str) -> Vec<Vec<&'static str>> {
    let mark = format!("\n## {heading}");
    let (_, after) = DOCUMENT.split_once(&mark).expect("the document has the heading");
    let section = after.split("\n## ").next().unwrap_or_default();
    let lines = section.lines().filter(|line| line.starts_with('|'));
    let cells = |line: &'static str| line.trim_matches('|').split(" | ").map(str::trim).collect();
    lines.skip(2).map(cells).collect()
}

/// Returns true on the document's adapter, since rounding depends on the device.
fn on_the_documents_adapter(test: &str, gpu: &Gpu) -> bool {
    let same = DOCUMENT.contains(&format!("Adapter: {}\n", gpu.describe()));
    if !same {
        test_report::skip(
            test,
            &format!("the figures of docs/measurements/half-floats.md are not of {}", gpu.describe()),
        );
    }
    same
}

/// Checks a documented figure, with a tolerance for other processors under the same driver.
fn same(what: &str, told: &str, measured: f64) {
    let told: f64 = told.parse().unwrap_or_else(|e| panic!("{what}: {told}: {e}"));
    assert!((told - measured).abs() <= 0.2 * measured.abs() + 1e-9, "{what}: {told} is told, {measured} measured");
}

/// Negative controls: the textbook's distribution in half floats exceeds the bound. A result that is off by 10 % does
/// too, if half floats are more precise.
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

/// The design's table of D: median and 99th percentile.
#[test]
fn the_distribution_has_the_stated_error() -> TestResult {
    let Some(gpu) = gpu("the_distribution_has_the_stated_error") else { return Ok(()) };
    let check = on_the_documents_adapter("the_distribution_has_the_stated_error", &gpu);
    let documented = documented("GGX");
    assert_eq!(documented.len(), half_table::ROUGHNESS.len());
    for (roughness, told) in half_table::ROUGHNESS.into_iter().zip(documented) {
        let errors = half_table::lobes(&gpu, roughness)?;
        let stated = [(0.089, 0.011, 0.085), (0.2, 0.0025, 0.017), (0.5, 0.0010, 0.0041)];
        let [textbook, product, cross, half_textbook, half_cross] = errors;
        if let Some((_, median, p99)) = stated.into_iter().find(|(r, ..)| *r == roughness) {
            // The samples differ from the design's, which has two digits.
            let e = half_cross;
            assert!(e.median < 1.25 * median && e.p99 < 1.25 * p99, "roughness {roughness}: {e:?}");
            assert!([textbook, product, cross].iter().all(|e| e.p99 < 0.01), "roughness {roughness}: {errors:?}");
            let lost = half_textbook;
            assert!(lost.median > 4.0 * e.median, "the textbook loses the angle at {roughness}: {lost:?}");
        }
        for (e, cell) in errors.iter().zip(&told[1..]).filter(|_| check) {
            let (median, p99) = cell.split_once(" / ").ok_or("two figures")?;
            same(&format!("median at {roughness}"), median, e.median);
            same(&format!("99th percentile at {roughness}"), p99, e.p99);
        }
    }
    Ok(())
}

/// Pictures in half floats resemble those in f32, unlike pictures with wider highlights.
#[test]
fn pictures_in_half_floats_are_close() -> TestResult {
    let test = "pictures_in_half_floats_are_close";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let check = on_the_documents_adapter(test, &gpu);
    for (scene, told) in half_table::SCENES.into_iter().zip(documented("Pictures")) {
        let studio = Studio::new(&gpu, scene)?;
        let d = studio.difference(&gpu, 0.089)?;
        // The design measured 0.9 8-bit steps on a sphere; rounding can add one.
        assert!(d.psnr_db > 58.0 && d.largest_codes <= 3, "{scene}: {d:?}");
        assert_eq!(told[0], scene);
        if check {
            let psnr: f64 = told[1].trim_end_matches(" dB").parse()?;
            assert!((psnr - d.psnr_db).abs() < 1.0, "{scene}: {psnr} dB is told, {d:?} measured");
        }
        if scene == "spheres" {
            let wide = studio.difference(&gpu, 0.12)?;
            assert!(wide.psnr_db < d.psnr_db - 3.0 && wide.largest_codes > 3, "roughness from 0.12 on: {wide:?}");
        }
    }
    Ok(())
}

/// A precision that the device lacks is rejected by name, and a supported one makes a picture.
#[test]
fn a_device_without_half_floats_is_reported() -> TestResult {
    let Some(gpu) = stage::gpu("a_device_without_half_floats_is_reported") else { return Ok(()) };
    let has = gpu.device.features().contains(wgpu::Features::SHADER_F16);
    let studio = Studio::new(&gpu, "spheres")?;
    match studio.shoot(&gpu, Precision::Half, 0.089) {
        Ok(_) => assert!(has),
        Err(error) => assert!(!has && error.to_string().contains(&gpu.info().name), "{error}"),
    }
    Ok(())
}

/// Devices may flush numbers below 6.1e-5 to zero. A CPU model stays within the shader's bounds with and without
/// flushing, but not without the factor on squares.
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

/// The device computes in half floats at least as precisely as the model.
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
