//! Modes of multisample resolves.

use crate::enum_names::enum_names;
use crate::format::{Format, Numeric};

/// Operation that combines the samples of a texel (`VkResolveModeFlagBits`; Metal's multisample resolve filters).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
pub enum ResolveMode {
    /// The mean of the samples; for color formats that are not integer.
    #[default]
    Average,
    /// Sample 0, ignoring the others.
    Sample0,
    /// The minimum, per channel for colors. With reversed depth this is the farthest sample.
    Min,
    /// The maximum, per channel for colors. With reversed depth this is the nearest sample.
    Max,
}

impl ResolveMode {
    /// Every mode.
    pub const ALL: [Self; 4] = [Self::Average, Self::Sample0, Self::Min, Self::Max];

    /// Returns `true` if the mode is defined for this format. Depth and integer formats cannot be averaged.
    pub const fn fits(self, format: Format) -> bool {
        let float = matches!(format.numeric(), Numeric::Float);
        format.is_color_renderable() && (float || !matches!(self, Self::Average))
            || format.has_depth() && !matches!(self, Self::Average)
    }
}

enum_names! { ResolveMode: Average "average", Sample0 "sample_0", Min "min", Max "max" }

/// A set of resolve modes. Serialized as a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "files", serde(from = "Vec<ResolveMode>", into = "Vec<ResolveMode>"))]
pub struct ResolveModes(u8);

impl ResolveModes {
    /// The empty set.
    pub const NONE: Self = Self(0);

    /// Returns the set of the given modes.
    pub const fn of(modes: &[ResolveMode]) -> Self {
        let (mut set, mut at) = (0, 0);
        while at < modes.len() {
            set |= 1 << modes[at] as u8;
            at += 1;
        }
        Self(set)
    }

    /// Returns `true` if the set contains a mode.
    pub const fn has(self, mode: ResolveMode) -> bool {
        self.0 & 1 << mode as u8 != 0
    }
}

impl From<Vec<ResolveMode>> for ResolveModes {
    fn from(modes: Vec<ResolveMode>) -> Self {
        Self::of(&modes)
    }
}

impl From<ResolveModes> for Vec<ResolveMode> {
    fn from(set: ResolveModes) -> Self {
        ResolveMode::ALL.into_iter().filter(|mode| set.has(*mode)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_and_integers_have_no_average() {
        for format in Format::ALL {
            let attached = format.is_color_renderable() || format.has_depth();
            assert_eq!(ResolveMode::Average.fits(format), format.is_resolvable(), "{format:?}");
            for mode in [ResolveMode::Sample0, ResolveMode::Min, ResolveMode::Max] {
                assert_eq!(mode.fits(format), attached, "{format:?} {mode:?}");
            }
        }
        let set = ResolveModes::of(&[ResolveMode::Min, ResolveMode::Average]);
        assert_eq!(Vec::from(set), [ResolveMode::Average, ResolveMode::Min]);
        assert_eq!(ResolveModes::from(Vec::from(set)), set);
    }
}
