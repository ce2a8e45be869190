//! Inputs that half floats do not survive unless a function sees to it: the design's hard cases, by their numbers there.

use super::{Case, Domain, TestResult, case, gpu, mirror};
use Domain::{Direction, Values, Vector};

/// What is left of a function where its domain ends.
struct Hard {
    function: &'static str,
    /// Everything that its parameters may wrongly be.
    parameters: &'static [Domain],
    /// Whether results for the inputs are sound; that they are finite goes without saying.
    holds: fn(&[f32], &[f32]) -> bool,
}

/// Cosines: none, less than none, numbers too small for all their bits, more than one (1, 2, 3, 6).
const COSINE: Domain = Values(&[0.0, -0.0, -0.1, 6e-8, 6.1e-5, 1e-4, 0.5, 0.9995, 1.0, 1.002]);
/// Cosines toward the viewer as callers clamp them.
const NOV: Domain = Values(&[1e-4, 0.01, 0.5, 1.0, 1.002]);
/// alpha: the floor, what lies below it, none (4).
const ALPHA: Domain = Values(&[0.007_921, 0.002_025, 4e-4, 0.0, 0.1, 1.0]);
/// Components of vectors that cancel, vanish or are too long (3, 7, 8).
const COMPONENT: Domain = Values(&[0.0, 1.0, -1.0, 0.001, -0.001, 0.6, -0.6, 1.002]);
/// Components that tilt a vector by next to nothing.
const TILT: Domain = Values(&[0.0, 6e-8, 6.1e-5, -1e-4, 0.001]);
const SHARE: Domain = Values(&[0.0, 6e-8, 0.04, 0.5, 1.0]);
/// Table entries of a broken table (13).
const ALBEDO: Domain = Values(&[0.0, -1.0, 6e-8, 0.3, 1.0, 161.0]);
/// The largest half float.
const MOST: f32 = 65504.0;

const HARD: &[Hard] = &[
    Hard {
        function: "v_smith_ggx_correlated",
        parameters: &[NOV, COSINE, ALPHA],
        holds: |_, y| (0.0..=MOST).contains(&y[0]),
    },
    Hard {
        function: "v_smith_ggx_correlated_fast",
        parameters: &[NOV, COSINE, ALPHA],
        holds: |_, y| (0.0..=MOST).contains(&y[0]),
    },
    Hard {
        function: "v_smith_ggx_correlated_anisotropic",
        parameters: &[ALPHA, ALPHA, COMPONENT, COMPONENT, COSINE, COMPONENT, COMPONENT, COSINE],
        holds: |_, y| (0.0..=MOST).contains(&y[0]),
    },
    Hard {
        function: "d_ggx_cross",
        parameters: &[COMPONENT, COMPONENT, COMPONENT, COMPONENT, COMPONENT, COMPONENT, ALPHA],
        holds: |_, y| (0.0..=MOST).contains(&y[0]),
    },
    Hard {
        function: "d_ggx_cross",
        parameters: &[Values(&[0.0]), Values(&[0.0]), Values(&[1.0]), TILT, TILT, Values(&[0.9995, 1.0, 1.002]), ALPHA],
        // The peak, but for a few roundings.
        holds: |x, y| {
            y[0] >= 0.0 && f64::from(y[0]) <= 1.01 / (std::f64::consts::PI * f64::from(x[6].max(0.0079)).powi(2))
        },
    },
    Hard {
        function: "d_ggx_anisotropic",
        parameters: &[Values(&[0.007_921, 0.1, 1.0]), Values(&[0.007_921, 0.1, 1.0]), COSINE, COSINE, COSINE],
        holds: |_, y| y[0] >= 0.0,
    },
    Hard {
        function: "anisotropic_alpha",
        parameters: &[ALPHA, Values(&[-1.5, -1.0, 0.0, 1.0, 1.5]), Values(&[0.007_921])],
        holds: |_, y| y.iter().all(|a| (0.0079..=1.0).contains(a)),
    },
    Hard { function: "v_kelemen", parameters: &[COSINE], holds: |_, y| (0.0..=MOST).contains(&y[0]) },
    Hard {
        function: "f_schlick",
        parameters: &[SHARE, SHARE, SHARE, Values(&[1.0]), COSINE],
        // One rounding of a sum.
        holds: |x, y| y.iter().zip(x).all(|(f, f0)| (*f0 - 5e-4..=1.0).contains(f)),
    },
    Hard {
        function: "d_charlie",
        parameters: &[COSINE, ALPHA],
        // (2 + 1/alpha) / 2π at the smallest alpha, 4e-4.
        holds: |_, y| (0.0..=400.0).contains(&y[0]),
    },
    Hard { function: "v_neubelt", parameters: &[COSINE, COSINE], holds: |_, y| (0.0..=MOST).contains(&y[0]) },
    Hard {
        function: "energy_compensation",
        parameters: &[SHARE, SHARE, SHARE, ALBEDO],
        // 1/0.3 - 1, and a rounding.
        holds: |x, y| y.iter().zip(x).all(|(c, f0)| (1.0..=1.001 + 2.34 * f0).contains(c)),
    },
    Hard {
        function: "f0_under_clear_coat",
        parameters: &[SHARE, SHARE, SHARE],
        holds: |_, y| y.iter().all(|f| *f <= 1.0),
    },
    Hard { function: "clamp_nov", parameters: &[COSINE], holds: |_, y| y[0] >= 1e-4 },
];

