//! Option parsing of looks, such as `contrast=1.2` or `shadows=1.2:1:1:0.05`, and of tone curves, such as `aces` or
//! `generic:1.5:0.18:0.2:8`.

use super::look::Look;
use crate::settings::key_value::{KeyValue, OptionError};
use framegraph_shaders::layout::{GenericCurve, ToneMap};
use glam::{Vec3, Vec4};

/// Limit of light, offsets and slopes.
const MOST: f32 = 1000.0;

/// Setting to change, with its limits.
enum Place<'a> {
    Number(&'a mut f32, f32, f32),
    Three(&'a mut Vec3, f32, f32),
    Four(&'a mut Vec4, f32, f32),
    Switch(&'a mut bool),
}

impl Look {
    /// Names accepted by [`Look::set`], in the order in which their effects are applied.
    pub const KEYS: [&'static str; 22] = [
        "exposure",
        "night",
        "temperature",
        "tint",
        "mixer-red",
        "mixer-green",
        "mixer-blue",
        "shadows",
        "midtones",
        "highlights",
        "ranges",
        "slope",
        "offset",
        "power",
        "contrast",
        "vibrance",
        "saturation",
        "shadow-gamma",
        "mid-point",
        "highlight-scale",
        "luminance-scaling",
        "gamut-mapping",
    ];

    fn place(&mut self, key: &str) -> Option<Place<'_>> {
        let g = &mut self.grading;
        Some(match key {
            "exposure" => Place::Number(&mut g.exposure_ev, -16.0, 16.0),
            "night" => Place::Number(&mut g.night, 0.0, 1.0),
            "temperature" => Place::Number(&mut g.temperature, -1.0, 1.0),
            "tint" => Place::Number(&mut g.tint, -1.0, 1.0),
            "mixer-red" => Place::Three(&mut g.mixer[0], -2.0, 2.0),
            "mixer-green" => Place::Three(&mut g.mixer[1], -2.0, 2.0),
            "mixer-blue" => Place::Three(&mut g.mixer[2], -2.0, 2.0),
            "shadows" => Place::Four(&mut g.shadows, -MOST, MOST),
            "midtones" => Place::Four(&mut g.midtones, -MOST, MOST),
            "highlights" => Place::Four(&mut g.highlights, -MOST, MOST),
            "ranges" => Place::Four(&mut g.ranges, 0.0, 1.0),
            "slope" => Place::Three(&mut g.slope, 0.0, MOST),
            "offset" => Place::Three(&mut g.offset, -MOST, MOST),
            "power" => Place::Three(&mut g.power, 0.0, MOST),
            "contrast" => Place::Number(&mut g.contrast, 0.0, 2.0),
            "vibrance" => Place::Number(&mut g.vibrance, 0.0, 2.0),
            "saturation" => Place::Number(&mut g.saturation, 0.0, 2.0),
            "shadow-gamma" => Place::Three(&mut g.shadow_gamma, 0.0, MOST),
            "mid-point" => Place::Three(&mut g.middle, 0.0, MOST),
            "highlight-scale" => Place::Three(&mut g.highlight_scale, -MOST, MOST),
            "luminance-scaling" => Place::Switch(&mut self.luminance_scaling),
            "gamut-mapping" => Place::Switch(&mut self.gamut_mapping),
            _ => return None,
        })
    }

    /// Changes one setting by name. Colors are numbers separated by `:`; one number sets all three channels.
    ///
    /// # Errors
    /// Fails for an unknown name or an invalid value; the [`OptionError`] names it and the accepted values.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), OptionError> {
        let choice = KeyValue { key, value };
        match self.place(key) {
            Some(Place::Number(place, low, high)) => *place = choice.number(low, high)?,
            Some(Place::Three(place, low, high)) => {
                *place = match value.contains(':') {
                    true => choice.numbers(low, high)?.into(),
                    false => Vec3::splat(choice.number(low, high)?),
                }
            }
            Some(Place::Four(place, low, high)) => *place = choice.numbers(low, high)?.into(),
            Some(Place::Switch(place)) => *place = choice.switch()?,
            None => return Err(choice.unknown(&Self::KEYS)),
        }
        Ok(())
    }
}

/// Names of the tone curves.
const CURVES: [&str; ToneMap::ALL.len()] = {
    let mut names = [""; ToneMap::ALL.len()];
    let mut index = 0;
    while index < names.len() {
        names[index] = ToneMap::ALL[index].name();
        index += 1;
    }
    names
};

/// Parses the name of a tone curve, or `generic:CONTRAST:IN:OUT:WHITE`.
///
/// # Errors
/// Fails for an unknown name or invalid numbers; the [`OptionError`] lists the curves or the accepted numbers.
pub fn tone_map(text: &str) -> Result<ToneMap, OptionError> {
    let Some(own) = text.strip_prefix("generic:") else {
        return ToneMap::from_name(text).ok_or_else(|| KeyValue { key: text, value: "" }.unknown(&CURVES));
    };
    let [contrast, middle_in, middle_out, white] = KeyValue { key: "generic", value: own }.numbers(1e-5, 65504.0)?;
    Ok(ToneMap::Generic(GenericCurve { contrast, middle_in, middle_out, white }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_shaders::layout::Grading;

    #[test]
    fn every_choice_is_made_by_name() -> Result<(), OptionError> {
        let mut look = Look::default();
        for key in Look::KEYS {
            let before = look;
            let value = match look.place(key) {
                Some(Place::Number(..)) => "0.25",
                Some(Place::Three(..)) => "0.5:0.25:0.125",
                Some(Place::Four(..)) => "0.5:0.25:0.125:0.75",
                Some(Place::Switch(_)) => "on",
                None => panic!("{key}"),
            };
            look.set(key, value)?;
            assert_ne!(look, before, "{key}");
        }
        assert_eq!(look.grading.slope, Vec3::new(0.5, 0.25, 0.125));
        look.set("slope", "2")?;
        assert_eq!(look.grading.slope, Vec3::splat(2.0));
        assert_ne!(look.grading, Grading::NEUTRAL);
        let generic = ToneMap::Generic(GenericCurve { contrast: 1.5, middle_in: 0.18, middle_out: 0.2, white: 8.0 });
        assert_eq!(tone_map("generic:1.5:0.18:0.2:8")?, generic);
        assert_eq!(tone_map("agx-golden")?, ToneMap::AgxGolden);
        Ok(())
    }

    #[test]
    fn wrong_words_are_named_in_one_line() {
        for (key, value, told) in [
            ("hue", "1", "hue: unknown choice; there are exposure, night"),
            ("contrast", "3", "contrast=3: a number from 0 to 2 is needed"),
            ("contrast", "NaN", "contrast=NaN"),
            ("slope", "1:2", "slope=1:2: 3 numbers separated by `:`, from 0 to 1000, are needed"),
            ("shadows", "1", "shadows=1: 4 numbers"),
            ("gamut-mapping", "yes", "gamut-mapping=yes: `on` or `off` is needed"),
        ] {
            let error = Look::default().set(key, value).expect_err(key).to_string();
            assert!(error.contains(told) && !error.contains('\n'), "{error}");
        }
        for (text, told) in [("sepia", "linear, hill"), ("generic:1:2", "4 numbers"), ("own", "unknown")] {
            let error = tone_map(text).expect_err(text).to_string();
            assert!(error.contains(told), "{error}");
        }
    }
}
