//! Groups of options that trade time for quality.

use crate::effects::depth::structure::Resolution;
use crate::effects::occlusion::{OcclusionSettings, SaoQuality};
use crate::effects::reflection::ReflectionSettings;
use crate::feature_culling::{Decision, Effect, Facts};
use crate::frame::frame_settings::FrameSettings;
use crate::gpu_scene::shadow_views::{ContactShadows, ShadowFilter, ShadowSettings, Splits};
use crate::light::shading::Quality;
use crate::settings::precision::Precision;
use framegraph::Format;

/// An option of a group.
#[derive(Clone, Copy, Debug)]
pub struct FrameOption {
    /// Name for tables and files.
    pub name: &'static str,
    /// Changes a frame to use this option.
    pub apply: fn(&mut FrameSettings),
}

/// A group of mutually exclusive options. Options that only make sense together, such as the visibility term and its
/// table, form one group.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Name for tables and files: lower case, words joined by `-`.
    pub name: &'static str,
    /// Effects of the group. If feature culling drops all requested ones, the group leaves no choice.
    pub effects: &'static [Effect],
    /// Options from the cheapest to the finest, which is the reference's.
    pub options: &'static [FrameOption],
    /// Share of typical scenes in which the options differ visibly, 0 to 1. [`Preset`](crate::Preset) multiplies mean
    /// squared errors with it, since it is chosen without a scene. An estimate, not a measurement.
    pub seen_in: f64,
}

const fn option(name: &'static str, apply: fn(&mut FrameSettings)) -> FrameOption {
    FrameOption { name, apply }
}

/// All groups.
pub const GROUPS: [Group; 8] = [
    Group {
        name: "edges",
        effects: &[Effect::Fxaa, Effect::Msaa],
        options: &[
            option("none", |f| (f.settings.samples, f.settings.fxaa) = (1, false)),
            option("FXAA", |f| (f.settings.samples, f.settings.fxaa) = (1, true)),
            option("4 samples", |f| (f.settings.samples, f.settings.fxaa) = (4, false)),
        ],
        seen_in: 1.0,
    },
    Group {
        name: "sun-shadows",
        effects: &[Effect::SunShadows],
        options: &[
            option("none", |f| {
                f.settings = f.settings.without(Effect::ContactShadows).without(Effect::SunShadows);
            }),
            option("1 map of 1024², PCF", |f| sun_maps(f, 1, 1024, ShadowFilter::Pcf, None)),
            option("1 map of 2048², PCF", |f| sun_maps(f, 1, 2048, ShadowFilter::Pcf, None)),
            option("3 maps of 2048², PCF", |f| sun_maps(f, 3, 2048, ShadowFilter::Pcf, None)),
            option("4 maps of 2048², PCSS, contact", |f| {
                sun_maps(f, 4, 2048, ShadowFilter::Pcss, Some(ContactShadows::FILAMENT));
            }),
        ],
        seen_in: 1.0,
    },
    Group {
        name: "occlusion",
        effects: &[Effect::Occlusion],
        options: &[
            option("none", |f| f.settings.occlusion = None),
            option("SAO of 7 taps, half size", |f| {
                f.settings.occlusion =
                    Some(OcclusionSettings { resolution: Resolution::Half, ..OcclusionSettings::SAO });
            }),
            option("SAO of 7 taps", |f| f.settings.occlusion = Some(OcclusionSettings::SAO)),
            option("SAO of 16 taps", |f| {
                f.settings.occlusion = Some(OcclusionSettings::sao(SaoQuality::High));
            }),
            option("GTAO", |f| f.settings.occlusion = Some(OcclusionSettings::GTAO)),
        ],
        seen_in: 1.0,
    },
    Group {
        name: "shading",
        effects: &[],
        options: &[
            option("low", |f| shading(f, Quality::Low)),
            option("high", |f| shading(f, Quality::High)),
            option("ultra", |f| shading(f, Quality::Ultra)),
        ],
        seen_in: 1.0,
    },
    Group {
        name: "precision",
        effects: &[],
        options: &[
            option("f16", |f| f.settings.shading.precision = Precision::Half),
            option("f32", |f| f.settings.shading.precision = Precision::Full),
        ],
        seen_in: 1.0,
    },
    Group {
        name: "radiance",
        effects: &[Effect::HdrTarget],
        options: &[
            option("Rg11b10Ufloat", |f| f.settings.hdr_format = Format::Rg11b10Ufloat),
            option("Rgba16Float", |f| f.settings.hdr_format = Format::Rgba16Float),
        ],
        seen_in: 1.0,
    },
    Group {
        name: "reflections",
        effects: &[Effect::Reflections],
        options: &[
            option("none", |f| f.settings.reflections = None),
            option("of the picture", |f| f.settings.reflections = Some(ReflectionSettings::DEFAULT)),
        ],
        // Smooth floors and water.
        seen_in: 1.0 / 8.0,
    },
    Group {
        name: "glass-layers",
        effects: &[Effect::GlassLayers],
        options: &[
            option("1", |f| f.settings.glass_layers = 1),
            option("2", |f| f.settings.glass_layers = 2),
            option("3", |f| f.settings.glass_layers = 3),
        ],
        // Glass behind glass.
        seen_in: 1.0 / 8.0,
    },
];

