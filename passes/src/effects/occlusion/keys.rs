//! Option parsing of ambient occlusion: `off`, `sao`, `sao:quality=high,radius=0.5`, `gtao:occluders=0.5`.

use super::settings::{Blur, ConeTrace, Gtao, Method, Occluders, OcclusionSettings, SaoQuality};
use crate::effects::depth::structure::Resolution;
use crate::settings::key_value::{KeyValue, OptionError, choices};

impl OcclusionSettings {
    /// Names accepted by [`OcclusionSettings::set`].
    pub const KEYS: [&str; 19] = [
        "quality",
        "resolution",
        "radius",
        "bias",
        "intensity",
        "power",
        "horizon",
        "blur",
        "threshold",
        "normals",
        "place",
        "bent-normals",
        "cone",
        "taps",
        "turns",
        "slices",
        "steps",
        "step-power",
        "occluders",
    ];

    /// Parses `off`, or a method with changes such as `sao:resolution=half,radius=0.5`. Returns `None` for `off`.
    ///
    /// # Errors
    /// Fails for an unknown method or name or an invalid value; the message names it and the accepted values.
    pub fn from_text(text: &str) -> Result<Option<Self>, OptionError> {
        let (method, changes) = text.split_once(':').unwrap_or((text, ""));
        let mut settings = match method {
            "off" => return Ok(None),
            "sao" => Self::SAO,
            "gtao" => Self::GTAO,
            _ => return Err(KeyValue { key: method, value: "" }.unknown(&["off", "sao", "gtao"])),
        };
        for KeyValue { key, value } in choices(changes) {
            settings.set(key, value)?;
        }
        Ok(Some(settings))
    }

    /// Changes one setting by name. `quality` is a preset that includes the blur; later names override parts of it.
    ///
    /// # Errors
    /// Fails as [`OcclusionSettings::from_text`] does.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), OptionError> {
        let choice = KeyValue { key, value };
        let (wrong, switch) = (|takes| choice.wrong(takes), || choice.switch());
        match key {
            "quality" | "taps" | "turns" if matches!(self.method, Method::Gtao(_)) => return Err(choice.only("sao")),
            "slices" | "steps" | "step-power" | "occluders" => match &mut self.method {
                Method::Gtao(gtao) => gtao.set(choice)?,
                Method::Sao { .. } => return Err(choice.only("gtao")),
            },
            "bent-normals" => self.bent_normals = switch()?,
            "cone" => self.cone = switch()?.then_some(ConeTrace::FILAMENT),
            "quality" => {
                let quality = SaoQuality::ALL.into_iter().find(|quality| quality.name() == value);
                let preset = Self::sao(quality.ok_or_else(|| wrong("`low`, `medium`, `high` or `ultra`"))?);
                (self.method, self.blur) = (preset.method, preset.blur);
            }
            "resolution" => {
                self.resolution = match value {
                    "full" => Resolution::Full,
                    "half" => Resolution::Half,
                    _ => return Err(wrong("`full` or `half`")),
                }
            }
            "radius" => self.radius_m = choice.number(0.0, 1e4)?,
            "bias" => self.bias = choice.number(0.0, 1.0)?,
            "intensity" => self.intensity = choice.number(0.0, 16.0)?,
            "power" => self.power = choice.number(0.0, 16.0)?,
            "horizon" => self.min_horizon_rad = choice.number(0.0, 90.0)?.to_radians(),
            "blur" => {
                let threshold_m = self.blur.map_or(Blur::high(1.0).threshold_m, |blur| blur.threshold_m);
                let sigma = self.blur.map_or(SaoQuality::Low.sigma(), |blur| blur.sigma * blur.stride as f32);
                self.blur = match value {
                    "off" => None,
                    "low" => Some(Blur { threshold_m, ..Blur::LOW }),
                    "medium" => Some(Blur { threshold_m, ..Blur::medium(sigma) }),
                    "high" => Some(Blur { threshold_m, ..Blur::high(sigma) }),
                    _ => return Err(wrong("`off`, `low`, `medium` or `high`")),
                }
            }
            "threshold" => {
                let threshold_m = choice.number(1e-6, 1e4)?;
                self.blur.as_mut().ok_or_else(|| wrong("a blur"))?.threshold_m = threshold_m;
            }
            "normals" => {
                self.fine_normals = match value {
                    "fine" => true,
                    "coarse" => false,
                    _ => return Err(wrong("`fine` or `coarse`")),
                }
            }
            "place" => {
                self.exact_taps = match value {
                    "exact" => true,
                    "filament" => false,
                    _ => return Err(wrong("`exact` or `filament`")),
                }
            }
            "taps" | "turns" => {
                if let Method::Sao { taps, turns } = &mut self.method {
                    let (count, least) = if key == "taps" { (taps, 1) } else { (turns, 0) };
                    *count = choice.whole(least, 64)?;
                }
            }
            _ => return Err(choice.unknown(&Self::KEYS)),
        }
        Ok(())
    }
}

