//! Shadow options.

use crate::parse::pairs;
use framegraph_passes::gpu_scene::shadow_views::{
    ContactShadows, Fit, MAX_MAPS, ShadowFilter, ShadowSettings, Splits, local_layers, local_maps,
};
use framegraph_passes::light::sun::has_sun;
use framegraph_scene::{Light, Scene};
use glam::DVec3;
use lexopt::Parser;

/// Help section.
pub const HELP: &str = "\
SHADOWS
  --shadows FILTER     off, pcf (3x3 tent), dpcf or pcss (variable penumbra), vsm or evsm (16- or 32-bit moments) (pcf)
  --cascades N         cascades of the sun's shadow map, 1 to 4 (1)
  --shadow KEY=X,...   map-size=N (side of a shadow map in texels, 2048), fit=lispsm|tight|stable (lispsm),
                       splits=uniform|log|practical:L|A:B:C (relative to the range, 0.125:0.25:0.5),
                       far=M (maximum distance with a fade; none), constant-bias=M (0.001), normal-bias=X (half texels, 2),
                       slope-bias=X (2), bulb=M|disc (light size for penumbrae; disc: the light's own size).
                       Moments: blur=TEXELS, levels=N, samples=1|4, bleed=X (light-bleeding reduction) (0, 1, 1, 0.15).
                       Punctual lights: punctual=N (maximum number of maps, 12), layers=N (maximum number of texture layers
                       for these maps, each as large as a map of the sun; as needed).
                       contact=on|off|STEPS:M (screen-space contact shadows, rays of M meters; off),
                       keep=on|off (draw maps in the first frame, later only those that change; off)
  --show-cascades      tint surfaces by their cascade
  --no-shadows         same as --shadows off
";

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
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        let mut value = || {
            let value = parser.value().map_err(|_| format!("--{name}: missing value"))?;
            value.into_string().map_err(|v| format!("--{name} {v:?}: the value is not Unicode"))
        };
        match name {
            "no-shadows" => self.off = true,
            "show-cascades" => self.settings.show_cascades = true,
            "shadows" => {
                let value = value()?;
                self.off = value == "off";
                if !self.off {
                    let names = || ShadowFilter::ALL.map(ShadowFilter::name).join(", ");
                    let unknown = || format!("--shadows {value}: unknown filter; expected off, {}", names());
                    self.settings.filter = ShadowFilter::from_name(&value).ok_or_else(unknown)?;
                }
            }
            "cascades" => self.settings.cascades = number("--cascades", &value()?, 1.0, 4.0)? as u8,
            "shadow" => {
                for (key, value) in pairs("--shadow", &value()?)? {
                    self.set(key, value)?;
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let settings = &mut self.settings;
        let option = format!("--shadow {key}");
        let number = |low, high| number(&option, value, low, high);
        match key {
            "map-size" | "texels" => settings.map_texels = number(16.0, 16384.0)? as u32,
            "fit" => {
                settings.fit = match value {
                    "lispsm" => Fit::Tight { lispsm: true },
                    "tight" => Fit::Tight { lispsm: false },
                    "stable" => Fit::Stable,
                    _ => return Err(format!("{option}={value}: expected `lispsm`, `tight` or `stable`")),
                }
            }
            "splits" => settings.splits = splits(&option, value)?,
            "far" => settings.far_m = Some(number(0.01, 1e7)?),
            "constant-bias" => settings.bias.constant_m = number(0.0, 10.0)? as f32,
            "normal-bias" => settings.bias.normal = number(0.0, 100.0)? as f32,
            "slope-bias" => settings.bias.slope = number(0.0, 100.0)? as f32,
            "bulb" => settings.bulb_m = if value == "disc" { None } else { Some(number(1e-6, 1e3)? as f32) },
            "blur" => settings.moments.blur_texels = number(0.0, 125.0)? as f32,
            "levels" => settings.moments.levels = number(1.0, 8.0)? as u8,
            "samples" => settings.moments.samples = if number(1.0, 4.0)? > 2.0 { 4 } else { 1 },
            "bleed" => settings.moments.bleed = number(0.0, 0.99)? as f32,
            "contact" => {
                settings.contact = match (value, value.split_once(':')) {
                    ("off", _) => None,
                    ("on", _) => Some(ContactShadows::FILAMENT),
                    (_, Some((steps, distance_m))) => Some(ContactShadows {
                        steps: self::number(&option, steps, 1.0, 256.0)? as u32,
                        distance_m: self::number(&option, distance_m, 0.001, 100.0)? as f32,
                    }),
                    _ => return Err(format!("{option}={value}: expected `on`, `off` or STEPS:METERS")),
                }
            }
            "keep" => {
                self.keep = match value {
                    "on" => true,
                    "off" => false,
                    _ => return Err(format!("{option}={value}: expected `on` or `off`")),
                }
            }
            "layers" => settings.local_layers = number(1.0, f64::from(MAX_MAPS))? as u8,
            "punctual" | "local" => settings.local_maps = number(0.0, f64::from(MAX_MAPS - 4))? as u8,
            _ => return Err(format!("--shadow {key}: unknown key; see `render --help`")),
        }
        Ok(())
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

fn splits(option: &str, value: &str) -> Result<Splits, String> {
    let share = |text: &str| number(option, text, 0.0, 1.0);
    let parts: Vec<&str> = value.split(':').collect();
    Ok(match parts.as_slice() {
        ["uniform"] => Splits::Uniform,
        ["log"] => Splits::Logarithmic,
        ["practical", lambda] => Splits::Practical(share(lambda)?),
        [a, b, c] => Splits::At([share(a)?, share(b)?, share(c)?]),
        _ => return Err(format!("{option}={value}: expected `uniform`, `log`, `practical:L` or A:B:C")),
    })
}

fn number(option: &str, text: &str, low: f64, high: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        _ => Err(format!("{option} {text}: expected a number from {low} to {high}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsString;

    fn parsed(words: &[&str]) -> Result<Shadows, String> {
        let mut shadows = Shadows::default();
        let mut parser = Parser::from_args(words.iter().map(OsString::from));
        while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
            let lexopt::Arg::Long(name) = arg else { return Err("expected an option".into()) };
            let name = name.to_owned();
            assert!(shadows.take(&name, &mut parser)?, "{name}");
        }
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
