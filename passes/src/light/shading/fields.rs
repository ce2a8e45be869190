//! Table of the settings of shading.

use super::{Irradiance, LightWindow, Quality, Shading, SpecularAa, TransmissionBlur};
use crate::light::ibl::EnvironmentFormat;
use crate::settings::field::{Field, choice, number, text};
use crate::settings::place::{Place, Words, flag, num, parsed, word};
use crate::settings::precision::Precision;
use crate::settings::table::SettingsTable;
use framegraph_scene::environment::{ShBands, ShWindow};
use framegraph_shaders::reference::dfg::Visibility;

impl Words for Quality {
    const WORDS: &'static [(&'static str, Self)] = &[("low", Self::Low), ("high", Self::High), ("ultra", Self::Ultra)];
}

impl Words for Precision {
    const WORDS: &'static [(&'static str, Self)] = &[("f32", Self::Full), ("f16", Self::Half)];
}

impl Words for Visibility {
    const WORDS: &'static [(&'static str, Self)] = &[("exact", Self::Exact), ("fast", Self::Fast)];
}

impl Words for ShBands {
    const WORDS: &'static [(&'static str, Self)] = &[("2", Self::Two), ("3", Self::Three), ("5", Self::Five)];
}

impl Words for Irradiance {
    const WORDS: &'static [(&'static str, Self)] = &[("harmonics", Self::Harmonics), ("cube", Self::Cube)];
}

impl Words for EnvironmentFormat {
    const WORDS: &'static [(&'static str, Self)] =
        &[("rg11b10", Self::Rg11b10), ("half", Self::Half), ("rgbm", Self::Rgbm)];
}

impl Words for TransmissionBlur {
    const WORDS: &'static [(&'static str, Self)] = &[("distance", Self::Distance), ("angle", Self::Angle)];
}

impl Words for LightWindow {
    const WORDS: &'static [(&'static str, Self)] = &[("gltf", Self::Gltf), ("filament", Self::Filament)];
}

/// Range of λ of the Laplacian window.
const LAMBDA: [f64; 2] = [0.0, 1.0];
/// Range of the footprint of specular anti-aliasing.
const VARIANCE: [f64; 2] = [1e-6, 1.0];

