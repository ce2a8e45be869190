//! Evaluation on the device: one dispatch per function and build, for its probes and the ends of its domain.

use super::probe::{self, Probe, WIDER, Wider};
use crate::mirror;
use framegraph_shader_mirrors::cases::Case;
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::ops::Range;

/// Maximum number of combinations per probe.
pub const MOST: usize = 4096;

/// A violated invariant.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Name of the case: a row and a function, or a function at the ends of its domain.
    pub name: String,
    /// Inputs and results of the first violation.
    pub what: String,
}

/// All inputs for one build of a function.
#[derive(Debug)]
pub struct Questions {
    case: Case,
    probes: Vec<(&'static Probe, usize)>,
    inputs: Vec<f32>,
}

impl Questions {
    /// Collects the inputs for one build of a function.
    pub fn of(case: Case) -> Self {
        Self::where_all(case, |_| true)
    }

    /// Collects the inputs for one build of a function, without infinities and NaN.
    pub fn of_numbers(case: Case) -> Self {
        Self::where_all(case, is_finite)
    }

    fn where_all(case: Case, asked_for: fn(f32) -> bool) -> Self {
        let own = |inputs: Vec<f32>| -> Vec<f32> {
            let rows = inputs.chunks_exact(case.input_width()).filter(|row| row.iter().all(|x| asked_for(*x)));
            rows.flatten().copied().collect()
        };
        let mut inputs = Vec::new();
        let mut probes = Vec::new();
        for probe in probe::all() {
            if let Some(asked) = probe.case(&case) {
                assert_eq!(asked.input_width(), case.input_width(), "{}: a list a number", probe.name());
                let more = own(asked.hard_inputs(MOST));
                probes.push((probe, more.len()));
                inputs.extend(more);
            }
        }
        inputs.extend(own(case.hard_inputs(MOST)));
        Self { case, probes, inputs }
    }

    /// Returns the function with its build.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// Returns the number of input rows.
    pub fn rows(&self) -> usize {
        self.inputs.len() / self.case.input_width()
    }

    /// Evaluates the inputs with a replaced shader text, and returns violations.
    ///
    /// # Errors
    /// The device rejects the text or fails.
    pub fn failures(&self, gpu: &Gpu, wgsl: &str) -> Result<Vec<Failure>, Box<dyn Error>> {
        let results = mirror::results_of(gpu, &self.case, wgsl, &self.inputs)?;
        let (width, count) = (self.case.input_width(), self.case.results.len());
        let mut failures = Vec::new();
        let mut from = 0;
        for (probe, length) in &self.probes {
            let rows = self.inputs[from..from + length].chunks_exact(width);
            let got = results[from / width * count..(from + length) / width * count].chunks_exact(count);
            let broken = |(x, y): &(&[f32], &[f32])| !(y.iter().all(|y| is_finite(*y)) && (probe.holds)(x, y));
            if let Some((x, y)) = rows.zip(got).find(broken) {
                failures.push(Failure { name: probe.name(), what: format!("{x:?} gives {y:?}") });
            } else if probe.mirrored
                && let Err(what) = self.check_numbers(from..from + length, &results)
            {
                failures.push(Failure { name: probe.name(), what });
            }
            from += length;
        }
        let case = self.widened();
        if let Err(disagreement) = case.check(&self.inputs[from..], &results[from / width * count..]) {
            failures.push(Failure { name: format!("ends of {}", case.function), what: disagreement.to_string() });
        }
        Ok(failures)
    }

    /// Evaluates the inputs with the function's own text, and returns violations.
    ///
    /// # Errors
    /// The device rejects the text or fails.
    pub fn ask(&self, gpu: &Gpu) -> Result<Vec<Failure>, Box<dyn Error>> {
        self.failures(gpu, &self.case.shader()?.wgsl)
    }

    /// Compares results with the f64 mirror where that is finite. `place` is a range of the input rows.
    fn check_numbers(&self, place: Range<usize>, results: &[f32]) -> Result<(), String> {
        let (width, count, case) = (self.case.input_width(), self.case.results.len(), self.widened());
        let (mut inputs, mut outputs) = (Vec::new(), Vec::new());
        for row in place.start / width..place.end / width {
            let numbers = &self.inputs[row * width..(row + 1) * width];
            let expected = (case.mirror)(&numbers.iter().map(|x| f64::from(*x)).collect::<Vec<_>>());
            if numbers.iter().all(|x| !x.is_nan()) && expected.iter().all(|y| y.is_finite()) {
                inputs.extend(numbers);
                outputs.extend(&results[row * count..(row + 1) * count]);
            }
        }
        case.check(&inputs, &outputs).map(drop).map_err(|disagreement| disagreement.to_string())
    }

    fn widened(&self) -> Case {
        let own = |wider: &&Wider| wider.function == self.case.function && wider.in_half == self.case.in_half;
        WIDER.iter().find(own).map_or(self.case, |wider| Case { bound: wider.bound, ..self.case })
    }
}

/// Tests the bits, since compilers may evaluate comparisons with NaN arbitrarily.
fn is_finite(x: f32) -> bool {
    x.to_bits() & 0x7fff_ffff < 0x7f80_0000
}
