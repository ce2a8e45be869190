//! Test cases of functions, and their results.

/// Error tolerance of a GPU result: |gpu - mirror| ≤ absolute + relative·|mirror|.
///
/// Bounds follow from the accuracy WGSL promises (section 15.7.4): a few ulp for arithmetic,
/// 2⁻¹¹ absolute for sin and cos, 4096 ulp for the arc functions. A rounding to f16 is 2⁻¹¹ of
/// the value rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// In the unit of the result.
    pub absolute: f64,
    /// As a share of the mirror's value.
    pub relative: f64,
    /// Results are compared modulo this, as for an angle; zero for not.
    pub period: f64,
}

/// Domain of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// One number, uniform between the two.
    Linear(f64, f64),
    /// One number, uniform in its logarithm; both ends positive.
    Log(f64, f64),
    /// One whole number, 0…n-1.
    Count(u32),
    /// One number out of a list: hard cases.
    Values(&'static [f64]),
    /// Three numbers, a unit vector.
    Direction,
    /// Six numbers, two unit vectors; the angle between them, in radians, is uniform in its
    /// logarithm.
    Directions(f64, f64),
    /// Numbers that are alike, each uniform between the two.
    Vector(usize, f64, f64),
}

/// A function of the library.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// File of `wgsl/lib/` and module of the mirror, without ending.
    pub file: &'static str,
    /// Name in both.
    pub function: &'static str,
    /// Domains of its parameters; together they fill `x`.
    pub parameters: &'static [Domain],
    /// WGSL expression that calls it with arguments made of `x[0]`, `v3(1u)`, …
    pub call: &'static str,
    /// WGSL expressions of type f32 that take the result `r` apart.
    pub results: &'static [&'static str],
    /// The mirror, of the same numbers and with the same results.
    pub mirror: fn(&[f64]) -> Vec<f64>,
    /// Error tolerance.
    pub bound: Bound,
    /// True for the build in half floats.
    pub in_half: bool,
    /// Differences of the half-float build; `None` if there are none.
    pub half: Option<HalfCase>,
}

/// Differences of a function in the half-float build.
#[derive(Clone, Copy, Debug)]
pub struct HalfCase {
    /// Domains of its parameters, rounded to half floats before they are used.
    pub parameters: &'static [Domain],
    /// Error tolerance against the mirror of the rounded inputs.
    pub bound: Bound,
}

/// The largest deviation of a case that passed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Largest |gpu - mirror|.
    pub absolute: f64,
    /// Largest share of the bound that was used, 0…1.
    pub of_bound: f64,
}

/// A point where shader and mirror disagree.
#[derive(Clone, PartialEq, thiserror::Error)]
#[error("{function}({inputs:?}) result {result}: shader {gpu}, mirror {mirror}, bound {bound:e}")]
pub struct Disagreement {
    /// Name of the function.
    pub function: &'static str,
    /// Its numbers.
    pub inputs: Vec<f32>,
    /// Index into [`Case::results`].
    pub result: usize,
    /// Result of the GPU.
    pub gpu: f32,
    /// Expected result.
    pub mirror: f64,
    /// Error tolerance.
    pub bound: f64,
}

impl std::fmt::Debug for Disagreement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
