//! Options of the environment, the sun, the background and the exposure.

use framegraph_scene::SunHalo;
use framegraph_scene::camera::{EV100_RANGE, ev100_from_settings};
use glam::DVec3;
use program::clap::Arg;
use program::cli::{Item, option};
use std::ffi::OsString;
use std::path::PathBuf;

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let all = vec![
        option(
            "environment",
            "FILE",
            "Environment light from an equirectangular .hdr or .exr picture, or a cube map in .ktx or .ktx2; or \
             uniform:R,G,B for constant radiance in nits, linear Rec.709; default: a clear sky with its sun. A sun \
             in the picture is extracted into a directional light that casts shadows. A prefiltered cube map with \
             irradiance (NAME_ibl.ktx of Filament's cmgen) is used as it is",
        ),
        option(
            "ibl-intensity",
            "X",
            "Factor on the environment light and on the visible environment or sky; metering ignores it (1)",
        ),
        option(
            "sun",
            "X,Y,Z:LUX[:ANGLE]",
            "Replace the sun by a white one: X,Y,Z is the direction toward it, of any length, LUX the illuminance \
             on a surface that faces it, ANGLE the diameter of its disc in degrees (0.533). A clear sky follows a \
             sun above the horizon. `off` removes the sun of the environment and all directional lights of the \
             scene; `in-map` keeps a sun in the environment picture as bright texels",
        ),
        option(
            "sun-disk",
            "on|off|SIZE:FALLOFF",
            "Draw the sun's disk and halo behind the scene, as Filament's skybox with showSun. SIZE is the halo's \
             radius relative to the disk, FALLOFF its exponent (10:80); default: as the scene's lights state",
        ),
        option(
            "background",
            "COLOR",
            "Visible background; the environment still lights the scene. R,G,B is constant radiance in nits, linear \
             Rec.709, exposed like the scene and not reflected; sky is the clear sky",
        ),
        option("ev100", "X", "Exposure value at ISO 100; default: metered from the light"),
        option(
            "exposure",
            "X",
            "Exposure value as --ev100, or camera settings APERTURE,SHUTTER,ISO: f-number, seconds (also 1/125), \
             ISO; 16,1/125,100 is EV 15",
        ),
        option(
            "lights",
            "METHOD[:KEY=X,...]",
            "How shading finds punctual lights: froxels (clustered light lists), all (loop over every light; same \
             picture), or auto (froxels for 4 or more lights of limited range; default). `--lights help` lists the \
             keys",
        ),
    ];
    all.into_iter().map(|option| option.help_heading("Lighting")).collect()
}

/// Apparent diameter of the sun seen from Earth, in degrees.
const SOLAR_DIAMETER_DEG: f64 = 0.533;
/// Maximum radiance and illuminance. It exceeds the sun's disc and keeps sums finite in f32.
const MAX: f64 = 1e10;

/// Source of the environment light.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum EnvironmentSource {
    /// Clear sky.
    #[default]
    Sky,
    /// Equirectangular picture or cube map.
    File(PathBuf),
    /// Constant radiance in nits.
    Uniform(DVec3),
}

/// Source of the sun light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sun {
    /// Sun of the environment, or else the brightest directional light of the scene.
    #[default]
    FromScene,
    /// No sun.
    Off,
    /// Sun of the environment; a sun inside the environment map stays there.
    InMap,
    /// Custom sun.
    Custom {
        /// Direction from the scene toward the sun, normalized.
        toward: DVec3,
        /// Illuminance on a surface that faces the sun, in lux.
        illuminance_lux: f64,
        /// Diameter of the disc in degrees.
        diameter_deg: f64,
    },
}

/// Visibility of the sun's disk and halo.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Disk {
    /// The light states it.
    #[default]
    Own,
    /// Not drawn.
    Off,
    /// Drawn with this halo.
    On(SunHalo),
}

