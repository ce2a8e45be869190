//! What a function of the library is asked beyond its domain, and what must come of it.

use super::probes;
use framegraph_shaders::reference::cases::{self, Bound, Case, Domain};

/// The builds that a probe is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// Both, where the function has both.
    Both,
    /// f32 alone.
    Full,
    /// f16 alone.
    Half,
}

/// Inputs from the ends of arithmetic, and what every result for them must be. That it is finite goes without saying, and is
/// told by its bits.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    /// Row of the table of hard inputs.
    pub row: u8,
    /// Function of the library.
    pub function: &'static str,
    /// Which builds.
    pub build: Build,
    /// A list for each number of the function's case; every combination is tried.
    pub parameters: &'static [Domain],
    /// Whether results for the inputs are sound.
    pub holds: fn(&[f32], &[f32]) -> bool,
    /// Whether they must be the mirror's too, where that is a number: within the bound of the function's case.
    pub mirrored: bool,
}

impl Probe {
    /// For a report.
    pub fn name(&self) -> String {
        format!("row {}: {}", self.row, self.function)
    }

    /// The function's case in one build, over the probe's inputs. Nothing if the probe is not for that build.
    pub fn case(&self, case: &Case) -> Option<Case> {
        let meant = match self.build {
            Build::Both => true,
            Build::Full => !case.in_half,
            Build::Half => case.in_half,
        };
        (meant && self.function == case.function).then_some(Case { parameters: self.parameters, ..*case })
    }
}

/// All probes.
pub fn all() -> impl Iterator<Item = &'static Probe> {
    probes::ALL.into_iter().flatten()
}

/// Every function of the library in every build that it has.
pub fn builds() -> Vec<Case> {
    cases::all().copied().chain(cases::half()).collect()
}

/// A bound of a function in one build at the ends of its domain.
#[derive(Clone, Copy, Debug)]
pub struct Wider {
    /// The function.
    pub function: &'static str,
    /// Its build.
    pub in_half: bool,
    /// How far it may be from the mirror there.
    pub bound: Bound,
}

const fn wider(function: &'static str, in_half: bool, absolute: f64, relative: f64) -> Wider {
    Wider { function, in_half, bound: Bound { absolute, relative, period: 0.0 } }
}

/// Functions that may be farther from their mirrors at the ends of their domains than between them.
pub const WIDER: &[Wider] = &[
    // Near the corner it is a root of one less a thirtieth power of a number near one: 1e-6, of which half is rounding.
    wider("edge_share", false, 1e-3, 1e-4),
];
