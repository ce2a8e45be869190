//! The whole frame as data: settings with what goes beside them, and presets.
//!
//! | | low | medium | high | ultra |
//! | --- | --- | --- | --- | --- |
//! | shading and light ([`Quality`]) | low | high | high | ultra |
//! | samples a texel | 1 | 1 | 4 | 4 |
//! | edges | FXAA | FXAA | FXAA, which facts leave out after samples | the same |
//! | the sun's maps | 1 of 1024² texels, PCF | 1 of 2048², PCF | 3 of 2048², PCF | 4 of 2048², PCSS, contact |
//! | maps of lamps | 0 | 6 | 12 | 24 |
//! | ambient occlusion | none | SAO at half the size | SAO | GTAO |
//! | reflections of the picture | none | none | none | yes |
//! | glass through glass | 1 layer | 1 | 1 | 3 |
//! | radiance | `Rg11b10Ufloat` | `Rgba16Float` | `Rgba16Float` | `Rgba16Float` |

use crate::frame::Settings;
use crate::occlusion::{OcclusionSettings, SaoQuality};
use crate::punctual::{FroxelSettings, LightSearch};
use crate::reflection::ReflectionSettings;
use crate::shading::Quality;
use crate::shadow::{ContactShadows, ShadowFilter, ShadowSettings, Splits};
use crate::structure::Resolution;
use framegraph::Format;

/// A frame without its scene and camera.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct FrameSettings {
    /// How fine light from all around is made; `settings.shading` says how it is used.
    pub quality: Quality,
    /// How shading finds the lights that reach a place.
    pub lights: LightSearch,
    /// Post-processing goes into the color pass's shader where that is sound.
    pub inline: bool,
    /// The frame.
    pub settings: Settings,
}

impl Default for FrameSettings {
    /// [`FrameSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl FrameSettings {
    /// The default settings, in high quality.
    pub const DEFAULT: Self = Self {
        quality: Quality::High,
        lights: LightSearch::Auto(FroxelSettings::DEFAULT),
        inline: true,
        settings: Settings::DEFAULT,
    };
}

/// Frames that go from the cheapest to the finest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Preset {
    /// For phones.
    Low,
    /// One sample, and ambient occlusion at half the size.
    Medium,
    /// Four samples, three cascades, ambient occlusion.
    High,
    /// Everything, for still pictures.
    Ultra,
}

impl Preset {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Low, Self::Medium, Self::High, Self::Ultra];

    /// As it is asked for.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
            Self::Ultra => "ultra",
        }
    }

    /// The preset of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }

    /// What it chooses.
    pub const fn frame(self) -> FrameSettings {
        let quality = match self {
            Self::Low => Quality::Low,
            Self::Medium | Self::High => Quality::High,
            Self::Ultra => Quality::Ultra,
        };
        let (map_texels, cascades, local_maps) = match self {
            Self::Low => (1024, 1, 0),
            Self::Medium => (2048, 1, 6),
            Self::High => (2048, 3, 12),
            Self::Ultra => (2048, 4, 24),
        };
        let ultra = matches!(self, Self::Ultra);
        let shadows = ShadowSettings {
            map_texels,
            cascades,
            local_maps,
            splits: if cascades > 1 { Splits::Practical(0.8) } else { ShadowSettings::DEFAULT.splits },
            filter: if ultra { ShadowFilter::Pcss } else { ShadowFilter::Pcf },
            contact: if ultra { Some(ContactShadows::FILAMENT) } else { None },
            ..ShadowSettings::DEFAULT
        };
        let occlusion = match self {
            Self::Low => None,
            Self::Medium => Some(OcclusionSettings { resolution: Resolution::Half, ..OcclusionSettings::SAO }),
            Self::High => Some(OcclusionSettings::sao(SaoQuality::High)),
            Self::Ultra => Some(OcclusionSettings::GTAO),
        };
        let settings = Settings {
            samples: if matches!(self, Self::High | Self::Ultra) { 4 } else { 1 },
            shading: quality.shading(),
            shadows: Some(shadows),
            occlusion,
            reflections: if ultra { Some(ReflectionSettings::DEFAULT) } else { None },
            glass_layers: if ultra { 3 } else { 1 },
            hdr_format: if matches!(self, Self::Low) { Format::Rg11b10Ufloat } else { Settings::DEFAULT.hdr_format },
            ..Settings::DEFAULT
        };
        FrameSettings { quality, settings, ..FrameSettings::DEFAULT }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_have_names_and_differ() {
        for (i, preset) in Preset::ALL.into_iter().enumerate() {
            assert_eq!(Preset::from_name(preset.name()), Some(preset));
            assert!(Preset::ALL[..i].iter().all(|other| other.frame() != preset.frame()), "{preset:?}");
        }
        assert_eq!(Preset::from_name("best"), None);
    }
}
