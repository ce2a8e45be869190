//! Inputs of a function beyond its domain, and the invariant of its results.

use super::probes;
use framegraph_shader_mirrors::cases::{self, Bound, Case, Domain};

/// Builds that a probe applies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// Both, if the function has both.
    Both,
    /// f32 only.
    Full,
    /// f16 only.
    Half,
}

/// Extreme inputs of a function, and an invariant of every result. Results must also be finite, which is tested by
/// their bits.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    /// Row of the table of hard inputs.
    pub row: u8,
    /// Function of the library.
    pub function: &'static str,
    /// Builds that the probe applies to.
    pub build: Build,
    /// Values of each parameter; every combination is tested.
    pub parameters: &'static [Domain],
    /// Returns true if the results for the inputs are valid.
    pub holds: fn(&[f32], &[f32]) -> bool,
    /// True if results must also match the mirror, where that is finite, within the bound of the function's case.
    pub mirrored: bool,
}

impl Probe {
    /// Returns the name for reports.
    pub fn name(&self) -> String {
        format!("row {}: {}", self.row, self.function)
    }

    /// Returns the function's case with the inputs of the probe; `None` if the probe does not apply to that build.
    pub fn case(&self, case: &Case) -> Option<Case> {
        let meant = match self.build {
            Build::Both => true,
            Build::Full => !case.in_half,
            Build::Half => case.in_half,
        };
        (meant && self.function == case.function).then_some(Case {
            parameters: self.parameters,
            call: case.expression().leak(),
            ..*case
        })
    }
}

/// Returns all probes.
pub fn all() -> impl Iterator<Item = &'static Probe> {
    probes::ALL.into_iter().flatten()
}

/// Returns every function of the library in each of its builds.
pub fn builds() -> Vec<Case> {
    cases::all().copied().chain(cases::half()).collect()
}

/// Error bound of one build of a function at the ends of its domain.
#[derive(Clone, Copy, Debug)]
pub struct Wider {
    /// Name of the function.
    pub function: &'static str,
    /// True for the f16 build.
    pub in_half: bool,
    /// Maximum distance from the mirror.
    pub bound: Bound,
}

const fn wider(function: &'static str, in_half: bool, absolute: f64, relative: f64) -> Wider {
    Wider { function, in_half, bound: Bound { absolute, relative, period: 0.0 } }
}

/// Functions with a larger error bound at the ends of their domains.
pub const WIDER: &[Wider] = &[
    // Near the corner, the function is the root of 1 minus the 30th power of a number near 1: 1e-6, half of which is
    // rounding.
    wider("edge_share", false, 1e-3, 1e-4),
];
