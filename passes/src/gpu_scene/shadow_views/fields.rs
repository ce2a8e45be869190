//! Table of the settings of shadow maps.

use super::settings::{ContactShadows, Fit, MAX_CASCADES, MAX_MAPS, ShadowFilter, ShadowSettings, Splits};
use crate::settings::field::{Field, choice, number, text};
use crate::settings::place::{Place, Words, flag, num, parsed, word};
use crate::settings::table::SettingsTable;

impl Words for ShadowFilter {
    const WORDS: &'static [(&'static str, Self)] =
        &[("pcf", Self::Pcf), ("dpcf", Self::Dpcf), ("pcss", Self::Pcss), ("vsm", Self::Vsm), ("evsm", Self::Evsm)];
}

impl Words for Fit {
    const WORDS: &'static [(&'static str, Self)] =
        &[("lispsm", Self::Tight { lispsm: true }), ("tight", Self::Tight { lispsm: false }), ("stable", Self::Stable)];
}

/// Range of shares.
const SHARE: [f64; 2] = [0.0, 1.0];
/// Range of the number of steps of contact shadows.
const STEPS: [f64; 2] = [1.0, 256.0];
/// Range of the length of contact shadows, in meters.
const CONTACT_M: [f64; 2] = [0.001, 100.0];

impl SettingsTable for ShadowSettings {
    const OPTION: &'static str = "shadow";
    const PATH: &'static str = "settings.shadows";
    const ABOUT: &'static str = "shadow maps of the sun and of punctual lights";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[("on", Self::DEFAULT)];
    const FIELDS: &'static [Field<Self>] = &[
        number("map-size", "map_texels", [16.0, 16384.0], |s: &mut Self| num(&mut s.map_texels))
            .about("side of a layer: of a cascade, and of the largest map of a punctual light")
            .former("texels"),
        choice("filter", "filter", |s: &mut Self| word(&mut s.filter))
            .about("3×3 tent, variable penumbrae (DPCF, PCSS), or 16- or 32-bit moments (VSM, EVSM)"),
        number("cascades", "cascades", [0.0, MAX_CASCADES as f64], |s: &mut Self| num(&mut s.cascades))
            .about("number of cascades of the sun; with 0 it casts no shadows"),
        text(
            "splits",
            "splits",
            "`uniform`, `log`, `practical:L` or A:B:C from 0 to 1",
            &["uniform", "log", "practical:0.8", "0.125:0.25:0.5"],
            set_splits,
        )
        .about("split distances between cascades, relative to the range"),
        choice("fit", "fit", |s: &mut Self| word(&mut s.fit))
            .about("fit of the sun's maps: visible receivers, with or without a warp, or whole texels of a sphere"),
        number("far", "far_m", [0.01, 1e7], |s: &mut Self| Place::Optional(&mut s.far_m, "none", 50.0))
            .about("greatest distance of the sun's shadows from the eye, toward which they fade"),
        number("constant-bias", "bias.constant_m", [0.0, 10.0], |s: &mut Self| num(&mut s.bias.constant_m))
            .about("offset of casters away from the light"),
        number("normal-bias", "bias.normal", [0.0, 100.0], |s: &mut Self| num(&mut s.bias.normal))
            .about("offset of receivers along their normals at grazing light, in half texels"),
        number("slope-bias", "bias.slope", [0.0, 100.0], |s: &mut Self| num(&mut s.bias.slope))
            .about("slope-scaled polygon offset of casters"),
        number("bias-steps", "bias.steps", [-1e6, 1e6], |s: &mut Self| num(&mut s.bias.steps))
            .about("constant polygon offset of casters, in steps of depth"),
        number("bulb", "bulb_m", [1e-6, 1e3], |s: &mut Self| Place::Optional(&mut s.bulb_m, "disc", 0.1))
            .about("radius of the light for penumbrae; `disc` derives it from the light's own size"),
        number("blur", "moments.blur_texels", [0.0, 125.0], |s: &mut Self| num(&mut s.moments.blur_texels))
            .about("width of the Gaussian blur of moments"),
        number("levels", "moments.levels", [1.0, 8.0], |s: &mut Self| num(&mut s.moments.levels))
            .about("mip levels of moments"),
        choice("samples", "moments.samples", |s: &mut Self| Place::Count(&mut s.moments.samples, &[1, 4]))
            .about("samples per texel of moments"),
        number("min-variance", "moments.min_variance_scale", [0.0, 1e3], |s: &mut Self| {
            num(&mut s.moments.min_variance_scale)
        })
        .about("minimum variance of moments, scaled as in Filament"),
        number("bleed", "moments.bleed", [0.0, 0.99], |s: &mut Self| num(&mut s.moments.bleed))
            .about("light bleeding reduction: lighter shadows than this fraction become black"),
        text("contact", "contact", "`on`, `off` or STEPS:M", &["off", "on"], set_contact)
            .about("contact shadows of the sun: short rays through the depth of the picture"),
        number("contact-steps", "contact.steps", STEPS, |s: &mut Self| contact(s, |c| num(&mut c.steps)))
            .about("steps along the ray"),
        number("contact-distance", "contact.distance_m", CONTACT_M, |s: &mut Self| {
            contact(s, |c| num(&mut c.distance_m))
        })
        .about("length of the ray"),
        number("punctual", "local_maps", [0.0, MAX_MAPS as f64], |s: &mut Self| num(&mut s.local_maps))
            .about("maximum number of maps of punctual lights; with the cascades at most 64")
            .former("local"),
        number("layers", "local_layers", [1.0, MAX_MAPS as f64], |s: &mut Self| num(&mut s.local_layers))
            .about("maximum number of texture layers for maps of punctual lights"),
        choice("show-cascades", "show_cascades", |s: &mut Self| flag(&mut s.show_cascades))
            .about("tints lit surfaces by their cascade"),
    ];
}

fn contact(s: &mut ShadowSettings, place: fn(&mut ContactShadows) -> Place<'_>) -> Place<'_> {
    s.contact.as_mut().map_or(Place::Only("contact=on"), place)
}

fn set_splits(s: &mut ShadowSettings, text: &str) -> Option<()> {
    let share = |text: &str| parsed(text, SHARE, false);
    s.splits = match text.split(':').collect::<Vec<_>>()[..] {
        ["uniform"] => Splits::Uniform,
        ["log"] => Splits::Logarithmic,
        ["practical", lambda] => Splits::Practical(share(lambda)?),
        [a, b, c] => Splits::At([share(a)?, share(b)?, share(c)?]),
        _ => return None,
    };
    Some(())
}

fn set_contact(s: &mut ShadowSettings, text: &str) -> Option<()> {
    s.contact = match (text, text.split_once(':')) {
        ("off", _) => None,
        ("on", _) => Some(ContactShadows::FILAMENT),
        (_, Some((steps, distance_m))) => Some(ContactShadows {
            steps: parsed(steps, STEPS, true)? as u32,
            distance_m: parsed(distance_m, CONTACT_M, false)? as f32,
        }),
        _ => return None,
    };
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_describes_the_settings() {
        crate::settings::table::test::<ShadowSettings>();
        let mut own = ShadowSettings::DEFAULT;
        assert_eq!(own.set_all("texels=64,local=3,splits=practical:0.5,contact=4:0.1"), Ok(()));
        let contact = Some(ContactShadows { steps: 4, distance_m: 0.1 });
        let splits = Splits::Practical(0.5);
        assert_eq!(own, ShadowSettings { local_maps: 3, splits, contact, ..ShadowSettings::texels(64) });
    }
}
