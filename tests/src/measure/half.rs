//! What half floats do to the GGX distribution, against its value at the true angle.

use crate::mirror;
use framegraph_shaders::reference::cases::{self, Case};
use framegraph_shaders::reference::ggx::d_ggx;
use framegraph_shaders::reference::quantize::quantize_mantissa;
use framegraph_wgpu::Gpu;
use std::error::Error;
use truth::sphere::{directions, frame};

/// How the sine of the half angle comes about, and in which numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// 1 - noh² as textbooks have it, in f32.
    Textbook,
    /// (1 - noh)(1 + noh), in f32: `d_ggx`.
    Product,
    /// |n × h|², in f32: `d_ggx_cross`.
    Cross,
    /// The textbook's in f16.
    HalfTextbook,
    /// `d_ggx_cross` in f16.
    HalfCross,
}

impl Form {
    /// All, in the order of tables.
    pub const ALL: [Self; 5] = [Self::Textbook, Self::Product, Self::Cross, Self::HalfTextbook, Self::HalfCross];

    /// For the head of a table.
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

    /// The form as a case of two vectors and alpha.
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

/// A case of `d_ggx_cross` with the textbook's form in its place: k = alpha / (1 - noh² + noh²·alpha²) and D = k²/π, squared
/// in f32 so that half floats are not blamed for overflowing there too.
pub fn textbook(cross: Case) -> Case {
    const K: &str = "real(x[6]) / (1.0 - dot(real3(v3(0u)), real3(v3(3u))) * dot(real3(v3(0u)), real3(v3(3u))) \
                     + dot(real3(v3(0u)), real3(v3(3u))) * dot(real3(v3(0u)), real3(v3(3u))) \
                     * real(x[6]) * real(x[6]))";
    Case { call: K, results: &["f32(r) * f32(r) * 0.31830988"], ..cross }
}

/// Relative error over a lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeError {
    /// Half of the samples err by more.
    pub median: f64,
    /// One sample in a hundred errs by more.
    pub p99: f64,
}

impl LobeError {
    /// Of values against the truth at the same place; what is no number counts as infinitely wrong.
    pub fn of(values: impl Iterator<Item = f64>, truth: impl Iterator<Item = f64>) -> Self {
        let apart = |(value, truth): (f64, f64)| (value / truth - 1.0).abs();
        let mut errors: Vec<f64> = values.zip(truth).map(apart).collect();
        errors.iter_mut().filter(|e| e.is_nan()).for_each(|e| *e = f64::INFINITY);
        errors.sort_by(f64::total_cmp);
        Self { median: errors[errors.len() / 2], p99: errors[errors.len() * 99 / 100] }
    }
}

/// Rows of (n, h, alpha) at half angles log-uniform in [0.1·alpha, 8·alpha], rounded to the numbers in use, and D at the
/// angle that was meant.
pub fn lobe(roughness: f64, samples: u32, in_half: bool) -> (Vec<f32>, Vec<f64>) {
    let alpha = roughness * roughness;
    let round = |x: f64| if in_half { quantize_mantissa(x, 10, false) as f32 } else { x as f32 };
    let (mut rows, mut truth) = (Vec::new(), Vec::new());
    for (i, n) in (0..).zip(directions(samples)) {
        // The lattice runs from pole to pole: a stride that shares no factor with it mixes poles and angles.
        let place = f64::from(i * 7919 % samples) + 0.5;
        let angle = (0.1 * alpha * 80.0_f64.powf(place / f64::from(samples))).min(1.5);
        let h = n * angle.cos() + frame(n).0 * angle.sin();
        rows.extend([n, h].into_iter().flat_map(|v| v.to_array()).chain([alpha]).map(round));
        truth.push(d_ggx(angle.cos(), alpha));
    }
    (rows, truth)
}

/// What `form` errs by on the device.
///
/// # Errors
/// When the device refuses or fails; half floats in shaders are among what it may refuse.
pub fn lobe_error(gpu: &Gpu, form: Form, roughness: f64, samples: u32) -> Result<LobeError, Box<dyn Error>> {
    let (rows, truth) = lobe(roughness, samples, form.in_half());
    let got = mirror::results(gpu, &form.case()?, &rows)?;
    Ok(LobeError::of(got.into_iter().map(f64::from), truth.into_iter()))
}
