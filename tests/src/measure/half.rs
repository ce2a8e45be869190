//! Error of the GGX distribution in half floats, against its value at the exact angle.

use crate::mirror;
use framegraph_shader_mirrors::cases::{self, Case};
use framegraph_shader_mirrors::ggx::d_ggx;
use framegraph_shader_mirrors::quantize::quantize_mantissa;
use framegraph_wgpu::Gpu;
use std::error::Error;
use truth::sphere::{directions, frame};

/// Formula for the sine of the half angle, and its precision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// 1 - noh² as in textbooks, in f32.
    Textbook,
    /// (1 - noh)(1 + noh), in f32: `d_ggx`.
    Product,
    /// |n × h|², in f32: `d_ggx_cross`.
    Cross,
    /// The textbook's formula in f16.
    HalfTextbook,
    /// `d_ggx_cross` in f16.
    HalfCross,
}

impl Form {
    /// All forms, in the order of tables.
    pub const ALL: [Self; 5] = [Self::Textbook, Self::Product, Self::Cross, Self::HalfTextbook, Self::HalfCross];

    /// Name for the head of a table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Textbook => "f32, 1 − noh²",
            Self::Product => "f32, (1 − noh)(1 + noh)",
            Self::Cross => "f32, \\|n × h\\|²",
            Self::HalfTextbook => "f16, 1 − noh²",
            Self::HalfCross => "f16, \\|n × h\\|²",
        }
    }

    const fn in_half(self) -> bool {
        matches!(self, Self::HalfTextbook | Self::HalfCross)
    }

    /// Returns the form as a test case of two vectors and alpha.
    fn case(self) -> Result<Case, &'static str> {
        let name = "d_ggx_cross";
        let known = if self.in_half() {
            cases::half().find(|c| c.function == name)
        } else {
            cases::all().find(|c| c.function == name).copied()
        };
        let known = known.ok_or("the library has no d_ggx_cross")?;
        Ok(match self {
            Self::Textbook | Self::HalfTextbook => textbook(known),
            Self::Product => Case { function: "d_ggx", call: "d_ggx(dot(v3(0u), v3(3u)), x[6])", ..known },
            Self::Cross | Self::HalfCross => known,
        })
    }
}

/// Returns a case of `d_ggx_cross` with the textbook's formula: k = alpha / (1 - noh² + noh²·alpha²) and D = k²/π. The
/// square is computed in f32, so that it does not overflow.
pub fn textbook(cross: Case) -> Case {
    const K: &str = "real(x[6]) / (1.0 - dot(real3(v3(0u)), real3(v3(3u))) * dot(real3(v3(0u)), real3(v3(3u))) + \
                     dot(real3(v3(0u)), real3(v3(3u))) * dot(real3(v3(0u)), real3(v3(3u))) * real(x[6]) * real(x[6]))";
    Case { call: K, results: &["f32(r) * f32(r) * 0.31830988"], ..cross }
}

/// Relative error over a lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeError {
    /// Median of the error.
    pub median: f64,
    /// Error that 1 % of the samples exceed.
    pub p99: f64,
}

impl LobeError {
    /// Compares values with exact ones; NaN counts as infinitely wrong.
    pub fn of(values: impl Iterator<Item = f64>, truth: impl Iterator<Item = f64>) -> Self {
        let apart = |(value, truth): (f64, f64)| (value / truth - 1.0).abs();
        let mut errors: Vec<f64> = values.zip(truth).map(apart).collect();
        errors.iter_mut().filter(|e| e.is_nan()).for_each(|e| *e = f64::INFINITY);
        errors.sort_by(f64::total_cmp);
        Self { median: errors[errors.len() / 2], p99: errors[errors.len() * 99 / 100] }
    }
}

/// Returns rows of (n, h, alpha), rounded to the precision in use, and D at the exact angle. Half angles are
/// log-uniform in [0.1·alpha, 8·alpha].
pub fn lobe(roughness: f64, samples: u32, in_half: bool) -> (Vec<f32>, Vec<f64>) {
    let alpha = roughness * roughness;
    let round = |x: f64| if in_half { quantize_mantissa(x, 10, false) as f32 } else { x as f32 };
    let (mut rows, mut truth) = (Vec::new(), Vec::new());
    for (i, n) in (0..).zip(directions(samples)) {
        // The lattice runs from pole to pole; a stride coprime to its size decorrelates poles and angles.
        let place = f64::from(i * 7919 % samples) + 0.5;
        let angle = (0.1 * alpha * 80.0_f64.powf(place / f64::from(samples))).min(1.5);
        let h = n * angle.cos() + frame(n).0 * angle.sin();
        rows.extend([n, h].into_iter().flat_map(|v| v.to_array()).chain([alpha]).map(round));
        truth.push(d_ggx(angle.cos(), alpha));
    }
    (rows, truth)
}

/// Measures the error of `form` on the device.
///
/// # Errors
/// The device fails, or does not support half floats in shaders.
pub fn lobe_error(gpu: &Gpu, form: Form, roughness: f64, samples: u32) -> Result<LobeError, Box<dyn Error>> {
    let (rows, truth) = lobe(roughness, samples, form.in_half());
    let got = mirror::results(gpu, &form.case()?, &rows)?;
    Ok(LobeError::of(got.into_iter().map(f64::from), truth.into_iter()))
}
