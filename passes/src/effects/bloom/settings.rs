//! Settings of bloom. Defaults are Filament's.

use crate::settings::field::{Field, choice, number, text};
use crate::settings::place::{Place, Words, flag, num, switched, word};
use crate::settings::table::SettingsTable;

/// Source, extent and blending of bloom.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct BloomSettings {
    /// Strength of the glow, 0 to 1; 0 disables bloom.
    pub strength: f32,
    /// Height of the largest level in texels, 16 to 2048; the width follows the aspect ratio of the picture.
    pub height_texels: u32,
    /// Number of levels, each half as large as the one before, at most [`BloomSettings::MAX_LEVELS`] and limited by
    /// the size. More levels glow farther. 0 disables bloom.
    pub levels: u8,
    /// Reduction of pictures more than twice as high as the largest level.
    pub quality: BloomQuality,
    /// Blending of the glow with the picture.
    pub blend: Blend,
    /// Part of the picture that glows.
    pub threshold: Threshold,
    /// Threshold in pre-exposed radiance, 0 or more, for modes with a threshold.
    pub threshold_at: f32,
    /// Limit that bright glow approaches, in pre-exposed radiance above 0; infinite for none. For modes with a
    /// threshold.
    pub highlight: f32,
    /// Reduces the weight of single bright texels, for modes with a threshold. Ignored with temporal anti-aliasing,
    /// which does that already.
    pub fireflies: bool,
    /// Sums levels with a box of one texel instead of a tent of three, as Filament does on phones.
    pub narrow: bool,
    /// Strength of lens dirt, 0 or more, if [`Slot::LENS_DIRT`](crate::Slot::LENS_DIRT) holds a texture.
    pub dirt: f32,
    /// Lens flare; `None` for none.
    pub flare: Option<FlareSettings>,
    /// Extends the glow to an area whose sides are the picture's, rounded up to a multiple of this number of pixels.
    /// The picture is at its bottom left. 1 adds no area; Filament renders into multiples of 16.
    pub multiple_px: u32,
}

/// Reduction of pictures more than twice as high as the largest level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum BloomQuality {
    /// By halves. Sides of levels are multiples of 16, so the next four levels are exact halves.
    Low,
    /// By halves.
    Medium,
    /// None: the largest level is twice as large, and there is one more level.
    High,
}

/// Blending of the glow with the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Blend {
    /// Adds the glow; the picture gets brighter.
    Add,
    /// Interpolates between picture and glow.
    Interpolate,
}

/// Part of the picture that glows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Threshold {
    /// Everything.
    None,
    /// Radiance above the threshold, per channel, with less weight for single bright texels.
    Soft,
    /// Whole colors whose brightest channel reaches the threshold, with less weight for single bright texels.
    Hard,
}

/// Lens flare: ghosts and a halo.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct FlareSettings {
    /// Starburst: keeps only rays around the center, which turn with the camera.
    pub starburst: bool,
    /// Chromatic aberration: distance between red and blue as a fraction of the picture, 0 to 1.
    pub aberration: f32,
    /// Number of ghosts, 0 to 16.
    pub ghosts: u8,
    /// Distance between ghosts as a fraction of the way through the center, 0 to 1.
    pub ghost_spacing: f32,
    /// Glow above which ghosts appear, 0 or more.
    pub ghost_threshold: f32,
    /// Radius of the halo as a fraction of the height, 0 to 0.5.
    pub halo_radius: f32,
    /// Thickness of the halo as a fraction of the height, 0 to 1; 0 for no halo.
    pub halo_thickness: f32,
    /// Glow above which the halo appears, 0 or more.
    pub halo_threshold: f32,
    /// Centers ghosts, halo and rays in an area whose sides are the picture's, rounded up to a multiple of this number
    /// of pixels. The picture is at its bottom left. 1 centers them in the picture; Filament renders into multiples of
    /// 16.
    pub multiple_px: u32,
}

/// Transform from texture coordinates of the glow to those of the area that a flare is centered in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlareSpan {
    /// Scale.
    pub scale: [f32; 2],
    /// Offset, added after scaling.
    pub offset: [f32; 2],
}

