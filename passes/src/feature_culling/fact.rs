//! Decision about one effect: kept or dropped, its reason, and the bound on the change of the picture.

use super::effect::Effect;
use std::fmt;

/// Bound on the difference between the pictures with and without the effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Proof {
    /// Equal bit for bit.
    Exact,
    /// At most one 8-bit step: another shader variant computes the same, and compilers may contract its arithmetic
    /// differently.
    Variant,
    /// At most this number of 8-bit steps.
    Codes(f32),
    /// Shadow edges move by at most this number of pixels.
    Texels(f32),
    /// At most one 8-bit step, except at multisampled edges. Post-processing may be inlined then, and grades samples
    /// before they are averaged.
    Edges,
    /// At most the error of the effect itself: the picture without it is closer to the truth that the effect
    /// estimates.
    Truer,
    /// The bound of [`Proof::Edges`], unless a measured value more than doubled since it was measured. The effect then appears
    /// some frames late.
    Late,
}

impl Proof {
    /// Returns the class of the proof: `X`, `V` or `B`.
    pub const fn class(self) -> &'static str {
        match self {
            Self::Exact => "X",
            Self::Variant => "V",
            Self::Codes(_) | Self::Texels(_) | Self::Edges | Self::Truer | Self::Late => "B",
        }
    }

    /// Returns the bound as text; empty if the class states it.
    pub fn bound(self) -> String {
        match self {
            Self::Exact | Self::Variant => String::new(),
            Self::Codes(codes) => format!("{codes:.2} codes"),
            Self::Texels(texels) => format!("{texels} texels at edges"),
            Self::Edges => "a code; at edges samples are graded before they are averaged".into(),
            Self::Truer => "the effect's own error".into(),
            Self::Late => "a code, unless what was measured has more than doubled since".into(),
        }
    }
}

impl fmt::Display for Proof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.class())?;
        match self.bound() {
            bound if bound.is_empty() => Ok(()),
            bound => write!(f, "({bound})"),
        }
    }
}

/// Decision about an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// The effect stays.
    Kept,
    /// The effect is left out, or reduced.
    Dropped,
}

impl Decision {
    /// Returns the decision as a word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Dropped => "dropped",
        }
    }
}

/// Decision about one requested effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// The effect.
    pub effect: Effect,
    /// Decision.
    pub decision: Decision,
    /// Bound on the change of the picture if the effect is dropped; for kept effects, the bound a drop would have
    /// had.
    pub proof: Proof,
    /// Reason, with the compared numbers.
    pub reason: String,
}

impl Fact {
    /// Keeps the effect.
    pub(super) fn kept(effect: Effect, proof: Proof, reason: impl Into<String>) -> Self {
        Self { effect, decision: Decision::Kept, proof, reason: reason.into() }
    }

    /// Drops the effect if `unneeded`, for the first reason; keeps it otherwise, for the second.
    pub(super) fn decide(
        effect: Effect,
        proof: Proof,
        unneeded: bool,
        dropped: impl Into<String>,
        kept: impl Into<String>,
    ) -> Self {
        let (decision, reason) =
            if unneeded { (Decision::Dropped, dropped.into()) } else { (Decision::Kept, kept.into()) };
        Self { effect, decision, proof, reason }
    }
}
