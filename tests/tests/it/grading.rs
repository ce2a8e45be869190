//! Color grading: errors of tables, features that only tables have, and hard inputs of curves, numbered as in the
//! design.

use crate::stage::{Set, Shot, gpu};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::grading::{Extras, GradeBy, GradingTables, Look, OwnCurve, TableDesc};
use framegraph_passes::{PostSettings, Settings};
use framegraph_scene::ColorTable;
use framegraph_shader_mirrors::cases::{self, Case, Domain};
use framegraph_shaders::layout::{EncodingUniforms, ExposureUniforms, ToneMap};
use glam::DVec3;
use std::error::Error;
use std::path::Path;
use tests::files::references;
use tests::measure::grading::{HEAD, descs, error, looks};
use tests::mirror;
use tests::reference::color;
use tests::reference::document::Document;

type TestResult = Result<(), Box<dyn Error>>;

/// Extras of settings alone.
static NO_EXTRAS: Extras = Extras { own: None, colors: None };

const DOCUMENT: &str = include_str!("../../../docs/design/grading.md");

/// The document's table matches the command's output; tables with 64 entries per axis are left to the command.
#[test]
fn tables_are_as_near_as_the_document_says() -> TestResult {
    assert!(DOCUMENT.contains(HEAD), "the head of the table");
    for (name, look) in looks() {
        for desc in descs(&look) {
            let begins = |row: &&str| {
                let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
                let entries = if look.keeps_channels_apart(&NO_EXTRAS) {
                    TableDesc::CURVE_ENTRIES
                } else {
                    usize::from(desc.entries)
                };
                cells.len() == 9 && cells[..3] == [name, &entries.to_string(), desc.format.name()]
            };
            let row = DOCUMENT.lines().find(begins).ok_or_else(|| format!("{name} {desc:?} is not in the document"))?;
            if desc.entries < 64 {
                assert_eq!(
                    row,
                    error(name, &look, desc)?.row(),
                    "renew it: cargo run --release -p tests --bin measure -- grading"
                );
            }
        }
    }
    Ok(())
}

/// Looks computed in f64 on charts graded by Filament differ only by the rounding of its table.
#[test]
fn directly_computed_charts_are_as_near_as_the_document_says() -> TestResult {
    let folder = references().with_file_name("filament_frame");
    let charts =
        ["06_ramp_aces", "06g_grade_contrast_1_4", "06g_grade_curves", "06g_grade_smh", "06g_grade_wb_0_3_m0_2"];
    for id in charts {
        let document = Document::read(&folder.join(format!("{id}.json")))?;
        let look = color::look(document.scene.view.color_grading.as_ref().ok_or("grading")?);
        let off = |look: &Look| -> Result<Vec<f64>, Box<dyn Error>> {
            let (function, text) =
                (look.function(&NO_EXTRAS)?, std::fs::read_to_string(folder.join(format!("{id}.csv")))?);
            let patch = |line: &str| {
                let n: Vec<f64> = line.split(',').filter_map(|cell| cell.parse().ok()).collect();
                let codes = (function(DVec3::new(n[2], n[3], n[4])) * 255.0).round();
                (codes - DVec3::new(n[5], n[6], n[7])).abs().max_element()
            };
            Ok(text.lines().skip(1).map(patch).collect())
        };
        let beyond = |off: &[f64], codes: f64| off.iter().filter(|o| **o > codes).count() as f64 / off.len() as f64;
        let found = off(&look)?;
        assert!(found.len() == 768 && beyond(&found, 1.0) <= 0.0095 && beyond(&found, 3.0) <= 0.0075, "{id}");
        let control = off(&Look { tone_map: ToneMap::Hill, ..look })?;
        assert!(beyond(&control, 3.0) > 0.2, "{id}: Hill's fit is another curve");
    }
    Ok(())
}

/// Hard inputs of arithmetic (rows 47, 48, 49, 56).
const HARD: Domain = Domain::Values(&[
    0.0, -0.0, -0.2, -1.0, -0.008_64, 6e-8, 1e-6, 6.1e-5, 0.18, 1.0001, 58.86, 160.0, 161.6, 65504.0, 1e19, 1.2e19,
    3e38,
]);