impl Gtao {
    fn set(&mut self, choice: KeyValue<'_>) -> Result<(), OptionError> {
        match choice.key {
            "slices" => self.slices = choice.whole(1, 16)?,
            "steps" => self.steps = choice.whole(1, 32)?,
            "step-power" => self.step_power = choice.number(0.5, 4.0)?,
            _ => {
                self.occluders = match choice.value {
                    "solid" => Occluders::Solid,
                    "fading" => Occluders::Fading,
                    _ => Occluders::Thick(choice.number(1e-3, 1e4)?),
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_made_by_name() -> Result<(), OptionError> {
        assert_eq!(OcclusionSettings::from_text("off")?, None);
        assert_eq!(OcclusionSettings::from_text("sao")?, Some(OcclusionSettings::SAO));
        for quality in SaoQuality::ALL {
            let asked = OcclusionSettings::from_text(&format!("sao:quality={}", quality.name()))?;
            assert_eq!(asked, Some(OcclusionSettings::sao(quality)));
        }
        let own = "sao:quality=ultra,resolution=half,radius=0.5,bias=0.001,intensity=2,power=3,horizon=30,blur=medium,\
                   threshold=0.1,normals=coarse,place=filament,taps=5,turns=2,bent-normals=on,cone=on";
        let expected = OcclusionSettings {
            method: Method::Sao { taps: 5, turns: 2 },
            resolution: Resolution::Half,
            radius_m: 0.5,
            bias: 0.001,
            intensity: 2.0,
            power: 3.0,
            min_horizon_rad: 30_f32.to_radians(),
            blur: Some(Blur { threshold_m: 0.1, ..Blur::medium(4.0) }),
            fine_normals: false,
            exact_taps: false,
            bent_normals: true,
            cone: Some(ConeTrace::FILAMENT),
        };
        assert_eq!(OcclusionSettings::from_text(own)?, Some(expected));
        let horizons = "gtao:slices=2,steps=5,step-power=2,occluders=0.5";
        let occluders = Occluders::Thick(0.5);
        let method = Method::Gtao(Gtao { slices: 2, steps: 5, step_power: 2.0, occluders });
        assert_eq!(
            OcclusionSettings::from_text(horizons)?,
            Some(OcclusionSettings { method, ..OcclusionSettings::GTAO })
        );
        let named = |key: &&str| [own, horizons].iter().any(|text| text.contains(&format!("{key}=")));
        assert!(OcclusionSettings::KEYS.iter().all(named));
        Ok(())
    }

    #[test]
    fn wrong_words_are_named_in_one_line() {
        for (text, named) in [
            ("ssao", "ssao: "),
            ("sao:gloss=1", "gloss"),
            ("sao:radius=-1", "radius=-1"),
            ("sao:radius=NaN", "radius=NaN"),
            ("sao:taps=0", "taps=0"),
            ("sao:taps=2.5", "taps=2.5"),
            ("sao:quality=best", "quality=best"),
            ("sao:blur=off,threshold=1", "threshold=1"),
            ("sao:resolution", "resolution="),
            ("sao:slices=3", "slices: only `gtao`"),
            ("gtao:taps=3", "taps: only `sao`"),
            ("gtao:occluders=thin", "occluders=thin"),
            ("sao:cone=maybe", "cone=maybe"),
        ] {
            let told = OcclusionSettings::from_text(text).expect_err("that is no choice").to_string();
            assert!(told.contains(named) && !told.contains('\n'), "{text}: {told}");
        }
    }

    #[test]
    fn what_occludes_nothing_is_known() {
        assert!(OcclusionSettings::SAO.occludes());
        for text in ["sao:radius=0", "sao:intensity=0", "sao:power=0"] {
            let settings = OcclusionSettings::from_text(text);
            assert!(settings.is_ok_and(|s| s.is_some_and(|s| !s.occludes())), "{text}");
        }
    }
}
