//! Colors by meaning, for a light and a dark theme.
//!
//! The hues are from Okabe and Ito ("Color Universal Design", 2008), which color-blind readers can distinguish. Meanings
//! never depend on hue alone: marks differ in shape, and boxes carry text.

/// Role of a color.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ink {
    /// Background.
    Background,
    /// Names and numbers.
    Text,
    /// Secondary text.
    Faint,
    /// Grid lines.
    Grid,
    /// Box of a step.
    Step,
    /// Raster pass.
    Raster,
    /// Compute pass.
    Compute,
    /// Copy pass.
    Copy,
    /// Culled passes.
    Ghost,
    /// Flows from pass to pass.
    Flow,
    /// Load from memory.
    Load,
    /// Store to memory.
    Store,
    /// MSAA resolve into a target.
    Resolve,
    /// Clear.
    Clear,
    /// Read by shaders.
    Fetch,
    /// Shared memory.
    Shared,
    /// Memoryless attachment.
    Memoryless,
    /// Resource that outlives the frame.
    Own,
    /// Step with the highest memory use.
    Peak,
    /// Selection.
    Selected,
    /// Worse than before.
    Worse,
    /// Better than before.
    Better,
}

/// Color theme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// Dark on light.
    #[default]
    Light,
    /// Light on dark.
    Dark,
}

impl Ink {
    /// Returns the sRGB-encoded color.
    pub const fn rgb(self, theme: Theme) -> [u8; 3] {
        let (light, dark) = match self {
            Self::Background => ([255, 255, 255], [24, 26, 30]),
            Self::Text => ([28, 30, 34], [228, 230, 234]),
            Self::Faint => ([96, 100, 108], [156, 160, 170]),
            Self::Grid => ([222, 225, 230], [52, 56, 64]),
            Self::Step => ([243, 245, 248], [36, 40, 47]),
            Self::Raster => ([198, 224, 245], [26, 74, 112]),
            Self::Compute => ([250, 222, 170], [122, 82, 8]),
            Self::Copy => ([214, 236, 226], [14, 92, 70]),
            Self::Ghost => ([140, 144, 152], [124, 128, 138]),
            Self::Flow => ([120, 126, 138], [130, 138, 152]),
            Self::Load => ([213, 94, 0], [240, 140, 60]),
            Self::Store => ([0, 114, 178], [86, 180, 233]),
            Self::Resolve => ([150, 80, 130], [222, 150, 196]),
            Self::Clear => ([0, 140, 104], [40, 190, 150]),
            Self::Fetch => ([176, 136, 0], [240, 210, 80]),
            Self::Shared => ([190, 218, 242], [34, 84, 124]),
            Self::Memoryless => ([196, 234, 218], [14, 88, 66]),
            Self::Own => ([236, 214, 228], [98, 50, 82]),
            Self::Peak => ([200, 60, 0], [255, 150, 80]),
            Self::Selected => ([200, 0, 110], [255, 110, 190]),
            Self::Worse => ([190, 70, 0], [245, 150, 70]),
            Self::Better => ([0, 100, 160], [96, 190, 240]),
        };
        match theme {
            Theme::Light => light,
            Theme::Dark => dark,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of WCAG 2.2.
    fn luminance(rgb: [u8; 3]) -> f64 {
        let linear = rgb.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        });
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    }

    #[test]
    fn words_stand_out_from_whatever_is_behind_them() {
        let behind =
            [Ink::Background, Ink::Step, Ink::Raster, Ink::Compute, Ink::Copy, Ink::Shared, Ink::Memoryless, Ink::Own];
        for theme in [Theme::Light, Theme::Dark] {
            for ink in behind {
                let (a, b) = (luminance(Ink::Text.rgb(theme)), luminance(ink.rgb(theme)));
                let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
                // Level AA of WCAG 2.2 for text (success criterion 1.4.3).
                assert!(contrast >= 4.5, "{ink:?} in {theme:?}: {contrast:.2}");
            }
        }
    }
}
