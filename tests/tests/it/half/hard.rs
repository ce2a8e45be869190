//! Light outside the range of half floats, and degenerate directions, beyond the probes of single functions in
//! `tests/src/hard`.

use super::{Case, Domain, TestResult, case, gpu, mirror};
use Domain::{Direction, Values, Vector};

/// Largest finite half float.
const MOST: f32 = 65504.0;

/// D and V each fit half floats at common angles, but their product does not (rows 4, 19).
#[test]
fn highlights_beyond_half_floats_are_kept() -> TestResult {
    let Some(gpu) = gpu("highlights_beyond_half_floats_are_kept") else { return Ok(()) };
    const MIRROR_ANGLE: &[Domain] = &[
        Values(&[0.0]),
        Values(&[0.0]),
        Values(&[1.0]),
        Values(&[-0.9999]),
        Values(&[0.0]),
        Values(&[0.0141]),
        Values(&[0.9999]),
        Values(&[0.0]),
        Values(&[0.0141]),
        Values(&[0.007_921]),
        Vector(3, 0.0, 0.0),
        Vector(3, 1.0, 1.0),
        Values(&[1.0]),
        Vector(3, 1.0, 1.0),
        Values(&[0.0]),
    ];
    let case = Case { parameters: MIRROR_ANGLE, ..case("reflect_light")? };
    let inputs = case.inputs(8);
    let results = mirror::results(&gpu, &case, &inputs)?;
    let expected = (case.mirror)(&inputs[..case.input_width()].iter().map(|x| f64::from(*x)).collect::<Vec<_>>());
    assert!(expected[0] > 65504.0, "{expected:?}");
    assert!((f64::from(results[0]) / expected[0] - 1.0).abs() < 0.1, "{} {}", results[0], expected[0]);
    Ok(())
}

/// Colors outside the range of half floats are clamped on conversion.
#[test]
fn colors_beyond_half_floats_are_held() -> TestResult {
    let Some(gpu) = gpu("colors_beyond_half_floats_are_held") else { return Ok(()) };
    let inputs = [65504.0, 65536.0, 1e30, -1e30, f32::MAX, 0.5];
    let results = mirror::results(&gpu, &case("to_real3")?, &inputs)?;
    assert_eq!(results, [MOST, MOST, MOST, -MOST, MOST, 0.5]);
    Ok(())
}

/// A light exactly opposite the viewer has no half vector.
#[test]
fn opposite_light_is_finite() -> TestResult {
    let Some(gpu) = gpu("opposite_light_is_finite") else { return Ok(()) };
    let case = Case {
        call: "reflect_light(StandardSurface(real3(v3(0u)), 0.1, real3(v3(3u)), 0.1, \
               real3(0.5), real3(0.04), 1.0, real3(1.0)), real3(v3(3u)) * real(x[6]), false)",
        parameters: &[Direction, Direction, Values(&[-1.0, -0.9995, -1.001])],
        ..case("reflect_light")?
    };
    let results = mirror::results(&gpu, &case, &case.inputs(1024))?;
    assert!(results.iter().all(|y| y.is_finite() && *y >= 0.0));
    Ok(())
}