fn evaluate(gpu: &framegraph_wgpu::Gpu, hard: &Hard, failures: &mut Vec<String>) -> TestResult {
    let case = Case { parameters: hard.parameters, ..case(hard.function)? };
    // A quarter are combinations in turn, the others random ones.
    let inputs = case.inputs(4096);
    let results = mirror::results(gpu, &case, &inputs)?;
    let rows = inputs.chunks_exact(case.input_width()).zip(results.chunks_exact(case.results.len()));
    let broken = rows.filter(|(x, y)| !(y.iter().all(|y| y.is_finite()) && (hard.holds)(x, y)));
    failures.extend(broken.take(1).map(|(x, y)| format!("{}({x:?}) = {y:?}", hard.function)));
    Ok(())
}

#[test]
fn nothing_breaks_the_functions_of_the_half_build() -> TestResult {
    let Some(gpu) = gpu("nothing_breaks_the_functions_of_the_half_build") else { return Ok(()) };
    let mut failures = Vec::new();
    for hard in HARD {
        evaluate(&gpu, hard, &mut failures)?;
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    // The check sees what it looks for: the quotient without its floor is infinite where both cosines vanish.
    let naive = Hard { function: "v_neubelt", parameters: &[COSINE, COSINE], holds: |_, _| true };
    let case = Case { call: "0.25 / (real(x[0]) + real(x[1]))", ..case(naive.function)? };
    let inputs = Case { parameters: naive.parameters, ..case }.inputs(4096);
    assert!(mirror::results(&gpu, &case, &inputs)?.iter().any(|y| !y.is_finite()), "1/0 is no number");
    Ok(())
}

/// Lights behind the surface, opposite to the viewer, on the horizon; normals of no length (2, 7, 8).
#[test]
fn reflected_light_is_finite_and_none_comes_from_behind() -> TestResult {
    let Some(gpu) = gpu("reflected_light_is_finite_and_none_comes_from_behind") else { return Ok(()) };
    const V: [Domain; 3] = [COMPONENT; 3];
    const COLOR: Domain = Vector(3, 0.0, 1.0);
    const ALL: &[Domain] = &[
        V[0],
        V[1],
        V[2],
        V[0],
        V[1],
        V[2],
        V[0],
        V[1],
        V[2],
        ALPHA,
        COLOR,
        COLOR,
        SHARE,
        Vector(3, 1.0, 3.26),
        Values(&[0.0, 1.0]),
    ];
    let case = Case { parameters: ALL, ..case("reflect_light")? };
    let inputs = case.inputs(16384);
    let results = mirror::results(&gpu, &case, &inputs)?;
    let mut behind = 0;
    for (x, y) in inputs.chunks_exact(case.input_width()).zip(results.chunks_exact(3)) {
        assert!(y.iter().all(|y| y.is_finite() && *y >= 0.0), "{x:?}: {y:?}");
        let nol = x[0] * x[6] + x[1] * x[7] + x[2] * x[8];
        // Three products round by less than this.
        if nol < -0.01 {
            behind += 1;
            assert!(y.iter().all(|y| y.to_bits() == 0), "{x:?}: {y:?}");
        }
    }
    assert!(behind > 1000, "only {behind} lights were behind");
    Ok(())
}

/// D · V is more than a half float holds, at angles that occur: each is a half float and their product is not (4, 19).
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

/// Colors that no half float holds become the largest that one holds, at the border where they come in.
#[test]
fn colors_beyond_half_floats_are_held() -> TestResult {
    let Some(gpu) = gpu("colors_beyond_half_floats_are_held") else { return Ok(()) };
    let inputs = [65504.0, 65536.0, 1e30, -1e30, f32::MAX, 0.5];
    let results = mirror::results(&gpu, &case("to_real3")?, &inputs)?;
    assert_eq!(results, [MOST, MOST, MOST, -MOST, MOST, 0.5]);
    Ok(())
}

/// A light that is exactly opposite to the viewer leaves no half vector.
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
