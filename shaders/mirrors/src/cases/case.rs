//! Test cases of functions, and their results.

/// Error tolerance of a GPU result: |gpu - mirror| ≤ absolute + relative·|mirror|.
///
/// Bounds follow from the accuracy WGSL promises (section 15.7.4): a few ulp for arithmetic,
/// 2⁻¹¹ absolute for sin and cos, 4096 ulp for the arc functions. A rounding to f16 is 2⁻¹¹ of
/// the value rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// Absolute tolerance in the unit of the result.
    pub absolute: f64,
    /// Relative tolerance, as a share of the mirror's value.
    pub relative: f64,
    /// Modulus for comparing periodic results such as angles; zero for none.
    pub period: f64,
}

/// Domain of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// One number, uniform between two limits.
    Linear(f64, f64),
    /// One number, uniform in its logarithm between two positive limits.
    Log(f64, f64),
    /// One integer, 0…n-1.
    Count(u32),
    /// One number from a list of hard values.
    Values(&'static [f64]),
    /// Three numbers, a unit vector.
    Direction,
    /// Six numbers: two unit vectors. The angle between them, in radians, is uniform in its logarithm.
    Directions(f64, f64),
    /// Several independent numbers, each uniform between two limits.
    Vector(usize, f64, f64),
}

/// Function of the library.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// File of `wgsl/lib/` and module of the mirror, without extension.
    pub file: &'static str,
    /// Name of the function in both.
    pub function: &'static str,
    /// Domains of its parameters; together they fill `x`.
    pub parameters: &'static [Domain],
    /// WGSL expression that calls the function with arguments such as `x[0]` and `v3(1u)`. Empty passes the parameters in
    /// order, as half floats if the function has a half-float build.
    pub call: &'static str,
    /// WGSL expressions of type f32 that extract values from the result `r`.
    pub results: &'static [&'static str],
    /// Mirror function with the same inputs and results.
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
    /// Domains of the parameters, rounded to half floats before use.
    pub parameters: &'static [Domain],
    /// Error tolerance against the mirror of the rounded inputs.
    pub bound: Bound,
}

/// Largest deviation of a case that passed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Largest |gpu - mirror|.
    pub absolute: f64,
    /// Largest share of the error bound in use, 0…1.
    pub of_bound: f64,
}

/// Point where shader and mirror disagree.
#[derive(Clone, PartialEq, thiserror::Error)]
#[error("{function}({inputs:?}) result {result}: shader {gpu}, mirror {mirror}, bound {bound:e}")]
pub struct Disagreement {
    /// Name of the function.
    pub function: &'static str,
    /// Inputs of the function.
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