impl FlareSpan {
    /// Returns the transform of `flare` for a picture of `size_px` whose glow covers multiples of `glow_multiple_px`.
    pub fn new(flare: &FlareSettings, size_px: [u32; 2], glow_multiple_px: u32) -> Self {
        let (glow, glow_begin) = BloomSettings::span(size_px, glow_multiple_px);
        let (span, begin) = BloomSettings::span(size_px, flare.multiple_px);
        Self { scale: [0, 1].map(|i| glow[i] / span[i]), offset: [0, 1].map(|i| (begin[i] - glow_begin[i]) / span[i]) }
    }
}

impl Default for BloomSettings {
    /// Returns [`BloomSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl BloomSettings {
    /// Maximum number of levels.
    pub const MAX_LEVELS: u8 = 12;

    /// Filament's defaults.
    pub const DEFAULT: Self = Self {
        strength: 0.1,
        height_texels: 384,
        levels: 6,
        quality: BloomQuality::Low,
        blend: Blend::Add,
        threshold: Threshold::Soft,
        threshold_at: 1.0,
        highlight: 1000.0,
        fireflies: true,
        narrow: false,
        dirt: 0.2,
        flare: None,
        multiple_px: 1,
    };

    /// Returns true if the settings have a visible effect.
    pub fn is_seen(&self) -> bool {
        self.strength > 0.0 && self.levels > 0
    }

    /// Returns the size that the glow of a picture covers, and the position of the picture in it, in pixels.
    pub(crate) fn span([width, height]: [u32; 2], multiple_px: u32) -> ([f32; 2], [f32; 2]) {
        let multiple = multiple_px.clamp(1, 1 << 16);
        let span = [width, height].map(|side| side.max(1).next_multiple_of(multiple) as f32);
        (span, [0.0, span[1] - height.max(1) as f32])
    }
}

impl Default for FlareSettings {
    /// Returns [`FlareSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl FlareSettings {
    /// Filament's defaults.
    pub const DEFAULT: Self = Self {
        starburst: true,
        aberration: 0.005,
        ghosts: 4,
        ghost_spacing: 0.6,
        ghost_threshold: 10.0,
        halo_radius: 0.4,
        halo_thickness: 0.1,
        halo_threshold: 10.0,
        multiple_px: 16,
    };

    /// Returns true if the settings have a visible effect.
    pub fn is_seen(&self) -> bool {
        self.ghosts > 0 || self.halo_thickness > 0.0
    }
}

impl Words for BloomQuality {
    const WORDS: &'static [(&'static str, Self)] =
        &[("low", Self::Low), ("medium", Self::Medium), ("high", Self::High)];
}

impl Words for Blend {
    const WORDS: &'static [(&'static str, Self)] = &[("add", Self::Add), ("interpolate", Self::Interpolate)];
}

impl Words for Threshold {
    const WORDS: &'static [(&'static str, Self)] = &[("off", Self::None), ("soft", Self::Soft), ("hard", Self::Hard)];
}

/// Range of thresholds, up to the brightest half float.
const GLOW: [f64; 2] = [0.0, 65504.0];
/// Range of multiples of pixels.
const MULTIPLE_PX: [f64; 2] = [1.0, 65536.0];