impl SettingsTable for Shading {
    const OPTION: &'static str = "shade";
    const PATH: &'static str = "settings.shading";
    const ABOUT: &'static str = "surface shading and image-based light; `quality` of the frame has the defaults";
    const DEFAULT: Self = Quality::High.shading();
    const METHODS: &'static [(&'static str, Self)] = &[];
    const FIELDS: &'static [Field<Self>] = &[
        choice("precision", "precision", |s: &mut Self| word(&mut s.precision))
            .about("numeric precision; f16 needs adapter support and raises the minimum roughness to 0.089"),
        text("visibility", "visibility", "`exact` or `fast`", &["exact", "fast"], set_visibility)
            .about("visibility term of the specular lobe; options also set its table"),
        choice("table", "table", |s: &mut Self| word(&mut s.table)).about("visibility term of the DFG table"),
        number("floor", "roughness_floor", [0.045, 1.0], |s: &mut Self| num(&mut s.roughness_floor))
            .about("minimum roughness"),
        choice("f90-fades", "f90_fades", |s: &mut Self| flag(&mut s.f90_fades))
            .about("fades reflectance at grazing angles for f0 below 0.02"),
        text(
            "compensation",
            "",
            "`on`, `off`, `image` or `punctual`",
            &["on", "off", "image", "punctual"],
            set_compensation,
        )
        .about("compensation of both kinds of light for the energy that single scattering loses"),
        choice("compensate-image", "compensate_image", |s: &mut Self| flag(&mut s.compensate_image))
            .about("compensates image-based light for the energy that single scattering loses"),
        choice("compensate-punctual", "compensate_punctual", |s: &mut Self| flag(&mut s.compensate_punctual))
            .about("compensates the sun and punctual lights for the energy that single scattering loses"),
        choice("bands", "bands", |s: &mut Self| word(&mut s.bands)).about("spherical harmonics bands of irradiance"),
        text(
            "window",
            "window",
            "`none`, `hann`, `sinc` or laplacian:LAMBDA from 0 to 1",
            &["none", "hann", "sinc", "laplacian:0.01"],
            set_window,
        )
        .about("windowing of the bands against ringing")
        .with(LAMBDA, |s: &mut Self| match &mut s.window {
            ShWindow::Laplacian { lambda } => num(lambda),
            ShWindow::None | ShWindow::Hann | ShWindow::Sinc => Place::Free,
        }),
        choice("irradiance", "irradiance", |s: &mut Self| word(&mut s.irradiance))
            .about("source of diffuse light: spherical harmonics, or the last level of the prefiltered environment"),
        choice("environment-format", "environment_format", |s: &mut Self| word(&mut s.environment_format))
            .about("storage format of the prefiltered environment"),
        text("aa", "specular_aa", "`on`, `off` or VARIANCE:THRESHOLD from 0 to 1", &["off", "on"], set_aa)
            .about("specular anti-aliasing: increases roughness by the variation of normals within a pixel"),
        number("aa-variance", "specular_aa.variance", VARIANCE, |s: &mut Self| aa(s, |aa| num(&mut aa.variance)))
            .about("footprint of a pixel"),
        number("aa-threshold", "specular_aa.threshold", [0.0, 1.0], |s: &mut Self| aa(s, |aa| num(&mut aa.threshold)))
            .about("maximum increase of alpha²"),
        choice("multi-bounce", "multi_bounce", |s: &mut Self| flag(&mut s.multi_bounce))
            .about("brightens ambient occlusion by light that bounces between surfaces"),
        choice("specular-occlusion", "specular_occlusion", |s: &mut Self| flag(&mut s.specular_occlusion))
            .about("occludes reflections of the environment by ambient occlusion"),
        choice("micro-shadows", "micro_shadows", |s: &mut Self| flag(&mut s.micro_shadows))
            .about("occludes the sun by the material's ambient occlusion"),
        choice("fast-coat", "fast_coat", |s: &mut Self| flag(&mut s.fast_coat))
            .about("approximates reflectance under a clear coat without a square root"),
        choice("coat-ior-change", "coat_ior_change", |s: &mut Self| flag(&mut s.coat_ior_change))
            .about("lowers the f0 of the base under a clear coat"),
        choice("transmission-blur", "transmission_blur", |s: &mut Self| word(&mut s.transmission_blur))
            .about("blur of the background behind rough refractive surfaces: by distance, or by an angle alone"),
        choice("light-window", "light_window", |s: &mut Self| word(&mut s.light_window))
            .about("window function that ends punctual lights at their range"),
        number("light-fade", "light_fade_m", [0.01, 1e9], |s: &mut Self| {
            Place::Optional(&mut s.light_fade_m, "off", 100.0)
        })
        .about("distance beyond which punctual lights are off"),
    ];
}

fn aa(s: &mut Shading, place: fn(&mut SpecularAa) -> Place<'_>) -> Place<'_> {
    s.specular_aa.as_mut().map_or(Place::Only("aa=on"), place)
}

fn set_visibility(s: &mut Shading, text: &str) -> Option<()> {
    word(&mut s.visibility).put(text, [0.0; 2])?;
    s.table = s.visibility;
    Some(())
}

fn set_compensation(s: &mut Shading, text: &str) -> Option<()> {
    (s.compensate_image, s.compensate_punctual) = match text {
        "on" => (true, true),
        "off" => (false, false),
        "image" => (true, false),
        "punctual" => (false, true),
        _ => return None,
    };
    Some(())
}

fn set_window(s: &mut Shading, text: &str) -> Option<()> {
    s.window = match text {
        "none" => ShWindow::None,
        "hann" => ShWindow::Hann,
        "sinc" => ShWindow::Sinc,
        _ => ShWindow::Laplacian { lambda: parsed(text.strip_prefix("laplacian:")?, LAMBDA, false)? },
    };
    Some(())
}

fn set_aa(s: &mut Shading, text: &str) -> Option<()> {
    s.specular_aa = match text {
        "off" => None,
        "on" => Some(SpecularAa::FILAMENT),
        _ => {
            let (variance, threshold) = text.split_once(':')?;
            let number = |text| Some(parsed(text, [0.0, 1.0], false)? as f32);
            let (variance, threshold) = (number(variance)?, number(threshold)?);
            (f64::from(variance) >= VARIANCE[0]).then_some(SpecularAa { variance, threshold })
        }
    };
    Some(())
}