/// Evaluates a function at hard inputs in f32 and, if the device supports it, in half floats.
fn at(name: &str, parameters: &'static [Domain], holds: impl Fn(&[f32], &[f32]) -> bool) -> TestResult {
    let Some(gpu) = gpu(name) else { return Ok(()) };
    let halves = gpu.device.features().contains(wgpu::Features::SHADER_F16);
    let function = cases::all().find(|case| case.function == name).ok_or(name)?;
    for in_half in [false, true] {
        if in_half && !halves {
            test_report::skip("grading in half floats", "the device has no half floats in shaders");
            continue;
        }
        // The call of the function's own parameters, which the new ones replace number by number.
        let case = Case { parameters, call: function.expression().leak(), in_half, ..*function };
        // Colors are f32 in both builds, so inputs need not be half floats.
        let inputs = Case { in_half: false, ..case }.inputs(4096);
        let results = mirror::results(&gpu, &case, &inputs)?;
        let rows = inputs.chunks_exact(case.input_width()).zip(results.chunks_exact(case.results.len()));
        for (x, y) in rows {
            let finite = y.iter().all(|y| y.to_bits() & 0x7f80_0000 != 0x7f80_0000);
            assert!(finite && holds(x, y), "{name}, half floats {in_half}: {x:?}: {y:?}");
        }
    }
    Ok(())
}

fn in_unit(y: &[f32]) -> bool {
    y.iter().all(|y| (-1e-6..=1.0 + 1e-6).contains(y))
}

#[test]
fn hard_case_47_no_curve_leaves_its_range() -> TestResult {
    at("tone_map", &[HARD, HARD, HARD, Domain::Count(13), Domain::Count(2)], |_, y| in_unit(y))?;
    // Grays do not get darker as light grows.
    at("tone_aces", &[Domain::Vector(3, 100.0, 1e19), Domain::Values(&[1.0, 1.0 / 0.6])], |_, y| {
        y.iter().all(|y| *y > 0.5)
    })
}

#[test]
fn hard_case_48_coordinates_of_tables_stay_within() -> TestResult {
    at("log_c_from_linear", &[HARD, HARD, HARD], |_, y| y.iter().all(|y| (0.0639..30.0).contains(y)))?;
    at("table_coordinates", &[HARD, HARD, HARD, Domain::Values(&[16.0, 64.0])], |x, y| {
        y.iter().all(|y| (0.5 / x[3]..=1.0 - 0.499 / x[3]).contains(y))
    })
}

#[test]
fn hard_case_49_encoding_stays_within() -> TestResult {
    at("srgb_from_linear", &[HARD, HARD, HARD], |_, y| in_unit(y))?;
    at("linear_from_srgb", &[HARD, HARD, HARD], |_, y| in_unit(y))
}

/// Values stored in textures of 11 or 16 bits are within the format's range.
#[test]
fn hard_case_26_stored_light_is_finite() -> TestResult {
    at("quantize_rgba16float", &[HARD, HARD, HARD, HARD, Domain::Count(2)], |_, y| {
        y.iter().all(|y| y.abs() <= 65504.0)
    })?;
    at("quantize_rg11b10ufloat", &[HARD, HARD, HARD, Domain::Count(2)], |_, y| {
        y.iter().all(|y| (0.0..=65024.0).contains(y))
    })
}

#[test]
fn hard_case_55_noise_does_not_repeat_far_out() -> TestResult {
    let Some(gpu) = gpu("hard_case_55_noise_does_not_repeat_far_out") else { return Ok(()) };
    let case = cases::all().find(|case| case.function == "interleaved_gradient_noise").ok_or("the noise")?;
    for (corner, frame) in [(0.5_f32, 0.0), (8000.5, 63.0), (0.5, 1e6)] {
        let points = (0..64).flat_map(|y| (0..64).map(move |x| [corner + x as f32, corner + y as f32, frame]));
        let inputs: Vec<f32> = points.flatten().collect();
        let noise: Vec<f64> = mirror::results(&gpu, case, &inputs)?.into_iter().map(f64::from).collect();
        let mut distinct: Vec<u64> = noise.iter().map(|x| x.to_bits()).collect();
        distinct.sort_unstable();
        distinct.dedup();
        let mean = noise.iter().sum::<f64>() / 4096.0;
        let deviation = (noise.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 4096.0).sqrt();
        assert!(distinct.len() >= 2000 && (deviation - 0.289).abs() < 0.01, "{corner}: {} {deviation}", distinct.len());
    }
    Ok(())
}

/// Exposure is an f32 factor that never becomes 0.
#[test]
fn hard_case_21_exposure_is_finite_and_above_zero() {
    for ev in [-24.0, -20.0, -15.0, -10.0, 0.0, 10.0, 16.0] {
        let scale = ExposureUniforms::new(ev).scale;
        assert!(scale.is_finite() && scale >= f32::MIN_POSITIVE, "{ev}: {scale}");
    }
    assert_eq!(EncodingUniforms::new(1.0, u32::MAX).frame_index, u32::MAX);
}

