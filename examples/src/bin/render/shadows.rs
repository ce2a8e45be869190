//! Shadow options.

use crate::parse::fields;
use framegraph_passes::SettingsTable;
use framegraph_passes::gpu_scene::shadow_views::{ShadowSettings, local_layers, local_maps};
use framegraph_passes::light::sun::has_sun;
use framegraph_scene::{Light, Scene};
use glam::DVec3;
use program::clap::Arg;
use program::cli::{Item, flag, option};

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let all = vec![
        option(
            "shadows",
            "FILTER",
            "off, pcf (3x3 tent), dpcf or pcss (variable penumbra), vsm or evsm (16- or 32-bit moments) (pcf)",
        ),
        option("cascades", "N", "Cascades of the sun's shadow map, 1 to 4 (1)"),
        option(
            "shadow",
            "KEY=X,...",
            "Settings of shadow maps; `--shadow help` lists the keys. keep=on draws maps in the first frame, later \
             only those that change (off)",
        ),
        flag("show-cascades", "Tint surfaces by their cascade"),
        flag("no-shadows", "Same as --shadows off"),
    ];
    all.into_iter().map(|option| option.help_heading("Shadows")).collect()
}

/// Default maximum number of shadow maps of punctual lights: two point lights.
const PUNCTUAL_MAPS: u8 = 12;

/// Shadow settings of the command line.
#[derive(Clone, Copy, Debug)]
pub struct Shadows {
    settings: ShadowSettings,
    off: bool,
    /// Keeps shadow maps from frame to frame.
    pub keep: bool,
}

impl Default for Shadows {
    fn default() -> Self {
        Self {
            settings: ShadowSettings { local_maps: PUNCTUAL_MAPS, ..ShadowSettings::DEFAULT },
            off: false,
            keep: false,
        }
    }
}

impl Shadows {
    /// Starts with the shadows of a frame.
    pub fn with(settings: Option<ShadowSettings>) -> Self {
        Self { settings: settings.unwrap_or(Self::default().settings), off: settings.is_none(), keep: false }
    }

    /// Returns the requested shadow settings of any scene; `None` if shadows are off.
    pub fn asked(&self) -> Option<ShadowSettings> {
        (!self.off).then_some(self.settings)
    }

    /// Adopts the shadows of another frame, but keeps the choice of [`Self::keep`].
    pub fn hold(&mut self, settings: Option<ShadowSettings>) {
        *self = Self { keep: self.keep, ..Self::with(settings) };
    }

    /// Parses the value of an option of this module; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, item: &Item) -> Result<bool, String> {
        match item.name() {
            "no-shadows" => self.off = true,
            "show-cascades" => self.settings.show_cascades = true,
            "shadows" => {
                let value = item.text()?;
                self.off = value == "off";
                if !self.off {
                    let wrong = |error| format!("--shadows {value}: {error}");
                    self.settings.set("filter", &value).map_err(|error| wrong(error.to_string()))?;
                }
            }
            "cascades" => self.settings.cascades = item.parse("1 to 4", cascades)?,
            "shadow" => {
                for pair in item.text()?.split(',').filter(|pair| !pair.is_empty()) {
                    match pair {
                        "keep=on" => self.keep = true,
                        "keep=off" => self.keep = false,
                        _ if pair.starts_with("keep") => {
                            return Err(format!("--shadow {pair}: expected keep=on or keep=off"));
                        }
                        _ => fields("shadow", pair, &mut self.settings)?,
                    }
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Returns the shadow settings for a scene seen from `eye`, with the sun of its environment; `None` if no light casts
    /// shadows.
    pub fn of(&self, scene: &Scene, own_sun: Option<&Light>, eye: DVec3) -> Option<ShadowSettings> {
        let cascades = if has_sun(scene, own_sun) { self.settings.cascades } else { 0 };
        let local_maps = local_maps(scene, cascades).min(self.settings.local_maps);
        let settings = ShadowSettings { cascades, local_maps, ..self.settings };
        let settings = ShadowSettings { local_layers: local_layers(scene, eye, &settings), ..settings };
        (!self.off && settings.layers() > 0).then_some(settings)
    }
}

fn cascades(text: &str) -> Option<u8> {
    text.parse().ok().filter(|cascades| (1..=4).contains(cascades))
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_passes::gpu_scene::shadow_views::{Fit, ShadowFilter, Splits};

    fn parsed(words: &[&str]) -> Result<Shadows, String> {
        let mut shadows = Shadows::default();
        crate::parse::taken(options(), words, |item| shadows.take(item))?;
        Ok(shadows)
    }

    #[test]
    fn options_are_parsed() {
        let words =
            ["--shadows", "pcss", "--cascades", "3", "--shadow", "fit=stable,splits=practical:0.5,bulb=0.1,far=50"];
        let found = parsed(&words).expect("sound options").settings;
        let ShadowSettings { filter, cascades, fit, splits, bulb_m, far_m, .. } = found;
        assert_eq!((filter, cascades, fit), (ShadowFilter::Pcss, 3, Fit::Stable));
        assert_eq!((splits, bulb_m, far_m), (Splits::Practical(0.5), Some(0.1), Some(50.0)));
        assert!(parsed(&["--shadows", "off"]).expect("off").off && parsed(&["--no-shadows"]).expect("off").off);
    }

    #[test]
    fn former_keys_are_valid() {
        let of = |keys: &str| parsed(&["--shadow", keys]).map(|shadows| shadows.settings);
        let current = of("map-size=64,punctual=3");
        assert_eq!(of("texels=64,local=3"), current);
        assert_ne!(of(""), current);
    }

    #[test]
    fn invalid_options_are_reported() {
        for words in [
            ["--shadows", "soft"],
            ["--cascades", "5"],
            ["--shadow", "gloss=1"],
            ["--shadow", "texels"],
            ["--shadow", "texels=NaN"],
            ["--shadow", "splits=0.1:0.2"],
            ["--shadow", "fit=loose"],
            ["--shadow", "keep=some"],
        ] {
            let error = parsed(&words).expect_err("the command line is invalid");
            assert!(error.contains(words[0]) && !error.contains('\n'), "{error}");
        }
    }
}
