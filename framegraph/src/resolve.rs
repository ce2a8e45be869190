//! Multisample resolves: which of a texel's samples, or what of them, the single-sample target gets.

use crate::format::{Format, Numeric};
use crate::words::words;

/// What a resolve makes of the samples of a texel (`VkResolveModeFlagBits`; Metal's multisample resolve filters).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
pub enum ResolveMode {
    /// Their mean: of colors that are no integers.
    #[default]
    Average,
    /// The first one, whatever the others hold: the same sample from frame to frame.
    Sample0,
    /// The smallest, of colors channel by channel; of reversed depth the farthest.
    Min,
    /// The largest, of colors channel by channel; of reversed depth the nearest.
    Max,
}

impl ResolveMode {
    /// Every mode.
    pub const ALL: [Self; 4] = [Self::Average, Self::Sample0, Self::Min, Self::Max];

    /// Whether texels of that format can be resolved so: depth has no average that any surface has, and integers are names
    /// more often than amounts.
    pub const fn fits(self, format: Format) -> bool {
        let float = matches!(format.numeric(), Numeric::Float);
        format.is_color_renderable() && (float || !matches!(self, Self::Average))
            || format.has_depth() && !matches!(self, Self::Average)
    }
}

words! { ResolveMode: Average "average", Sample0 "sample_0", Min "min", Max "max" }

/// A set of resolve modes; in a file the list of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "files", serde(from = "Vec<ResolveMode>", into = "Vec<ResolveMode>"))]
pub struct ResolveModes(u8);

impl ResolveModes {
    /// No mode.
    pub const NONE: Self = Self(0);

    /// The set of these modes.
    pub const fn of(modes: &[ResolveMode]) -> Self {
        let (mut set, mut at) = (0, 0);
        while at < modes.len() {
            set |= 1 << modes[at] as u8;
            at += 1;
        }
        Self(set)
    }

    /// Whether a mode is in the set.
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
