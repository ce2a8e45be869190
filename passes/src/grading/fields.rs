//! Table of the settings of looks, and parsing of tone curves, such as `aces` or `generic:1.5:0.18:0.2:8`.

use super::look::Look;
use crate::settings::field::{Field, choice, number, text};
use crate::settings::key_value::OptionError;
use crate::settings::place::{Place, flag, num, vector};
use crate::settings::table::{SettingsTable, unknown};
use framegraph_shaders::layout::{GenericCurve, ToneMap};

/// Range of light, offsets and slopes.
const ANY: [f64; 2] = [-1000.0, 1000.0];
/// Range of light, offsets and slopes that are not negative.
const POSITIVE: [f64; 2] = [0.0, 1000.0];
/// Range of shares in the channel mixer.
const MIXER: [f64; 2] = [-2.0, 2.0];
/// Range of the numbers of the generic tone curve.
const CURVE: [f64; 2] = [1e-5, 65504.0];

impl SettingsTable for Look {
    const OPTION: &'static str = "grade";
    const PATH: &'static str = "settings.post.look";
    const ABOUT: &'static str = "color grading in Filament's order, and the tone curve";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[];
    const FIELDS: &'static [Field<Self>] = &[
        number("exposure", "grading.exposure_ev", [-16.0, 16.0], |s: &mut Self| num(&mut s.grading.exposure_ev))
            .about("exposure"),
        number("night", "grading.night", [0.0, 1.0], |s: &mut Self| num(&mut s.grading.night))
            .about("night adaptation: dark colors shift toward blue"),
        number("temperature", "grading.temperature", [-1.0, 1.0], |s: &mut Self| num(&mut s.grading.temperature))
            .about("white balance from blue to amber"),
        number("tint", "grading.tint", [-1.0, 1.0], |s: &mut Self| num(&mut s.grading.tint))
            .about("white balance from green to magenta"),
        number("mixer-red", "grading.mixer.0", MIXER, |s: &mut Self| vector(&mut s.grading.mixer[0]))
            .about("output red"),
        number("mixer-green", "grading.mixer.1", MIXER, |s: &mut Self| vector(&mut s.grading.mixer[1]))
            .about("output green"),
        number("mixer-blue", "grading.mixer.2", MIXER, |s: &mut Self| vector(&mut s.grading.mixer[2]))
            .about("output blue"),
        number("shadows", "grading.shadows", ANY, |s: &mut Self| vector(&mut s.grading.shadows))
            .about("factors and an offset"),
        number("midtones", "grading.midtones", ANY, |s: &mut Self| vector(&mut s.grading.midtones))
            .about("factors and an offset"),
        number("highlights", "grading.highlights", ANY, |s: &mut Self| vector(&mut s.grading.highlights))
            .about("factors and an offset"),
        number("ranges", "grading.ranges", [0.0, 1.0], |s: &mut Self| vector(&mut s.grading.ranges))
            .about("luminance: end of shadows, begin of midtones, end of midtones, begin of highlights"),
        number("slope", "grading.slope", POSITIVE, |s: &mut Self| vector(&mut s.grading.slope))
            .about("factor on LogC values"),
        number("offset", "grading.offset", ANY, |s: &mut Self| vector(&mut s.grading.offset))
            .about("added to LogC values"),
        number("power", "grading.power", POSITIVE, |s: &mut Self| vector(&mut s.grading.power))
            .about("exponent of LogC values"),
        number("contrast", "grading.contrast", [0.0, 2.0], |s: &mut Self| num(&mut s.grading.contrast))
            .about("contrast in LogC"),
        number("vibrance", "grading.vibrance", [0.0, 2.0], |s: &mut Self| num(&mut s.grading.vibrance))
            .about("saturation of pale colors"),
        number("saturation", "grading.saturation", [0.0, 2.0], |s: &mut Self| num(&mut s.grading.saturation))
            .about("saturation"),
        number("shadow-gamma", "grading.shadow_gamma", POSITIVE, |s: &mut Self| vector(&mut s.grading.shadow_gamma))
            .about("exponent below the middle of the curves"),
        number("mid-point", "grading.middle", POSITIVE, |s: &mut Self| vector(&mut s.grading.middle))
            .about("middle of the curves"),
        number("highlight-scale", "grading.highlight_scale", ANY, |s: &mut Self| {
            vector(&mut s.grading.highlight_scale)
        })
        .about("slope above the middle of the curves"),
        choice("luminance-scaling", "luminance_scaling", |s: &mut Self| flag(&mut s.luminance_scaling))
            .about("applies the tone curve to luminance only, which keeps hues"),
        choice("gamut-mapping", "gamut_mapping", |s: &mut Self| flag(&mut s.gamut_mapping))
            .about("moves colors outside the display's gamut into it at the same hue, instead of clipping"),
        text("tone-map", "tone_map", "the name of a tone curve", &CURVES, |s: &mut Self, text| {
            s.tone_map = tone_map(text).ok()?;
            Some(())
        })
        .about("tone curve"),
        number("curve-contrast", "tone_map.contrast", CURVE, |s: &mut Self| generic(s, |c| num(&mut c.contrast)))
            .about("contrast"),
        number("curve-in", "tone_map.middle_in", CURVE, |s: &mut Self| generic(s, |c| num(&mut c.middle_in)))
            .about("middle gray"),
        number("curve-out", "tone_map.middle_out", CURVE, |s: &mut Self| generic(s, |c| num(&mut c.middle_out)))
            .about("output at middle gray"),
        number("curve-white", "tone_map.white", CURVE, |s: &mut Self| generic(s, |c| num(&mut c.white)))
            .about("brightest light"),
    ];
}

