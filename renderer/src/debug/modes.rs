//! Debug modes. Each turns off one optimization of the compiler or executor, or makes reads of undefined contents
//! visible. A correct frame renders the same image in every mode.
//!
//! ```
//! use framegraph::Options;
//! use framegraph_wgpu::debug::{Mode, Modes};
//! use framegraph_wgpu::ExecutorOptions;
//!
//! let modes: Modes = "no-merge,poison".parse()?;
//! let (mut plan, mut execute) = (Options::for_frame(64, 64), ExecutorOptions::default());
//! modes.apply(&mut plan, &mut execute);
//! assert!(!plan.merge && execute.poison);
//! # Ok::<(), framegraph_wgpu::debug::ModesError>(())
//! ```

use crate::execute::executor::ExecutorOptions;
use framegraph::{Alias, Options};
use std::fmt;
use std::str::FromStr;

/// A debug mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Keeps passes whose results are never read or exported.
    NoCull,
    /// Executes every pass as its own step.
    NoMerge,
    /// Keeps point-wise passes separate instead of inlining them as epilogues.
    NoInline,
    /// Gives each resource its own texture or buffer.
    NoAlias,
    /// Executes the graph as declared: in declaration order, without culling, merging, inlining, memoryless attachments
    /// or aliasing.
    Immediate,
    /// Fills undefined contents with NaN or magenta.
    Poison,
}

impl Mode {
    /// All modes in the order of [`bisect`]: single optimizations, then all at once, then poison.
    pub const ALL: [Self; 6] =
        [Self::NoCull, Self::NoMerge, Self::NoInline, Self::NoAlias, Self::Immediate, Self::Poison];