fn settings(look: Look, by: GradeBy) -> Settings {
    let post = PostSettings { look, by, dither: 0.0, ..PostSettings::DEFAULT };
    Settings { samples: 1, fxaa: false, shadows: None, post, ..Settings::default() }
}

/// A look's table is computed once for any number of frames, and again when the look changes.
#[test]
fn a_table_is_made_once_for_a_look() -> TestResult {
    let Some(gpu) = gpu("a_table_is_made_once_for_a_look") else { return Ok(()) };
    let by = GradeBy::from_text("table:16")?;
    let shot = Shot::small(settings(Look::default(), by));
    let set = Set::new(&gpu, "spheres", &shot, &Background::Environment)?;
    let (direct, plan) = set.shoot(&gpu, &Shot::small(settings(Look::default(), GradeBy::Direct)))?;
    assert_eq!((set.world().grading.count(), plan.counts().inlined), (0, 1));
    let (table, plan) = set.shoot(&gpu, &shot)?;
    let (again, _) = set.shoot(&gpu, &shot)?;
    assert_eq!((set.world().grading.count(), plan.counts().inlined), (1, 1), "inlined, and made once");
    assert!(table == again);
    let apart = |a: &[u8], b: &[u8]| {
        let off = |(a, b): (&u8, &u8)| f64::from(a.abs_diff(*b));
        a.iter().zip(b).map(off).sum::<f64>() / a.len() as f64
    };
    // The mean error of 16 entries in the document is below two 8-bit steps.
    assert!((1e-3..2.0).contains(&apart(&direct, &table)), "{}", apart(&direct, &table));
    let aces = Look { tone_map: ToneMap::Aces, ..Look::default() };
    set.shoot(&gpu, &Shot::small(settings(aces, by)))?;
    assert_eq!(set.world().grading.count(), 2, "another look");
    Ok(())
}

/// Custom curves and colors from a file need a table; without one, the error explains this.
#[test]
fn tables_know_curves_and_colors_of_ones_own() -> TestResult {
    let Some(gpu) = gpu("tables_know_curves_and_colors_of_ones_own") else { return Ok(()) };
    let by = GradeBy::from_text("table:32")?;
    let own = Look { tone_map: ToneMap::Own, ..Look::default() };
    let shot = |look, by| Shot::small(settings(look, by));
    let mut set = Set::new(&gpu, "spheres", &shot(own, by), &Background::Environment)?;
    let told = |result: Result<(Vec<u8>, framegraph::Plan), Box<dyn Error>>| {
        result.map(|_| String::new()).unwrap_or_else(|error| error.to_string())
    };
    assert!(told(set.shoot(&gpu, &shot(own, by))).contains("GradingTables::set_own"));
    assert!(told(set.shoot(&gpu, &shot(own, GradeBy::Direct))).contains("--grade-by table"));
    set.world_mut().grading.set_own(Some(OwnCurve::new(|c| c.min(DVec3::ONE))));
    let linear = Look { tone_map: ToneMap::Linear2020, ..Look::default() };
    let (by_own, _) = set.shoot(&gpu, &shot(own, by))?;
    let (by_name, _) = set.shoot(&gpu, &shot(linear, by))?;
    assert!(by_own == by_name, "cut off at one in Rec.2020, by either");

    let swapped = "LUT_3D_SIZE 2\n0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n";
    let colors = ColorTable::load_bytes(Path::new("swap.cube"), swapped.as_bytes())?;
    set.world_mut().grading.set_colors(Some(colors));
    assert_eq!(set.world().grading.count(), 0, "tables are made anew");
    let (changed, _) = set.shoot(&gpu, &shot(linear, by))?;
    for (a, b) in by_name.chunks_exact(4).zip(changed.chunks_exact(4)) {
        let off = (0..3).map(|c| a[c].abs_diff(b[2 - c])).max();
        // 8-bit steps of interpolated half floats.
        assert!(off <= Some(1), "{a:?} {b:?}");
    }
    assert!(told(set.shoot(&gpu, &shot(linear, GradeBy::Direct))).contains("a file of colors"));
    Ok(())
}

/// Tables have no extras by default.
#[test]
fn new_tables_have_no_extras() {
    let tables = GradingTables::default();
    assert!(tables.extras().own.is_none() && tables.extras().colors.is_none() && tables.count() == 0);
}