fn generic(s: &mut Look, place: fn(&mut GenericCurve) -> Place<'_>) -> Place<'_> {
    match &mut s.tone_map {
        ToneMap::Generic(own) => place(own),
        _ => Place::Only("tone-map=generic"),
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
        return ToneMap::from_name(text).ok_or_else(|| unknown(text, CURVES.into_iter()));
    };
    let mut all = [0.0; 4];
    let takes = Place::Numbers(&mut all).takes(CURVE);
    let wrong = || OptionError::Value { key: "generic".into(), value: own.to_owned(), takes };
    Place::Numbers(&mut all).put(own, CURVE).ok_or_else(wrong)?;
    let [contrast, middle_in, middle_out, white] = all;
    Ok(ToneMap::Generic(GenericCurve { contrast, middle_in, middle_out, white }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn fields_are_set_by_name() -> Result<(), OptionError> {
        crate::settings::table::test::<Look>();
        let mut look = Look::default();
        look.set_all("slope=0.5:0.25:0.125,gamut-mapping=on")?;
        assert_eq!((look.grading.slope, look.gamut_mapping), (Vec3::new(0.5, 0.25, 0.125), true));
        look.set("slope", "2")?;
        assert_eq!(look.grading.slope, Vec3::splat(2.0));
        let generic = ToneMap::Generic(GenericCurve { contrast: 1.5, middle_in: 0.18, middle_out: 0.2, white: 8.0 });
        assert_eq!(tone_map("generic:1.5:0.18:0.2:8")?, generic);
        assert_eq!(tone_map("agx-golden")?, ToneMap::AgxGolden);
        for (key, value, named) in [
            ("hue", "1", "hue: unknown choice; there are exposure, night"),
            ("contrast", "3", "contrast=3: expected a number from 0 to 2"),
            ("slope", "1:2", "slope=1:2: expected 3 numbers from 0 to 1000, separated by `:`"),
            ("shadows", "1", "shadows=1: expected 4 numbers"),
            ("gamut-mapping", "yes", "gamut-mapping=yes: expected `on` or `off`"),
        ] {
            let error = look.set(key, value).expect_err(key).to_string();
            assert!(error.contains(named) && !error.contains('\n'), "{error}");
        }
        for (text, named) in [("sepia", "linear, hill"), ("generic:1:2", "4 numbers"), ("own", "unknown")] {
            let error = tone_map(text).expect_err(text).to_string();
            assert!(error.contains(named), "{error}");
        }
        Ok(())
    }
}