impl Disk {
    /// Returns the halo of a light that states `own`.
    pub fn halo(self, own: Option<SunHalo>) -> Option<SunHalo> {
        match self {
            Self::Own => own,
            Self::Off => None,
            Self::On(halo) => Some(halo),
        }
    }
}

/// Visible background.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum BackgroundSource {
    /// The environment.
    #[default]
    Environment,
    /// Clear sky.
    Sky,
    /// Constant radiance in nits.
    Constant(DVec3),
}

/// Options of the environment, the sun, the background and the exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// Environment light.
    pub environment: EnvironmentSource,
    /// Factor on the environment light.
    pub intensity: f32,
    /// Sun.
    pub sun: Sun,
    /// Disk and halo of the sun.
    pub disk: Disk,
    /// Background.
    pub background: BackgroundSource,
    /// Exposure value at ISO 100; `None` meters it.
    pub ev100: Option<f32>,
}

impl Default for Lighting {
    fn default() -> Self {
        let (environment, background) = (EnvironmentSource::Sky, BackgroundSource::Environment);
        Self { environment, intensity: 1.0, sun: Sun::FromScene, disk: Disk::Own, background, ev100: None }
    }
}

impl Lighting {
    /// Parses the value of an option of this module; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, item: &Item) -> Result<bool, String> {
        match item.name() {
            "environment" => self.environment = environment(item.raw())?,
            "ibl-intensity" => self.intensity = crate::parse::number(item, 0.0..=1e6)?,
            "sun" => self.sun = sun(&item.text()?)?,
            "sun-disk" => self.disk = disk(&item.text()?)?,
            "background" => self.background = background(&item.text()?)?,
            name @ ("ev100" | "exposure") => {
                if self.ev100.is_some() {
                    return Err(format!("--{name}: the exposure is already set; use --ev100 or --exposure, once"));
                }
                let value = item.text()?;
                self.ev100 = Some(if name == "exposure" { exposure(&value)? } else { ev100("--ev100", &value)? });
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

fn environment(value: OsString) -> Result<EnvironmentSource, String> {
    match value.to_str().and_then(|text| text.strip_prefix("uniform:")) {
        Some(rgb) => Ok(EnvironmentSource::Uniform(radiance("--environment uniform", rgb)?)),
        None => Ok(EnvironmentSource::File(value.into())),
    }
}

fn sun(text: &str) -> Result<Sun, String> {
    if text == "off" {
        return Ok(Sun::Off);
    }
    if text == "in-map" {
        return Ok(Sun::InMap);
    }
    let wrong = |why: &str| format!("--sun {text}: {why}; expected X,Y,Z:LUX, X,Y,Z:LUX:ANGLE, in-map or off");
    let parts: Vec<&str> = text.split(':').collect();
    let (direction, lux, angle) = match parts[..] {
        [direction, lux] => (direction, lux, None),
        [direction, lux, angle] => (direction, lux, Some(angle)),
        _ => return Err(wrong("expected two or three parts separated by colons")),
    };
    let toward = three(direction).ok_or_else(|| wrong("the direction is not three finite numbers"))?;
    // Divide by the largest component first, because squares of 1e-200 or 1e200 exceed the range of f64.
    let toward = (toward / toward.abs().max_element()).try_normalize();
    let toward = toward.ok_or_else(|| wrong("the direction has no length"))?;
    let within = |text: &str, max: f64| finite(text).filter(|number| (0.0..=max).contains(number));
    let illuminance_lux = within(lux, MAX).ok_or_else(|| wrong("LUX must be from 0 to 1e10"))?;
    let diameter_deg = match angle {
        Some(angle) => within(angle, 90.0).ok_or_else(|| wrong("ANGLE must be from 0 to 90 degrees"))?,
        None => SOLAR_DIAMETER_DEG,
    };
    Ok(Sun::Custom { toward, illuminance_lux, diameter_deg })
}

fn disk(text: &str) -> Result<Disk, String> {
    let within = |text: &str, [least, most]: [f32; 2]| {
        finite(text).map(|number| number as f32).filter(|number| (least..=most).contains(number))
    };
    match (text, text.split_once(':')) {
        ("on", _) => Ok(Disk::On(SunHalo::FILAMENT)),
        ("off", _) => Ok(Disk::Off),
        (_, Some((size, falloff))) => match (within(size, SunHalo::SIZES), within(falloff, SunHalo::FALLOFFS)) {
            (Some(size), Some(falloff)) => Ok(Disk::On(SunHalo { size, falloff })),
            _ => Err(format!("--sun-disk {text}: SIZE must be from 1.001 to 1000, FALLOFF from 0.01 to 10000")),
        },
        _ => Err(format!("--sun-disk {text}: expected on, off or SIZE:FALLOFF")),
    }
}

fn background(text: &str) -> Result<BackgroundSource, String> {
    if text == "sky" {
        Ok(BackgroundSource::Sky)
    } else {
        Ok(BackgroundSource::Constant(radiance("--background", text)?))
    }
}

/// Parses three numbers in nits.
fn radiance(option: &str, text: &str) -> Result<DVec3, String> {
    let rgb = three(text).filter(|rgb| rgb.min_element() >= 0.0 && rgb.max_element() <= MAX);
    let sky = if option == "--background" { ", or sky" } else { "" };
    rgb.ok_or_else(|| format!("{option} {text}: expected R,G,B in nits, each from 0 to 1e10{sky}"))
}

fn exposure(text: &str) -> Result<f32, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let wrong = || format!("--exposure {text}: expected EV100, or APERTURE,SHUTTER,ISO such as 16,1/125,100");
    match parts[..] {
        [_] => ev100("--exposure", text),
        [aperture, shutter, iso] => {
            let settings = (finite(aperture), seconds(shutter), finite(iso));
            let (Some(aperture), Some(shutter_s), Some(iso)) = settings else { return Err(wrong()) };
            let value = ev100_from_settings(aperture as f32, shutter_s as f32, iso as f32);
            let value = value.ok_or_else(|| format!("--exposure {text}: all three must be above 0"))?;
            in_range(&format!("--exposure {text}"), value)
        }
        _ => Err(wrong()),
    }
}

/// Parses seconds as a number or a fraction.
fn seconds(text: &str) -> Option<f64> {
    match text.split_once('/') {
        Some((over, under)) => Some(finite(over)? / finite(under)?).filter(|s| s.is_finite()),
        None => finite(text),
    }
}

fn ev100(option: &str, text: &str) -> Result<f32, String> {
    let value: f32 = text.trim().parse().map_err(|_| format!("{option} {text}: expected a number"))?;
    in_range(&format!("{option} {text}"), value)
}

fn in_range(option: &str, value: f32) -> Result<f32, String> {
    let (low, high) = EV100_RANGE;
    let fits = (low..=high).contains(&value);
    if fits {
        Ok(value)
    } else {
        Err(format!("{option}: out of range; expected an exposure value from {low} to {high}"))
    }
}

fn three(text: &str) -> Option<DVec3> {
    let mut parts = text.split(',').map(finite);
    let xyz = DVec3::new(parts.next()??, parts.next()??, parts.next()??);
    parts.next().is_none().then_some(xyz)
}

fn finite(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(words: &[&str]) -> Result<Lighting, String> {
        let mut asked = Lighting::default();
        crate::parse::taken(options(), words, |item| asked.take(item))?;
        Ok(asked)
    }

    #[test]
    fn options_set_what_they_name() {
        let found = taken(&["--environment", "uniform:1,2.5,0", "--ibl-intensity", "0.5", "--background", "sky"]);
        let uniform = EnvironmentSource::Uniform(DVec3::new(1.0, 2.5, 0.0));
        let expected =
            Lighting { environment: uniform, intensity: 0.5, background: BackgroundSource::Sky, ..Lighting::default() };
        assert_eq!(found, Ok(expected));
        let file = taken(&["--environment", "a/uniform.hdr", "--background", "1,0,2e3", "--sun", "off"]);
        let expected = Lighting {
            environment: EnvironmentSource::File("a/uniform.hdr".into()),
            background: BackgroundSource::Constant(DVec3::new(1.0, 0.0, 2000.0)),
            sun: Sun::Off,
            ..Lighting::default()
        };
        assert_eq!(file, Ok(expected));
    }

    #[test]
    fn the_sun_has_a_direction_of_any_length() {
        for (text, degrees) in [("0,3e200,-4e200:5000", SOLAR_DIAMETER_DEG), ("0,6e-300,-8e-300:5000:2", 2.0)] {
            let Ok(Sun::Custom { toward, illuminance_lux, diameter_deg }) = sun(text) else { panic!("{text}") };
            assert!(toward.abs_diff_eq(DVec3::new(0.0, 0.6, -0.8), 1e-12), "{text}: {toward}");
            assert_eq!((illuminance_lux, diameter_deg), (5000.0, degrees));
        }
    }

    #[test]
    fn the_sun_has_a_disk_on_demand() {
        let own = SunHalo { size: 3.0, falloff: 7.0 };
        for (text, expected) in [("on", Some(SunHalo::FILAMENT)), ("off", None), ("3:7", Some(own))] {
            let found = taken(&["--sun-disk", text]).expect(text);
            assert_eq!(found.disk.halo(Some(SunHalo { size: 2.0, falloff: 2.0 })), expected, "{text}");
        }
        assert_eq!(Disk::default().halo(Some(own)), Some(own));
    }

    #[test]
    fn camera_settings_make_an_exposure_value() {
        // Sunny 16 rule: EV 15 at 1/128 s.
        assert_eq!(exposure("16,1/128,100"), Ok(15.0));
        assert_eq!(exposure("16,0.0078125,200"), Ok(14.0));
        assert_eq!(exposure("-3.5"), Ok(-3.5));
    }

    #[test]
    fn invalid_options_are_reported() {
        let cases: [(&[&str], &str); 22] = [
            (&["--environment"], "--environment: missing FILE"),
            (&["--environment", "uniform:1,2"], "--environment uniform 1,2"),
            (&["--environment", "uniform:1,2,-3"], "--environment uniform 1,2,-3"),
            (&["--environment", "uniform:1,2,inf"], "--environment uniform 1,2,inf"),
            (&["--ibl-intensity", "-1"], "--ibl-intensity -1"),
            (&["--ibl-intensity", "NaN"], "--ibl-intensity NaN"),
            (&["--sun", "on"], "--sun on"),
            (&["--sun", "0,0,0:1"], "--sun 0,0,0:1: the direction has no length"),
            (&["--sun", "0,1:1"], "--sun 0,1:1: the direction is not three"),
            (&["--sun", "0,1,0:-1"], "--sun 0,1,0:-1: LUX"),
            (&["--sun", "0,1,0:1:99"], "--sun 0,1,0:1:99: ANGLE"),
            (&["--sun", "0,1,0:1:1:1"], "--sun 0,1,0:1:1:1"),
            (&["--sun"], "--sun: missing X,Y,Z:LUX"),
            (&["--background", "blue"], "--background blue"),
            (&["--background", "1,2,3,4"], "--background 1,2,3,4"),
            (&["--exposure", "16,1/0,100"], "--exposure 16,1/0,100"),
            (&["--exposure", "0,1/60,100"], "--exposure 0,1/60,100: all three must be above 0"),
            (&["--exposure", "16,1/60"], "--exposure 16,1/60"),
            (&["--exposure", "99"], "--exposure 99: out of range"),
            (&["--exposure", "1000,1e-9,1"], "--exposure 1000,1e-9,1: out of range"),
            (&["--ev100", "NaN"], "--ev100 NaN"),
            (&["--ev100", "3", "--exposure", "3"], "--exposure: the exposure is already set"),
        ];
        for (words, named) in cases {
            let error = taken(words).expect_err("the command line is invalid");
            assert!(error.contains(named) && !error.contains('\n'), "{words:?}: {error}");
        }
    }
}
