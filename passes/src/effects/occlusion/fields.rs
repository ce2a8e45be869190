//! Table of the settings of ambient occlusion.

use super::settings::{Blur, ConeTrace, Gtao, Method, Occluders, OcclusionSettings, SaoQuality};
use crate::settings::field::{Field, choice, number, text};
use crate::settings::place::{Place, Words, flag, num, parsed, switched, word};
use crate::settings::table::SettingsTable;

/// Range of the thickness of occluders, in meters.
const THICKNESS_M: [f64; 2] = [1e-3, 1e4];

impl SettingsTable for OcclusionSettings {
    const OPTION: &'static str = "ao";
    const PATH: &'static str = "settings.occlusion";
    const ABOUT: &'static str = "ambient occlusion: taps on a spiral (`sao`), or horizons in slices (`gtao`)";
    const DEFAULT: Self = Self::SAO;
    const METHODS: &'static [(&'static str, Self)] = &[("sao", Self::SAO), ("gtao", Self::GTAO)];
    const FIELDS: &'static [Field<Self>] = &[
        text("method", "method", "`sao` or `gtao`", &["sao", "gtao"], set_method)
            .about("method alone; other fields keep their values"),
        text("quality", "", "`low`, `medium`, `high` or `ultra`", &["low", "medium", "high", "ultra"], set_quality)
            .about("preset of SAO: taps, turns and blur")
            .with([0.0; 2], |s: &mut Self| sao(s, |_| Place::Free)),
        number("taps", "method.taps", [1.0, 64.0], |s: &mut Self| sao(s, |[taps, _]| num(taps)))
            .about("number of taps"),
        number("turns", "method.turns", [0.0, 64.0], |s: &mut Self| sao(s, |[_, turns]| num(turns)))
            .about("turns of the spiral"),
        number("slices", "method.slices", [1.0, 16.0], |s: &mut Self| gtao(s, |g| num(&mut g.slices)))
            .about("number of slices"),
        number("steps", "method.steps", [1.0, 32.0], |s: &mut Self| gtao(s, |g| num(&mut g.steps)))
            .about("steps on each side of a slice"),
        number("step-power", "method.step_power", [0.1, 10.0], |s: &mut Self| gtao(s, |g| num(&mut g.step_power)))
            .about("exponent of the step distribution: 1 is even, more is denser near the center"),
        text(
            "occluders",
            "method.occluders",
            "`solid`, `fading` or a thickness from 0.001 to 10000",
            &["solid", "fading", "0.2"],
            set_occluders,
        )
        .about("falloff of occluders with distance, or their thickness in meters")
        .with(THICKNESS_M, |s: &mut Self| gtao(s, thickness)),
        choice("resolution", "resolution", |s: &mut Self| word(&mut s.resolution))
            .about("resolution of structure and occlusion"),
        number("radius", "radius_m", [0.0, 1e4], |s: &mut Self| num(&mut s.radius_m))
            .about("maximum distance of occluders"),
        number("bias", "bias", [0.0, 1.0], |s: &mut Self| num(&mut s.bias))
            .about("height above the tangent plane that does not occlude, relative to the distance from the eye"),
        number("intensity", "intensity", [0.0, 16.0], |s: &mut Self| num(&mut s.intensity))
            .about("strength of occlusion"),
        number("power", "power", [0.0, 16.0], |s: &mut Self| num(&mut s.power)).about("exponent of visibility"),
        number("horizon", "min_horizon_rad", [0.0, 90.0], |s: &mut Self| Place::Degrees(&mut s.min_horizon_rad))
            .about("minimum angle above the tangent plane that occludes; hides self-occlusion of coarse meshes"),
        text("blur", "blur", "`off`, `low`, `medium` or `high`", &["off", "low", "high", "medium"], set_blur)
            .about("bilateral blur: `low` reads 7 texels, `medium` every second of 21, `high` 23"),
        number("blur-reach", "blur.reach", [1.0, 12.0], |s: &mut Self| blur(s, |b| num(&mut b.reach)))
            .about("samples on each side"),
        number("blur-stride", "blur.stride", [1.0, 16.0], |s: &mut Self| blur(s, |b| num(&mut b.stride)))
            .about("distance between samples in texels"),
        number("blur-sigma", "blur.sigma", [0.1, 100.0], |s: &mut Self| blur(s, |b| num(&mut b.sigma)))
            .about("standard deviation in samples"),
        number("threshold", "blur.threshold_m", [1e-6, 1e4], |s: &mut Self| blur(s, |b| num(&mut b.threshold_m)))
            .about("distance from which on surfaces do not blur into each other"),
        choice("normals", "fine_normals", |s: &mut Self| Place::Switch(&mut s.fine_normals, ["coarse", "fine"]))
            .about("derives normals from the nearer of two texels on each side (`fine`), or from the next texel"),
        choice("place", "exact_taps", |s: &mut Self| Place::Switch(&mut s.exact_taps, ["filament", "exact"]))
            .about("evaluates a tap at the position of its depth (`exact`), or at the position of the method"),
        choice("bent-normals", "bent_normals", |s: &mut Self| flag(&mut s.bent_normals))
            .about("computes bent normals for specular occlusion"),
        text("cone", "cone", "`on` or `off`", &["off", "on"], set_cone)
            .about("contact shadows of the dominant light by cone tracing"),
        number("cone-reach", "cone.reach_m", [0.0, 1e4], |s: &mut Self| cone(s, |c| num(&mut c.reach_m)))
            .about("length of a cone"),
        number("cone-angle", "cone.angle_rad", [0.0, 179.0], |s: &mut Self| {
            cone(s, |c| Place::Degrees(&mut c.angle_rad))
        })
        .about("apex angle"),
        number("cone-contact", "cone.contact_m", [0.0, 1e4], |s: &mut Self| cone(s, |c| num(&mut c.contact_m)))
            .about("maximum distance of an occluder in front of a cone"),
        number("cone-bias", "cone.bias_m", [0.0, 100.0], |s: &mut Self| cone(s, |c| num(&mut c.bias_m)))
            .about("minimum size of an occluder within a slice"),
        number("cone-slope-bias", "cone.slope_bias_m", [0.0, 100.0], |s: &mut Self| {
            cone(s, |c| num(&mut c.slope_bias_m))
        })
        .about("additional bias of surfaces edge-on to the light"),
        number("cone-intensity", "cone.intensity", [0.0, 1.0], |s: &mut Self| cone(s, |c| num(&mut c.intensity)))
            .about("strength of the contact shadow"),
        number("cone-steps", "cone.steps", [1.0, 256.0], |s: &mut Self| cone(s, |c| num(&mut c.steps)))
            .about("slices per cone"),
        number("cone-rays", "cone.rays", [1.0, 64.0], |s: &mut Self| cone(s, |c| num(&mut c.rays)))
            .about("number of cones"),
    ];
}

