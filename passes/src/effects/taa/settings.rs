//! Settings of temporal anti-aliasing, and their table. Defaults are Filament's.

use super::jitter::JitterPattern;
use crate::settings::field::{Field, choice, number};
use crate::settings::place::{Words, flag, num, word};
use crate::settings::table::SettingsTable;
use glam::DVec2;

/// Settings of temporal anti-aliasing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct TaaSettings {
    /// Weight of each new frame in the history, 0 to 1; 1 disables the history.
    pub feedback: f32,
    /// Width of the filter over a frame's own samples, 0.5 to 4; 1 is sharper, 2 smoother.
    pub filter_width: f32,
    /// Strength of sharpening after accumulation, 0 to 1; 0 is off.
    pub sharpness: f32,
    /// Sequence of sub-pixel offsets.
    pub jitter: JitterPattern,
    /// Color box to which the history is clamped.
    pub color_box: ColorBox,
    /// Clamping method.
    pub clipping: Clipping,
    /// Half width of the variance box, in standard deviations, 0 to 4. More leaves ghosts; less lets edges tremble.
    pub variance_gamma: f32,
    /// Reads the history with a Catmull-Rom spline, which keeps moving detail sharp.
    pub filter_history: bool,
    /// Filters a frame's samples to pixel centers.
    pub filter_input: bool,
    /// Uses a box in luma and chroma, which is tighter.
    pub ycocg: bool,
    /// Reduces the weight of a frame where brightness changes.
    pub prevent_flickering: bool,
    /// Reads the history at the pixel's previous position; otherwise at the same pixel.
    pub reproject: bool,
    /// While view and scene are still ([`Views::again`](crate::gpu_scene::view::Views::again)), accumulates the mean of
    /// all frames without clamping. Filament's history never settles.
    pub converge: bool,
}

/// Definition of the color box around a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum ColorBox {
    /// Minimum and maximum of each channel, with half weight for corners.
    #[default]
    Bounds,
    /// Mean and standard deviation.
    Variance,
    /// Intersection of both.
    Both,
}

/// Clamping of the history to the color box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Clipping {
    /// Clips along the line to this frame's color.
    #[default]
    Accurate,
    /// Clamps each channel.
    Clamp,
    /// No clamping: moving objects leave ghosts, and still pictures come closest to the truth.
    None,
}

impl Default for TaaSettings {
    /// Returns [`TaaSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl TaaSettings {
    /// Filament's defaults.
    pub const DEFAULT: Self = Self {
        feedback: 0.12,
        filter_width: 1.0,
        sharpness: 0.0,
        jitter: JitterPattern::Halton16,
        color_box: ColorBox::Bounds,
        clipping: Clipping::Accurate,
        variance_gamma: 1.0,
        filter_history: true,
        filter_input: true,
        ycocg: false,
        prevent_flickering: false,
        reproject: true,
        converge: false,
    };

    /// Returns the offset of a frame to the right and up, in pixels.
    pub fn jitter_px(&self, frame: u32) -> DVec2 {
        self.jitter.at(frame)
    }
}

impl Words for ColorBox {
    const WORDS: &'static [(&'static str, Self)] =
        &[("bounds", Self::Bounds), ("variance", Self::Variance), ("both", Self::Both)];
}

impl Words for Clipping {
    const WORDS: &'static [(&'static str, Self)] =
        &[("accurate", Self::Accurate), ("clamp", Self::Clamp), ("none", Self::None)];
}

impl SettingsTable for TaaSettings {
    const OPTION: &'static str = "taa";
    const PATH: &'static str = "settings.taa";
    const ABOUT: &'static str = "temporal anti-aliasing";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[("on", Self::DEFAULT)];
    const FIELDS: &'static [Field<Self>] = &[
        number("feedback", "feedback", [0.0, 1.0], |s: &mut Self| num(&mut s.feedback))
            .about("weight of each new frame"),
        number("width", "filter_width", [0.5, 4.0], |s: &mut Self| num(&mut s.filter_width))
            .about("width of the filter over a frame's own samples; 1 is sharper, 2 smoother"),
        number("sharpness", "sharpness", [0.0, 1.0], |s: &mut Self| num(&mut s.sharpness))
            .about("sharpening after accumulation"),
        choice("jitter", "jitter", |s: &mut Self| word(&mut s.jitter)).about("sequence of sub-pixel offsets"),
        choice("box", "color_box", |s: &mut Self| word(&mut s.color_box))
            .about("color box to which the history is clamped"),
        choice("clip", "clipping", |s: &mut Self| word(&mut s.clipping)).about("clamping method; `none` leaves ghosts"),
        number("gamma", "variance_gamma", [0.0, 4.0], |s: &mut Self| num(&mut s.variance_gamma))
            .about("half width of the variance box, in standard deviations"),
        choice("filter-history", "filter_history", |s: &mut Self| flag(&mut s.filter_history))
            .about("reads the history with a Catmull-Rom spline, which keeps moving detail sharp"),
        choice("filter-input", "filter_input", |s: &mut Self| flag(&mut s.filter_input))
            .about("filters a frame's samples to pixel centers"),
        choice("ycocg", "ycocg", |s: &mut Self| flag(&mut s.ycocg))
            .about("uses a box in luma and chroma, which is tighter"),
        choice("steady", "prevent_flickering", |s: &mut Self| flag(&mut s.prevent_flickering))
            .about("reduces the weight of a frame where brightness changes"),
        choice("reproject", "reproject", |s: &mut Self| flag(&mut s.reproject))
            .about("reads the history at the pixel's previous position"),
        choice("converge", "converge", |s: &mut Self| flag(&mut s.converge))
            .about("averages all frames while nothing moves"),
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_describes_the_settings() {
        crate::settings::table::test::<TaaSettings>();
        let expected = TaaSettings { jitter: JitterPattern::Rgss4, clipping: Clipping::None, ..TaaSettings::DEFAULT };
        assert_eq!(TaaSettings::from_text("on:jitter=rgss4,clip=none"), Ok(Some(expected)));
        let error = TaaSettings::from_text("on:jitter=white").expect_err("no sequence").to_string();
        assert_eq!(error, "jitter=white: expected `rgss4`, `helix4`, `halton8`, `halton16` or `halton32`");
    }
}