    /// Returns the name for command lines and environment variables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NoCull => "no-cull",
            Self::NoMerge => "no-merge",
            Self::NoInline => "no-inline",
            Self::NoAlias => "no-alias",
            Self::Immediate => "immediate",
            Self::Poison => "poison",
        }
    }

    /// Returns the likely cause if only this mode changes the image.
    pub const fn likely_cause(self) -> &'static str {
        match self {
            Self::NoCull => "a culled pass has an effect that it does not declare",
            Self::NoMerge => "merged passes affect each other, or one samples its own attachment",
            Self::NoInline => {
                "an inlined epilogue differs from its separate pass; with multisampling this is expected, since the epilogue runs \
                 per sample"
            }
            Self::NoAlias => "a pass uses a texture or buffer outside of its declared lifetime",
            Self::Immediate => "a pass relies on an order that it does not declare",
            Self::Poison => {
                "a pass reads contents that no pass wrote, or does not write everything it declares to overwrite"
            }
        }
    }

    /// Applies the mode to compiler and executor options.
    pub fn apply(self, plan: &mut Options, execute: &mut ExecutorOptions) {
        match self {
            Self::NoCull => plan.cull = false,
            Self::NoMerge => plan.merge = false,
            Self::NoInline => plan.inline = false,
            Self::NoAlias => plan.alias = Alias::Off,
            Self::Immediate => *plan = plan.immediate(),
            Self::Poison => execute.poison = true,
        }
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A set of modes, parsed from comma-separated names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Modes(pub Vec<Mode>);

impl Modes {
    /// Applies all modes to compiler and executor options.
    pub fn apply(&self, plan: &mut Options, execute: &mut ExecutorOptions) {
        self.0.iter().for_each(|mode| mode.apply(plan, execute));
    }
}

/// Error: a name is not in [`Mode::ALL`].
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{word}` is not a debug mode; use one of {}", Mode::ALL.map(Mode::name).join(", "))]
pub struct ModesError {
    /// The name that was given.
    pub word: String,
}

impl fmt::Debug for ModesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for Modes {
    type Err = ModesError;

    fn from_str(text: &str) -> Result<Self, ModesError> {
        let mode = |word: &str| {
            Mode::ALL.into_iter().find(|m| m.name() == word).ok_or_else(|| ModesError { word: word.into() })
        };
        text.split(',').map(mode).collect::<Result<_, _>>().map(Self)
    }
}

/// Difference between an image and the reference image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Mode of this image. `None` for the second image without a mode, which shows whether rendering is deterministic.
    pub mode: Option<Mode>,
    /// Number of pixels with a difference in any channel.
    pub pixels: usize,
    /// Largest difference of a channel, in 8-bit steps (0…255).
    pub max_difference: u8,
}

impl Outcome {
    /// Returns whether the images are identical.
    pub const fn is_same(&self) -> bool {
        self.pixels == 0
    }

    /// Returns the name of the mode, or `again` for the second image without a mode.
    pub fn name(&self) -> &'static str {
        self.mode.map_or("again", Mode::name)
    }

    /// Returns the likely cause if this is the first image that differs.
    pub fn likely_cause(&self) -> &'static str {
        let again = "the image changes between runs: a pass reads undefined contents, or state outside of the frame";
        self.mode.map_or(again, Mode::likely_cause)
    }
}

/// Renders a reference image, the image again without a mode, and one image per mode, and compares each with the
/// reference. `render` returns 8-bit RGBA, four bytes per pixel.
///
/// # Errors
/// Returns the first error of `render`.
pub fn bisect<E>(mut render: impl FnMut(Option<Mode>) -> Result<Vec<u8>, E>) -> Result<Vec<Outcome>, E> {
    let expected = render(None)?;
    let rows = [None].into_iter().chain(Mode::ALL.map(Some));
    rows.map(|mode| render(mode).map(|found| compare(mode, &expected, &found))).collect()
}

fn compare(mode: Option<Mode>, expected: &[u8], found: &[u8]) -> Outcome {
    let mut outcome = Outcome { mode, pixels: 0, max_difference: 0 };
    for (a, b) in expected.chunks(4).zip(found.chunks(4)) {
        let worst = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
        outcome.pixels += usize::from(worst > 0);
        outcome.max_difference = outcome.max_difference.max(worst);
    }
    // Counts pixels that only one image has.
    let missing = expected.len().abs_diff(found.len()).div_ceil(4);
    let worst = if missing > 0 { u8::MAX } else { outcome.max_difference };
    Outcome { pixels: outcome.pixels + missing, max_difference: worst, mode }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::Order;

    #[test]
    fn each_mode_turns_off_what_it_names() {
        let base = Options { order: Order::Optimized, ..Options::for_frame(8, 8) };
        let set = |mode: Mode| {
            let (mut plan, mut execute) = (base, ExecutorOptions::default());
            mode.apply(&mut plan, &mut execute);
            (plan, execute.poison)
        };
        assert_eq!(set(Mode::NoCull), (Options { cull: false, ..base }, false));
        assert_eq!(set(Mode::NoMerge), (Options { merge: false, ..base }, false));
        assert_eq!(set(Mode::NoInline), (Options { inline: false, ..base }, false));
        assert_eq!(set(Mode::NoAlias), (Options { alias: Alias::Off, ..base }, false));
        assert_eq!(set(Mode::Immediate), (base.immediate(), false));
        assert_eq!(set(Mode::Poison), (base, true));
    }

    #[test]
    fn debug_modes_are_parsed() {
        let all = Mode::ALL.map(Mode::name).join(",");
        assert_eq!(all.parse(), Ok(Modes(Mode::ALL.to_vec())));
        for wrong in ["", "no-merge,", "fast", "No-Merge"] {
            let message = wrong.parse::<Modes>().map_err(|e| e.to_string());
            assert!(message.is_err_and(|e| e.contains("is not a debug mode; use one of no-cull,")), "{wrong}");
        }
    }

    #[test]
    fn differences_are_counted_in_pixels_and_steps() -> Result<(), ()> {
        let outcomes = bisect(|mode| {
            Ok(match mode {
                Some(Mode::NoMerge) => vec![1, 2, 3, 4, 5, 6, 7, 8],
                Some(Mode::Poison) => vec![1, 2, 3, 4, 9, 6, 7, 0],
                Some(Mode::NoAlias) => vec![1, 2, 3, 4],
                _ => vec![1, 2, 3, 4, 5, 6, 7, 8],
            })
        })?;
        let changed: Vec<_> =
            outcomes.iter().filter(|o| !o.is_same()).map(|o| (o.mode, o.pixels, o.max_difference)).collect();
        assert_eq!(changed, [(Some(Mode::NoAlias), 1, 255), (Some(Mode::Poison), 1, 8)]);
        assert_eq!((outcomes.len(), outcomes[0].name()), (Mode::ALL.len() + 1, "again"));
        Ok(())
    }
}