/// Sets shading and environment quality; the precision is unchanged.
fn shading(frame: &mut FrameSettings, quality: Quality) {
    let precision = frame.settings.shading.precision;
    frame.quality = quality;
    frame.settings.shading = quality.shading();
    frame.settings.shading.precision = precision;
}

/// Sets the shadow maps of the sun; those of punctual lights are unchanged.
fn sun_maps(
    frame: &mut FrameSettings,
    cascades: u8,
    map_texels: u32,
    filter: ShadowFilter,
    contact: Option<ContactShadows>,
) {
    let splits = if cascades > 1 { Splits::Practical(0.8) } else { ShadowSettings::DEFAULT.splits };
    let none = ShadowSettings { local_maps: 0, ..ShadowSettings::DEFAULT };
    let old = frame.settings.shadows.unwrap_or(none);
    frame.settings.shadows = Some(ShadowSettings { cascades, map_texels, filter, contact, splits, ..old });
}

impl Group {
    /// Returns the group with this name.
    pub fn of(name: &str) -> Option<&'static Self> {
        GROUPS.iter().find(|group| group.name == name)
    }

    /// Returns the option with this name.
    pub fn option(&self, name: &str) -> Option<&'static FrameOption> {
        self.options.iter().find(|option| option.name == name)
    }

    /// Returns true if the frame has none of the group's effects: each was not requested, or the scene does not need
    /// it. All options then give the same frame. Returns false for empty facts.
    pub fn is_dropped(&self, of_reference: &Facts) -> bool {
        let gone = |effect: &Effect| of_reference.of(*effect).is_none_or(|fact| fact.decision == Decision::Dropped);
        !of_reference.rows.is_empty() && !self.effects.is_empty() && self.effects.iter().all(gone)
    }
}

/// Returns the frame with the finest option of each group; everything else is unchanged.
#[must_use]
pub fn reference(frame: &FrameSettings) -> FrameSettings {
    let mut finest = *frame;
    for option in GROUPS.iter().filter_map(|group| group.options.last()) {
        (option.apply)(&mut finest);
    }
    finest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_make_other_frames_and_stay_what_they_are() {
        let finest = reference(&FrameSettings::DEFAULT);
        for group in &GROUPS {
            let made = group.options.iter().map(|option| {
                let mut frame = finest;
                (option.apply)(&mut frame);
                let once = frame;
                (option.apply)(&mut frame);
                assert_eq!(frame, once, "{}: {}", group.name, option.name);
                frame
            });
            let made: Vec<_> = made.collect();
            assert_eq!(made.last(), Some(&finest), "{}: the last is the reference's", group.name);
            for (index, frame) in made.iter().enumerate() {
                assert!(!made[..index].contains(frame), "{}: {}", group.name, group.options[index].name);
            }
            assert!(Group::of(group.name).is_some_and(|found| found.option(group.options[0].name).is_some()));
        }
        assert!(Group::of("sepia").is_none());
    }
}