fn flare(s: &mut BloomSettings, place: fn(&mut FlareSettings) -> Place<'_>) -> Place<'_> {
    s.flare.as_mut().map_or(Place::Only("flare=on"), place)
}

impl SettingsTable for BloomSettings {
    const OPTION: &'static str = "bloom";
    const PATH: &'static str = "settings.bloom";
    const ABOUT: &'static str = "bloom and lens flare";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[("on", Self::DEFAULT)];
    const FIELDS: &'static [Field<Self>] = &[
        number("strength", "strength", [0.0, 1.0], |s: &mut Self| num(&mut s.strength)).about("strength of the glow"),
        number("height", "height_texels", [16.0, 2048.0], |s: &mut Self| num(&mut s.height_texels))
            .about("height of the largest level; the width follows the aspect ratio of the picture"),
        number("levels", "levels", [0.0, Self::MAX_LEVELS as f64], |s: &mut Self| num(&mut s.levels))
            .about("number of levels, each half as large as the one before; more levels glow farther"),
        choice("quality", "quality", |s: &mut Self| word(&mut s.quality))
            .about("reduction of pictures more than twice as high as the largest level"),
        choice("blend", "blend", |s: &mut Self| word(&mut s.blend)).about("blending of the glow with the picture"),
        choice("threshold", "threshold", |s: &mut Self| word(&mut s.threshold)).about("part of the picture that glows"),
        number("at", "threshold_at", GLOW, |s: &mut Self| num(&mut s.threshold_at))
            .about("threshold in pre-exposed radiance, for modes with a threshold"),
        number("highlight", "highlight", [1e-2, f64::INFINITY], |s: &mut Self| num(&mut s.highlight))
            .about("limit that bright glow approaches, in pre-exposed radiance, for modes with a threshold"),
        choice("fireflies", "fireflies", |s: &mut Self| flag(&mut s.fireflies))
            .about("reduces the weight of single bright texels, for modes with a threshold"),
        choice("kernel", "narrow", |s: &mut Self| Place::Switch(&mut s.narrow, ["wide", "narrow"]))
            .about("sums levels with a tent of three texels (`wide`), or with a box of one"),
        number("dirt", "dirt", [0.0, 1e3], |s: &mut Self| num(&mut s.dirt))
            .about("strength of lens dirt, if there is a texture"),
        number("multiple", "multiple_px", MULTIPLE_PX, |s: &mut Self| num(&mut s.multiple_px))
            .about("multiple to which the sides of the glowing area are rounded up"),
        text("flare", "flare", "`on` or `off`", &["off", "on"], |s: &mut Self, text| {
            s.flare = switched(text)?.then_some(FlareSettings::DEFAULT);
            Some(())
        })
        .about("lens flare: ghosts and a halo"),
        choice("starburst", "flare.starburst", |s: &mut Self| flare(s, |f| flag(&mut f.starburst)))
            .about("keeps only rays around the center, which turn with the camera"),
        number("aberration", "flare.aberration", [0.0, 1.0], |s: &mut Self| flare(s, |f| num(&mut f.aberration)))
            .about("distance between red and blue as a fraction of the picture"),
        number("ghosts", "flare.ghosts", [0.0, 16.0], |s: &mut Self| flare(s, |f| num(&mut f.ghosts)))
            .about("number of ghosts"),
        number("ghost-spacing", "flare.ghost_spacing", [0.0, 1.0], |s: &mut Self| {
            flare(s, |f| num(&mut f.ghost_spacing))
        })
        .about("distance between ghosts as a fraction of the way through the center"),
        number("ghost-at", "flare.ghost_threshold", GLOW, |s: &mut Self| flare(s, |f| num(&mut f.ghost_threshold)))
            .about("glow above which ghosts appear"),
        number("halo-radius", "flare.halo_radius", [0.0, 0.5], |s: &mut Self| flare(s, |f| num(&mut f.halo_radius)))
            .about("radius of the halo as a fraction of the height"),
        number("halo", "flare.halo_thickness", [0.0, 1.0], |s: &mut Self| flare(s, |f| num(&mut f.halo_thickness)))
            .about("thickness of the halo as a fraction of the height; 0 for no halo"),
        number("halo-at", "flare.halo_threshold", GLOW, |s: &mut Self| flare(s, |f| num(&mut f.halo_threshold)))
            .about("glow above which the halo appears"),
        number("flare-multiple", "flare.multiple_px", MULTIPLE_PX, |s: &mut Self| {
            flare(s, |f| num(&mut f.multiple_px))
        })
        .about("multiple to which the sides of the area are rounded up in which the flare is centered"),
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_describes_the_settings() {
        crate::settings::table::test::<BloomSettings>();
    }

    #[test]
    fn fields_are_set_by_name() {
        let own = "on:strength=0.5,threshold=hard,highlight=inf,flare=on,ghosts=2,halo-at=4";
        let flare = FlareSettings { ghosts: 2, halo_threshold: 4.0, ..FlareSettings::DEFAULT };
        let expected = BloomSettings {
            strength: 0.5,
            threshold: Threshold::Hard,
            highlight: f32::INFINITY,
            flare: Some(flare),
            ..BloomSettings::DEFAULT
        };
        assert_eq!(BloomSettings::from_text(own), Ok(Some(expected)));
        assert_eq!(BloomSettings::from_text("on:flare=on,flare=off"), Ok(Some(BloomSettings::DEFAULT)));
        for (text, named) in [
            ("glow", "glow: unknown choice; there are off, on"),
            ("on:levels=13", "levels=13: expected a whole number from 0 to 12"),
            ("on:highlight=0", "highlight=0: expected a number from 0.01 to inf"),
            ("on:ghosts=1", "ghosts: only `flare=on`"),
        ] {
            let error = BloomSettings::from_text(text).expect_err(text).to_string();
            assert!(error.contains(named) && !error.contains('\n'), "{text}: {error}");
        }
    }
}
