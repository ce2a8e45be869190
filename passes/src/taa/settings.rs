//! What temporal anti-aliasing is made of, and the same by name. Defaults are Filament's.

use super::jitter::JitterPattern;
use crate::choice::{Choice, ChoiceError, switched};
use glam::DVec2;

/// How frames are added up.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct TaaSettings {
    /// Share of each new frame in the sum, 0 to 1: 1 is no sum.
    pub feedback: f32,
    /// Width of the filter of a frame's own samples, 0.5 to 4; 1 is sharper, 2 smoother.
    pub filter_width: f32,
    /// How much is sharpened afterwards, 0 to 1; 0 is not at all.
    pub sharpness: f32,
    /// Through which places of its pixels each frame is seen.
    pub jitter: JitterPattern,
    /// The box that the sum is held to.
    pub color_box: ColorBox,
    /// How it is held to it.
    pub clipping: Clipping,
    /// Deviations that a box by variance is wide to either side, 0 to 4: more leaves ghosts, less lets edges tremble.
    pub variance_gamma: f32,
    /// The sum is read by a spline, which keeps it sharp where it moves.
    pub filter_history: bool,
    /// A frame's samples are filtered to the middles of pixels.
    pub filter_input: bool,
    /// The box is one of luma and chroma, which is tighter.
    pub ycocg: bool,
    /// The share of a frame is less where brightness changes.
    pub prevent_flickering: bool,
    /// The sum is read where a pixel was, else at the same pixel.
    pub reproject: bool,
    /// While a view stands still in a scene that does ([`Views::again`](crate::view::Views::again)), the sum is the mean of the
    /// light of all its frames, and is held to nothing; not so in Filament, whose sum never comes to rest.
    pub converge: bool,
}

/// What the box about a pixel's colors is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum ColorBox {
    /// The least and the most of each channel, with corners counted half.
    #[default]
    Bounds,
    /// Mean and deviation.
    Variance,
    /// What both have in common.
    Both,
}

/// How the sum is held to the box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Clipping {
    /// On the way to this frame's color, where that enters the box.
    #[default]
    Accurate,
    /// Each channel for itself.
    Clamp,
    /// Not at all: what moves leaves ghosts, and what stands still comes nearest to the truth.
    None,
}

impl Default for TaaSettings {
    /// [`TaaSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl TaaSettings {
    /// Filament's.
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

    /// The names that [`TaaSettings::set`] takes.
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

    /// By how much a frame moves its picture to the right and up, in pixels.
    pub fn jitter_px(&self, frame: u32) -> DVec2 {
        self.jitter.at(frame)
    }

    /// What is asked for as `off`, or as `on` with changes: `on:feedback=0.1,box=both`. None is `off`.
    ///
    /// # Errors
    /// When it is neither, or a choice is unknown or does not take the value: one line that names it and what it takes.
    pub fn from_text(text: &str) -> Result<Option<Self>, ChoiceError> {
        switched(text, Self::DEFAULT, Self::set)
    }

    /// Changes one choice by name.
    ///
    /// # Errors
    /// As [`TaaSettings::from_text`].
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), ChoiceError> {
        let choice = Choice { key, value };
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
    fn choices_are_made_by_name() -> Result<(), ChoiceError> {
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
