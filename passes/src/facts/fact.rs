//! One row of what was decided: an effect, why it is in the frame or not, and how far the picture may change for it.

use super::effect::Effect;
use std::fmt;

/// How far a picture without the effect may be from the one with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Proof {
    /// Not by a bit.
    Exact,
    /// Another variant of a shader computes the same: compilers may contract arithmetic otherwise, so by one code of 255 at
    /// most.
    Variant,
    /// By so many codes of 255 at most.
    Codes(f32),
    /// Edges of shadows by so many texels of the picture at most.
    Texels(f32),
    /// Not by more than a code but at edges of several samples: post-processing may then be inlined, which grades samples
    /// before they are averaged and not their average.
    Edges,
    /// By what the effect errs: the picture without it is nearer to the truth that it estimates.
    Truer,
    /// As an edge of several samples ([`Proof::Edges`]), as long as what was measured some frames ago is not more than twice as
    /// much by now: what comes suddenly has the effect some frames late.
    Late,
}

impl Proof {
    /// The class of the proof: `X`, `V` or `B`.
    pub const fn class(self) -> &'static str {
        match self {
            Self::Exact => "X",
            Self::Variant => "V",
            Self::Codes(_) | Self::Texels(_) | Self::Edges | Self::Truer | Self::Late => "B",
        }
    }

    /// The bound in words; empty where the class says it.
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

/// What becomes of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// It stays.
    Kept,
    /// It is left out, or less of it is made.
    Dropped,
}

impl Decision {
    /// In a word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Dropped => "dropped",
        }
    }
}

/// What was decided of one effect that the settings ask for.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// Which.
    pub effect: Effect,
    /// Whether it stays.
    pub decision: Decision,
    /// How far the picture may change where it is dropped; where it is kept, how far it would have.
    pub proof: Proof,
    /// Why, with the numbers that were compared.
    pub reason: String,
}

impl Fact {
    /// It stays.
    pub(super) fn kept(effect: Effect, proof: Proof, reason: impl Into<String>) -> Self {
        Self { effect, decision: Decision::Kept, proof, reason: reason.into() }
    }

    /// It goes if `unneeded`, for the first reason, and stays for the second.
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
