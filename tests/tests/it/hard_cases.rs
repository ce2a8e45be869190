//! The library with inputs that break arithmetic, and the purpose of its guards. `tests/src/hard` has the tables.

use crate::stage;
use std::error::Error;
use std::fs;
use std::path::Path;
use tests::hard::document::{UNNOTICED, kept, rows};
use tests::hard::judge::Questions;
use tests::hard::probe::{all, builds};
use tests::hard::rows::{Place, ROWS};
use tests::measure::half_model::HalfModel;

type TestResult = Result<(), Box<dyn Error>>;

const DOCUMENT: &str = include_str!("../../../docs/measurements/hard-cases.md");
const RENEW: &str = "renew docs/measurements/hard-cases.md: cargo run -p tests --bin measure -- hard-cases";

/// Returns true if a file has a test with a name.
fn is_tested(file: &str, test: &str) -> Result<bool, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file);
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let lines: Vec<_> = text.lines().map(str::trim).collect();
    let declared = format!("fn {test}()");
    Ok(lines.windows(2).any(|pair| pair[0] == "#[test]" && pair[1].starts_with(&declared)))
}

#[test]
fn every_row_is_held_by_tests_that_are_there() -> TestResult {
    assert!(ROWS.iter().zip(1..).all(|(row, number)| row.number == number), "rows in order");
    for row in &ROWS {
        assert!(row.is_held(), "row {}", row.number);
        for place in row.places {
            if let Place::Test(file, test) = place {
                assert!(is_tested(file, test)?, "row {}: {file} has no test {test}", row.number);
            }
        }
    }
    assert!(!is_tested("passes/src/gpu_scene/shadow_views/tests.rs", "hard_case_40")?, "a part of a name is no name");
    for probe in all() {
        assert!(builds().iter().any(|case| probe.case(case).is_some()), "{}: no such function", probe.name());
    }
    for row in rows() {
        assert!(DOCUMENT.lines().any(|line| line == row), "{row}\n{RENEW}");
    }
    Ok(())
}

/// Tests every function in every build of the device, one dispatch each. Also removes every fifth guard, which must be detected or explained; the program `hard_cases` removes each.
#[test]
fn hard_inputs_leave_every_invariant_and_guards_are_missed() -> TestResult {
    let test = "hard_inputs_leave_every_invariant_and_guards_are_missed";
    let Some(gpu) = stage::gpu(test) else { return Ok(()) };
    let has_half = gpu.device.features().contains(wgpu::Features::SHADER_F16);
    let mut failures = Vec::new();
    for case in builds().into_iter().filter(|case| has_half || !case.in_half) {
        let found = Questions::of(case).ask(&gpu)?;
        failures.extend(found.into_iter().map(|f| format!("{} (f16: {}): {}", f.name, case.in_half, f.what)));
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    if !DOCUMENT.contains(&format!("Adapter: {}\n", gpu.describe())) {
        test_report::skip(
            test,
            &format!("the figures of docs/measurements/hard-cases.md are not of {}", gpu.describe()),
        );
        return Ok(());
    }
    let guards = kept(&gpu, 0, 5)?;
    let missed = guards.iter().filter(|guard| guard.by.is_some()).count();
    assert!(missed > 25, "only {missed} of {} guards were missed", guards.len());
    for guard in guards {
        let explained = UNNOTICED.iter().any(|(function, text, _)| *function == guard.function && *text == guard.guard);
        let line = format!("| {} | `{}` | ", guard.function, guard.guard.replace('|', "\\|"));
        let documented = DOCUMENT.lines().find_map(|row| row.strip_prefix(line.as_str()));
        let documented = documented.unwrap_or_else(|| panic!("{line} is missing; {RENEW}"));
        assert_eq!(documented.starts_with("fails: "), !explained, "{line}{documented}; {RENEW}");
        assert!(!(explained && guard.by.is_some()), "{line} is missed: {:?}", guard.by);
    }
    Ok(())
}

/// The invariants of probes also hold for half floats on the CPU, with and without flushing of numbers below 6.1e-5.
#[test]
fn models_of_half_floats_hold_with_and_without_small_numbers() {
    type Model = fn(HalfModel, &[f64]) -> f64;
    let models: [(&str, Model); 8] = [
        ("clamp_nov", |m, x| m.clamp_nov(x[0])),
        ("v_smith_ggx_correlated", |m, x| m.v_smith_ggx_correlated(x[0], x[1], x[2])),
        ("v_smith_ggx_correlated_fast", |m, x| m.v_smith_ggx_correlated_fast(x[0], x[1], x[2])),
        ("f_schlick_scalar", |m, x| m.f_schlick_scalar(x[0], x[1], x[2])),
        ("v_kelemen", |m, x| m.v_kelemen(x[0])),
        ("v_neubelt", |m, x| m.v_neubelt(x[0], x[1])),
        ("pow5", |m, x| m.pow5(x[0])),
        ("energy_compensation", |m, x| m.energy_compensation(x[0], x[3])),
    ];
    let mut judged = 0;
    for flush in [false, true] {
        let model = HalfModel { flush, scale: 64.0 };
        for case in builds().into_iter().filter(|case| case.in_half) {
            let Some((_, evaluate)) = models.iter().find(|(name, _)| *name == case.function) else { continue };
            for asked in all().filter_map(|probe| Some((probe, probe.case(&case)?))) {
                let (probe, inputs) = (asked.0, asked.1.hard_inputs(4096));
                for x in inputs.chunks_exact(case.input_width()).filter(|x| x.iter().all(|x| x.is_finite())) {
                    let numbers: Vec<f64> = x.iter().map(|x| model.round(f64::from(*x))).collect();
                    let y = evaluate(model, &numbers) as f32;
                    assert!(y.is_finite() && (probe.holds)(x, &[y]), "{} {model:?} {x:?}: {y}", probe.name());
                    judged += 1;
                }
            }
        }
    }
    assert!(judged > 2000, "{judged}");
}
