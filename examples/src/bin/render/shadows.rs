//! Options of shadows.

use crate::look::pairs;
use framegraph_passes::shadow::{
    ContactShadows, Fit, MOST_MAPS, ShadowFilter, ShadowSettings, Splits, local_layers, local_maps,
};
use framegraph_passes::sun::has_sun;
use framegraph_scene::{Light, Scene};
use glam::DVec3;
use lexopt::Parser;

/// What `render --help` prints of them.
pub const HELP: &str = "
SHADOWS
  --shadows NAME       off, pcf (a tent of 3x3 texels), dpcf or pcss (penumbrae), vsm or evsm (moments in 16 or 32 bits) (pcf)
  --cascades N         maps of the sun by distance, 1 to 4 (1)
  --shadow KEY=X,...   texels=N (across a map; 2048), fit=lispsm|tight|stable (lispsm), splits=uniform|log|practical:L|A:B:C
                       (of the range, 0.125:0.25:0.5), far=M (fade out before; none), constant-bias=M (0.001),
                       normal-bias=X (half texels; 2), slope-bias=X (2), bulb=M|disc (width of penumbrae; the light's
                       disc), blur=TEXELS, levels=N, samples=1|4, bleed=X (of moments; 0, 1, 1, 0.15), local=N (most maps
                       of spot and point lights; 12), layers=N (most layers that those share, each as large as a map of
                       the sun; as many as they take), contact=on|off|STEPS:M (a ray of M meters through the picture's
                       depth; off), keep=on|off (maps are drawn by a first frame, and by the measured ones where one would
                       change; off)
  --show-cascades      tint what is lit by the number of its cascade
  --no-shadows         as --shadows off
";

/// Maps of local lights where nothing else is asked for: two point lights.
const LOCAL_MAPS: u8 = 12;

/// What was asked for.
#[derive(Clone, Copy, Debug)]
pub struct Shadows {
    settings: ShadowSettings,
    off: bool,
    /// Maps are kept from frame to frame.
    pub keep: bool,
}

impl Default for Shadows {
    fn default() -> Self {
        Self { settings: ShadowSettings { local_maps: LOCAL_MAPS, ..ShadowSettings::DEFAULT }, off: false, keep: false }
    }
}

impl Shadows {
    /// Those of a frame.
    pub fn with(settings: Option<ShadowSettings>) -> Self {
        Self { settings: settings.unwrap_or(Self::default().settings), off: settings.is_none(), keep: false }
    }

    /// What a frame asks for of any scene; none where shadows are off.
    pub fn asked(&self) -> Option<ShadowSettings> {
        (!self.off).then_some(self.settings)
    }

    /// Takes the shadows of another frame; whether maps are kept stays.
    pub fn hold(&mut self, settings: Option<ShadowSettings>) {
        *self = Self { keep: self.keep, ..Self::with(settings) };
    }

    /// Takes an option of this file; false for others.
    ///
    /// # Errors
    /// One line that names the option and what it takes.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        let mut value = || {
            let value = parser.value().map_err(|_| format!("--{name}: a value is missing"))?;
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
                    let unknown = || format!("--shadows {value}: there are off, {}", names());
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
            "texels" => settings.map_texels = number(16.0, 16384.0)? as u32,
            "fit" => {
                settings.fit = match value {
                    "lispsm" => Fit::Tight { lispsm: true },
                    "tight" => Fit::Tight { lispsm: false },
                    "stable" => Fit::Stable,
                    _ => return Err(format!("{option}={value}: `lispsm`, `tight` or `stable` is needed")),
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
                    _ => return Err(format!("{option}={value}: `on`, `off` or STEPS:METERS is needed")),
                }
            }
            "keep" => {
                self.keep = match value {
                    "on" => true,
                    "off" => false,
                    _ => return Err(format!("{option}={value}: `on` or `off` is needed")),
                }
            }
            "layers" => settings.local_layers = number(1.0, f64::from(MOST_MAPS))? as u8,
            "local" => settings.local_maps = number(0.0, f64::from(MOST_MAPS - 4))? as u8,
            _ => return Err(format!("--shadow {key}: there is no such choice; `render --help` lists them")),
        }
        Ok(())
    }

    /// How shadows are made of a scene with this sun of its environment, seen from `eye`; none where nothing casts.
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
        _ => return Err(format!("{option}={value}: `uniform`, `log`, `practical:L` or three shares A:B:C are needed")),
    })
}

fn number(option: &str, text: &str, low: f64, high: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        _ => Err(format!("{option} {text}: a number from {low} to {high} is needed")),
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
            let lexopt::Arg::Long(name) = arg else { return Err("an option is needed".into()) };
            let name = name.to_owned();
            assert!(shadows.take(&name, &mut parser)?, "{name}");
        }
        Ok(shadows)
    }

    #[test]
    fn choices_arrive() {
        let words =
            ["--shadows", "pcss", "--cascades", "3", "--shadow", "fit=stable,splits=practical:0.5,bulb=0.1,far=50"];
        let found = parsed(&words).expect("sound options").settings;
        let ShadowSettings { filter, cascades, fit, splits, bulb_m, far_m, .. } = found;
        assert_eq!((filter, cascades, fit), (ShadowFilter::Pcss, 3, Fit::Stable));
        assert_eq!((splits, bulb_m, far_m), (Splits::Practical(0.5), Some(0.1), Some(50.0)));
        assert!(parsed(&["--shadows", "off"]).expect("off").off && parsed(&["--no-shadows"]).expect("off").off);
    }

    #[test]
    fn wrong_words_are_named() {
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
            let told = parsed(&words).expect_err("that is wrong");
            assert!(told.contains(words[0]) && !told.contains('\n'), "{told}");
        }
    }
}
