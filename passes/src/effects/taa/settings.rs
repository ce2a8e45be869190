//! Settings of temporal anti-aliasing, and option parsing. Defaults are Filament's.

use super::jitter::JitterPattern;
use crate::settings::key_value::{KeyValue, OptionError, switched};
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

    /// Names accepted by [`TaaSettings::set`].
    pub const KEYS: [&str; 13] = [
        "feedback",
        "width",
        "sharpness",
        "jitter",
        "box",
        "clip",
        "gamma",
        "filter-history",
        "filter-input",
        "ycocg",
        "steady",
        "reproject",
        "converge",
    ];

    /// Returns the offset of a frame to the right and up, in pixels.
    pub fn jitter_px(&self, frame: u32) -> DVec2 {
        self.jitter.at(frame)
    }

    /// Parses `off`, or `on` with changes such as `on:feedback=0.1,box=both`. Returns `None` for `off`.
    ///
    /// # Errors
    /// Fails for another word, an unknown name or an invalid value; the message names it and the accepted values.
    pub fn from_text(text: &str) -> Result<Option<Self>, OptionError> {
        switched(text, Self::DEFAULT, Self::set)
    }

    /// Changes one setting by name.
    ///
    /// # Errors
    /// Fails as [`TaaSettings::from_text`] does.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), OptionError> {
        let choice = KeyValue { key, value };
        match key {
            "feedback" => self.feedback = choice.number(0.0, 1.0)?,
            "width" => self.filter_width = choice.number(0.5, 4.0)?,
            "sharpness" => self.sharpness = choice.number(0.0, 1.0)?,
            "jitter" => {
                let found = JitterPattern::ALL.into_iter().find(|pattern| pattern.name() == value);
                self.jitter =
                    found.ok_or_else(|| choice.wrong("`rgss4`, `helix4`, `halton8`, `halton16` or `halton32`"))?;
            }
            "box" => {
                self.color_box = match value {
                    "bounds" => ColorBox::Bounds,
                    "variance" => ColorBox::Variance,
                    "both" => ColorBox::Both,
                    _ => return Err(choice.wrong("`bounds`, `variance` or `both`")),
                }
            }
            "clip" => {
                self.clipping = match value {
                    "accurate" => Clipping::Accurate,
                    "clamp" => Clipping::Clamp,
                    "none" => Clipping::None,
                    _ => return Err(choice.wrong("`accurate`, `clamp` or `none`")),
                }
            }
            "gamma" => self.variance_gamma = choice.number(0.0, 4.0)?,
            "filter-history" => self.filter_history = choice.switch()?,
            "filter-input" => self.filter_input = choice.switch()?,
            "ycocg" => self.ycocg = choice.switch()?,
            "steady" => self.prevent_flickering = choice.switch()?,
            "reproject" => self.reproject = choice.switch()?,
            "converge" => self.converge = choice.switch()?,
            _ => return Err(choice.unknown(&Self::KEYS)),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_made_by_name() -> Result<(), OptionError> {
        assert_eq!(TaaSettings::from_text("off")?, None);
        assert_eq!(TaaSettings::from_text("on")?, Some(TaaSettings::DEFAULT));
        let own = "on:feedback=0.1,width=2,sharpness=0.5,jitter=rgss4,box=both,clip=clamp,gamma=1.25,filter-history=off,\
                   filter-input=off,ycocg=on,steady=on,reproject=off,converge=on";
        let expected = TaaSettings {
            feedback: 0.1,
            filter_width: 2.0,
            sharpness: 0.5,
            jitter: JitterPattern::Rgss4,
            color_box: ColorBox::Both,
            clipping: Clipping::Clamp,
            variance_gamma: 1.25,
            filter_history: false,
            filter_input: false,
            ycocg: true,
            prevent_flickering: true,
            reproject: false,
            converge: true,
        };
        assert_eq!(TaaSettings::from_text(own)?, Some(expected));
        assert!(TaaSettings::KEYS.iter().all(|key| own.contains(&format!("{key}="))));
        Ok(())
    }

    #[test]
    fn wrong_words_are_named_in_one_line() {
        for (text, named) in [
            ("yes", "yes: "),
            ("on:gloss=1", "gloss"),
            ("on:feedback=2", "feedback=2"),
            ("on:feedback=NaN", "feedback=NaN"),
            ("on:width=0", "width=0"),
            ("on:jitter=white", "jitter=white"),
            ("on:box=round", "box=round"),
            ("on:clip=maybe", "clip=maybe"),
            ("on:ycocg", "ycocg="),
        ] {
            let told = TaaSettings::from_text(text).expect_err("that is no choice").to_string();
            assert!(told.contains(named) && !told.contains('\n'), "{text}: {told}");
        }
    }
}