fn sao(s: &mut OcclusionSettings, place: fn([&mut u32; 2]) -> Place<'_>) -> Place<'_> {
    match &mut s.method {
        Method::Sao { taps, turns } => place([taps, turns]),
        Method::Gtao(_) => Place::Only("sao"),
    }
}

fn gtao(s: &mut OcclusionSettings, place: fn(&mut Gtao) -> Place<'_>) -> Place<'_> {
    match &mut s.method {
        Method::Gtao(gtao) => place(gtao),
        Method::Sao { .. } => Place::Only("gtao"),
    }
}

fn thickness(gtao: &mut Gtao) -> Place<'_> {
    match &mut gtao.occluders {
        Occluders::Thick(thickness_m) => num(thickness_m),
        Occluders::Solid | Occluders::Fading => Place::Free,
    }
}

fn blur(s: &mut OcclusionSettings, place: fn(&mut Blur) -> Place<'_>) -> Place<'_> {
    s.blur.as_mut().map_or(Place::Only("blur=medium"), place)
}

fn cone(s: &mut OcclusionSettings, place: fn(&mut ConeTrace) -> Place<'_>) -> Place<'_> {
    s.cone.as_mut().map_or(Place::Only("cone=on"), place)
}

fn set_method(s: &mut OcclusionSettings, text: &str) -> Option<()> {
    s.method = OcclusionSettings::METHODS.iter().find(|(name, _)| *name == text)?.1.method;
    Some(())
}

fn set_quality(s: &mut OcclusionSettings, text: &str) -> Option<()> {
    let (_, quality) = SaoQuality::WORDS.iter().find(|(name, _)| *name == text)?;
    let preset = OcclusionSettings::sao(*quality);
    (s.method, s.blur) = (preset.method, preset.blur);
    Some(())
}

fn set_occluders(s: &mut OcclusionSettings, text: &str) -> Option<()> {
    let Method::Gtao(gtao) = &mut s.method else { return None };
    gtao.occluders = match text {
        "solid" => Occluders::Solid,
        "fading" => Occluders::Fading,
        _ => Occluders::Thick(parsed(text, THICKNESS_M, false)? as f32),
    };
    Some(())
}

fn set_blur(s: &mut OcclusionSettings, text: &str) -> Option<()> {
    let threshold_m = s.blur.map_or(Blur::high(1.0).threshold_m, |blur| blur.threshold_m);
    let sigma = s.blur.map_or(SaoQuality::Low.sigma(), |blur| blur.sigma * blur.stride as f32);
    s.blur = match text {
        "off" => None,
        "low" => Some(Blur { threshold_m, ..Blur::LOW }),
        "medium" => Some(Blur { threshold_m, ..Blur::medium(sigma) }),
        "high" => Some(Blur { threshold_m, ..Blur::high(sigma) }),
        _ => return None,
    };
    Some(())
}

fn set_cone(s: &mut OcclusionSettings, text: &str) -> Option<()> {
    s.cone = switched(text)?.then_some(ConeTrace::FILAMENT);
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::depth::structure::Resolution;
    use crate::settings::key_value::OptionError;

    #[test]
    fn the_table_describes_the_settings() {
        crate::settings::table::test::<OcclusionSettings>();
    }

    #[test]
    fn fields_are_set_by_name() -> Result<(), OptionError> {
        assert_eq!(OcclusionSettings::from_text("off")?, None);
        for (name, quality) in SaoQuality::WORDS {
            let asked = OcclusionSettings::from_text(&format!("sao:quality={name}"))?;
            assert_eq!(asked, Some(OcclusionSettings::sao(*quality)));
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
            min_horizon_rad: 30.0_f32.to_radians(),
            blur: Some(Blur { threshold_m: 0.1, ..Blur::medium(4.0) }),
            fine_normals: false,
            exact_taps: false,
            bent_normals: true,
            cone: Some(ConeTrace::FILAMENT),
        };
        assert_eq!(OcclusionSettings::from_text(own)?, Some(expected));
        let thick = Gtao { slices: 2, steps: 5, step_power: 2.0, occluders: Occluders::Thick(0.5) };
        assert_eq!(
            OcclusionSettings::from_text("gtao:slices=2,steps=5,step-power=2,occluders=0.5")?,
            Some(OcclusionSettings { method: Method::Gtao(thick), ..OcclusionSettings::GTAO })
        );
        Ok(())
    }

    #[test]
    fn errors_name_the_value_and_the_remedy() {
        for (text, named) in [
            ("ssao", "ssao: unknown choice; did you mean `sao`?"),
            ("vxao:x=1", "vxao: unknown choice; there are off, sao, gtao"),
            ("sao:radious=1", "radious: unknown choice; did you mean `radius`?"),
            ("sao:radius=-1", "radius=-1: expected a number from 0 to 10000"),
            ("sao:taps=0", "taps=0: expected a whole number from 1 to 64"),
            ("sao:taps=2.5", "taps=2.5"),
            ("sao:quality=best", "quality=best"),
            ("sao:blur=off,threshold=1", "threshold: only `blur=medium` has it"),
            ("sao:resolution", "resolution=: expected `full` or `half`"),
            ("sao:slices=3", "slices: only `gtao`"),
            ("gtao:taps=3", "taps: only `sao`"),
            ("gtao:quality=low", "quality: only `sao`"),
            ("gtao:occluders=thin", "occluders=thin"),
            ("sao:cone=maybe", "cone=maybe"),
        ] {
            let error = OcclusionSettings::from_text(text).expect_err(text).to_string();
            assert!(error.contains(named) && !error.contains('\n'), "{text}: {error}");
        }
    }

    #[test]
    fn settings_that_occlude_nothing_are_known() {
        assert!(OcclusionSettings::SAO.occludes());
        for text in ["sao:radius=0", "sao:intensity=0", "sao:power=0"] {
            let settings = OcclusionSettings::from_text(text);
            assert!(settings.is_ok_and(|s| s.is_some_and(|s| !s.occludes())), "{text}");
        }
    }
}
