//! Presets: frames chosen from a record of measurements, for four fractions of the finest frame's time.
//!
//! Each preset is the most accurate set of options of [`GROUPS`](crate::quality::GROUPS) within its fraction
//! ([`Preset::share`]) of the time that the finest frame takes beyond the fastest. Errors count as often as typical
//! scenes show them ([`Group::seen_in`]). Presets below ultra exclude options whose own passes take more than a third of
//! a frame ([`Preset::MAX_PASSES`]). [`Preset::choose`] finds the set in any record. [`Preset::frame`] has the choice for `docs/measurements/accuracy.json`. The record lacks punctual lights and levels of
//! detail: the number of their shadow maps and the LOD error are set by hand.

mod chosen;

use crate::feature_culling::Facts;
use crate::frame::frame_settings::FrameSettings;
use crate::gpu_scene::shadow_views::ShadowSettings;
use crate::quality::{FrameOption, Group, Measured, MeasuredError};

/// Presets from the cheapest frame to the finest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Preset {
    /// For phones.
    Low,
    /// One sample, a shadow map, and ambient occlusion at half resolution.
    Medium,
    /// Four samples, cascades, finer ambient occlusion.
    High,
    /// All effects with their finest options, for still pictures.
    Ultra,
}

impl Preset {
    /// All presets.
    pub const ALL: [Self; 4] = [Self::Low, Self::Medium, Self::High, Self::Ultra];

    /// Returns the name used in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
            Self::Ultra => "ultra",
        }
    }

    /// Returns the preset with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }

    /// Returns the allowed fraction, 0 to 1, of the time that the finest frame takes beyond the fastest.
    pub const fn share(self) -> f64 {
        match self {
            Self::Low => 1.0 / 7.0,
            Self::Medium => 1.0 / 3.0,
            Self::High => 0.75,
            Self::Ultra => 1.0,
        }
    }

    /// Largest share of a frame's time that the passes of one option may take, except in [`Preset::Ultra`].
    pub const MAX_PASSES: f64 = 1.0 / 3.0;

    /// Returns the option that a record chooses for each of its groups, among options for which `has` returns true
    /// (the device supports them).
    ///
    /// # Errors
    /// Fails as [`MeasuredError`] describes.
    pub fn choose(
        self,
        measured: &Measured,
        has: impl Fn(&FrameOption) -> bool,
    ) -> Result<Vec<(&'static Group, &'static FrameOption)>, MeasuredError> {
        let choices = measured.choices(&Facts::default(), has)?;
        let mut offers = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
        for ((group, _), own) in choices.iter().zip(&mut offers.groups) {
            own.iter_mut().for_each(|offer| offer.squares *= group.seen_in);
        }
        let [fastest, finest] = [offers.fastest(), offers.finest()].map(|set| offers.predicted(&set).ms);
        let most_ms = fastest + self.share() * (finest - fastest);
        if self != Self::Ultra {
            for ((group, options), own) in choices.iter().zip(&mut offers.groups) {
                for (option, offer) in options.iter().zip(own) {
                    if measured.share(self.name(), group, option) > Self::MAX_PASSES {
                        offer.ms = f64::INFINITY;
                    }
                }
            }
        }
        // Rounding must not exclude the finest set.
        let set = offers.within_ms(most_ms * (1.0 + 1e-9)).map_or_else(|| offers.fastest(), |set| set.options);
        Ok(choices.into_iter().zip(set).map(|((group, options), index)| (group, options[index])).collect())
    }

    /// Returns the frame that a record chooses.
    ///
    /// # Errors
    /// Fails as [`MeasuredError`] describes.
    pub fn measured(
        self,
        measured: &Measured,
        has: impl Fn(&FrameOption) -> bool,
    ) -> Result<FrameSettings, MeasuredError> {
        let mut frame = self.frame();
        self.choose(measured, has)?.into_iter().for_each(|(_, option)| (option.apply)(&mut frame));
        Ok(frame)
    }

    /// Returns the frame of the preset.
    pub fn frame(self) -> FrameSettings {
        let (local_maps, lod_error_px) = match self {
            Self::Low => (0, 1.0),
            Self::Medium => (6, 0.5),
            Self::High => (12, 0.25),
            Self::Ultra => (24, 0.0),
        };
        let mut frame = FrameSettings { lod_error_px, ..FrameSettings::DEFAULT };
        frame.settings.shadows = Some(ShadowSettings { local_maps, ..ShadowSettings::DEFAULT });
        for (group, options) in chosen::CHOSEN {
            if let Some(option) = Group::of(group).and_then(|group| group.option(options[self as usize])) {
                (option.apply)(&mut frame);
            }
        }
        frame
    }
}

/// Returns the source text of the table of [`Preset::frame`] for a record.
///
/// # Errors
/// Fails as [`MeasuredError`] describes.
pub fn source(measured: &Measured) -> Result<String, MeasuredError> {
    let mut chosen = Vec::new();
    for preset in Preset::ALL {
        chosen.push(preset.choose(measured, |_| true)?);
    }
    let row = |index: usize| {
        let options: Vec<_> = chosen.iter().map(|preset| format!("\"{}\"", preset[index].1.name)).collect();
        format!("    (\"{}\", [{}]),\n", chosen[0][index].0.name, options.join(", "))
    };
    let rows: String = (0..chosen[0].len()).map(row).collect();
    Ok(format!(
        "//! Options of the presets, chosen from docs/measurements/accuracy.json; renewed by\n\
        //! `cargo run -p tests --bin accuracy -- --out docs/measurements --presets passes/src/quality/preset/chosen.rs`.\n\n\
        /// Each group with its option in low, medium, high and ultra.\n\
        #[rustfmt::skip]\n\
        pub const CHOSEN: [(&str, [&str; 4]); {}] = [\n{rows}];\n",
        chosen[0].len()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quality::GROUPS;

    #[test]
    fn presets_have_names_and_differ() {
        for (i, preset) in Preset::ALL.into_iter().enumerate() {
            assert_eq!(Preset::from_name(preset.name()), Some(preset));
            assert!(Preset::ALL[..i].iter().all(|other| other.frame() != preset.frame()), "{preset:?}");
            assert!(Preset::ALL[..i].iter().all(|other| other.share() < preset.share()), "{preset:?}");
        }
        assert_eq!(Preset::from_name("best"), None);
    }

    /// Only ultra has reflections. Other presets have no effect that prevents inlined post-processing.
    #[test]
    fn presets_below_ultra_leave_post_processing_inlined() {
        for preset in Preset::ALL {
            let settings = preset.frame().settings;
            assert_eq!(settings.reflections.is_some(), preset == Preset::Ultra, "{preset:?}");
            assert!(settings.bloom.is_none() && settings.dof.is_none() && settings.taa.is_none(), "{preset:?}");
        }
    }

    #[test]
    fn presets_choose_of_every_group_what_there_is() {
        assert_eq!(chosen::CHOSEN.map(|(group, _)| group), GROUPS.map(|group| group.name));
        for (group, options) in chosen::CHOSEN {
            let group = Group::of(group).expect("a group");
            assert!(options.iter().all(|name| group.option(name).is_some()), "{}: {options:?}", group.name);
            assert_eq!(options.last(), group.options.last().map(|option| &option.name), "ultra is the finest");
        }
    }
}
