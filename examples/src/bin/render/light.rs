//! Options that say what lights the scene, what stands behind it, and how long the camera exposes.

use framegraph_passes::LightSearch;
use framegraph_scene::SunHalo;
use framegraph_scene::camera::{EV100_RANGE, ev100_from_settings};
use glam::DVec3;
use lexopt::Parser;
use std::ffi::OsString;
use std::path::PathBuf;

/// What `render --help` prints of them.
pub const HELP: &str = "
  --environment FILE   light from an equirectangular .hdr or .exr picture or a cube in a .ktx or .ktx2 file, or
                       uniform:R,G,B for the same radiance from everywhere, in nits, linear Rec.709; default: a clear sky
                       with its sun. A sun in the picture is taken out of it and made a light that casts shadows. A cube
                       with its irradiance, NAME_ibl.ktx of Filament's cmgen, is filtered already and lights as it is
  --ibl-intensity X    factor on the environment's light, and on the environment or the sky where it is seen; metering
                       does not see it (1)
  --sun X,Y,Z:LUX[:ANGLE]  a white sun instead of the environment's own: X,Y,Z is the direction from the scene toward it, of
                       any length, LUX the illuminance on a surface that faces it, ANGLE the diameter of its disc in
                       degrees (0.533), seen in a clear sky, which follows a sun that stands above the horizon
  --sun-disk on|off    draws the sun's disk with a halo behind the scene, as Filament's skybox does with showSun; or
                       SIZE:FALLOFF, the halo's radius over the disk's and the exponent of its falloff (10:80); default:
                       as the scene's lights say
  --sun off            no sun: neither the environment's, be it apart or in the map, nor a directional light of the scene
  --sun in-map         a sun in the picture of the environment stays there, as bright texels
  --background WHAT    what is seen behind the scene, while the environment lights it: R,G,B is one radiance in nits,
                       linear Rec.709, exposed like everything else and seen by no surface; sky is the clear sky
  --ev100 X            exposure value at ISO 100; default: metered from the light
  --lights WAY         how shading finds the scene's lamps: froxels (lists for parts of what is seen), all (every lamp at
                       every place; the same picture), or auto (froxels for 4 lamps of limited range and more; default).
                       auto and froxels take :KEY=X,...: tiles=N (of the picture, at most; 144), slices=N (of distance;
                       16), near=M and far=M (where the first slice ends, and where the last would; 5 and 100)
  --exposure X         the same, or a camera's settings as APERTURE,SHUTTER,ISO: f-number, seconds (also 1/125), ISO;
                       16,1/125,100 is EV 15
";

/// The sun's disc as it is seen from here, in degrees.
const SOLAR_DIAMETER_DEG: f64 = 0.533;
/// The brightest radiance and illuminance that are accepted: above the sun's disc, and sums stay finite in f32.
const MOST: f64 = 1e10;

/// What lights the scene from all around.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Around {
    /// A clear sky.
    #[default]
    Sky,
    /// An equirectangular picture, or a cube.
    File(PathBuf),
    /// The same radiance from everywhere, in nits.
    Uniform(DVec3),
}

/// Which sun shines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sun {
    /// The environment's own, else the scene's brightest directional light.
    #[default]
    Own,
    /// None.
    Off,
    /// The environment's own, but one that is part of its map stays there.
    InMap,
    /// This one.
    Given {
        /// From the scene toward the sun; not zero.
        toward: DVec3,
        /// On a surface that faces it.
        illuminance_lux: f64,
        /// Diameter of its disc.
        diameter_deg: f64,
    },
}

/// Whether the sun's disk and halo are drawn behind the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Disk {
    /// As the light says.
    #[default]
    Own,
    /// They are not.
    Off,
    /// With this halo.
    On(SunHalo),
}

impl Disk {
    /// The halo of a light that has `own`.
    pub fn halo(self, own: Option<SunHalo>) -> Option<SunHalo> {
        match self {
            Self::Own => own,
            Self::Off => None,
            Self::On(halo) => Some(halo),
        }
    }
}

/// What is seen behind the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Behind {
    /// What lights it.
    #[default]
    Environment,
    /// The clear sky.
    Sky,
    /// The same radiance everywhere, in nits.
    Constant(DVec3),
}

/// What was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// Light from all around.
    pub around: Around,
    /// Factor on it.
    pub intensity: f32,
    /// The sun.
    pub sun: Sun,
    /// The disk and halo of the sun.
    pub disk: Disk,
    /// The background.
    pub behind: Behind,
    /// Exposure value; none meters it.
    pub ev100: Option<f32>,
    /// How shading finds the scene's lamps.
    pub lights: LightSearch,
}

impl Default for Lighting {
    fn default() -> Self {
        let (around, behind, lights) = (Around::Sky, Behind::Environment, LightSearch::default());
        Self { around, intensity: 1.0, sun: Sun::Own, disk: Disk::Own, behind, ev100: None, lights }
    }
}

impl Lighting {
    /// Takes the option `--name`, if it is one of these.
    ///
    /// # Errors
    /// One line that names the option and what it takes.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        let option = format!("--{name}");
        let raw = |parser: &mut Parser, what: &str| parser.value().map_err(|_| format!("{option}: {what} is missing"));
        let text = |parser: &mut Parser| {
            let value = raw(parser, "a value")?;
            value.into_string().map_err(|v| format!("{option} {v:?}: the value is not Unicode"))
        };
        match name {
            "environment" => self.around = around(raw(parser, "a file")?)?,
            "ibl-intensity" => {
                self.intensity = crate::look::number(&option, &text(parser)?, 0.0..=1e6)?;
            }
            "sun" => self.sun = sun(&text(parser)?)?,
            "sun-disk" => self.disk = disk(&text(parser)?)?,
            "lights" => {
                self.lights = LightSearch::from_text(&text(parser)?).map_err(|told| format!("{option} {told}"))?;
            }
            "background" => self.behind = behind(&text(parser)?)?,
            "ev100" | "exposure" => {
                if self.ev100.is_some() {
                    return Err(format!("{option}: the exposure is given already; give --ev100 or --exposure, once"));
                }
                let given = text(parser)?;
                self.ev100 = Some(if name == "exposure" { exposure(&given)? } else { ev100(&option, &given)? });
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

fn around(value: OsString) -> Result<Around, String> {
    match value.to_str().and_then(|text| text.strip_prefix("uniform:")) {
        Some(rgb) => Ok(Around::Uniform(radiance("--environment uniform", rgb)?)),
        None => Ok(Around::File(value.into())),
    }
}

fn sun(text: &str) -> Result<Sun, String> {
    if text == "off" {
        return Ok(Sun::Off);
    }
    if text == "in-map" {
        return Ok(Sun::InMap);
    }
    let wrong = |why: &str| format!("--sun {text}: {why}; X,Y,Z:LUX, X,Y,Z:LUX:ANGLE, in-map or off is needed");
    let parts: Vec<&str> = text.split(':').collect();
    let (direction, lux, angle) = match parts[..] {
        [direction, lux] => (direction, lux, None),
        [direction, lux, angle] => (direction, lux, Some(angle)),
        _ => return Err(wrong("the parts between colons are not two or three")),
    };
    let toward = three(direction).ok_or_else(|| wrong("the direction is not three finite numbers"))?;
    // Divided by the largest component first: squares of 1e-200 or 1e200 leave f64.
    let toward = (toward / toward.abs().max_element()).try_normalize();
    let toward = toward.ok_or_else(|| wrong("the direction has no length"))?;
    let within = |text: &str, most: f64| finite(text).filter(|number| (0.0..=most).contains(number));
    let illuminance_lux = within(lux, MOST).ok_or_else(|| wrong("LUX goes from 0 to 1e10"))?;
    let diameter_deg = match angle {
        Some(angle) => within(angle, 90.0).ok_or_else(|| wrong("ANGLE goes from 0 to 90 degrees"))?,
        None => SOLAR_DIAMETER_DEG,
    };
    Ok(Sun::Given { toward, illuminance_lux, diameter_deg })
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
            _ => Err(format!("--sun-disk {text}: SIZE goes from 1.001 to 1000, FALLOFF from 0.01 to 10000")),
        },
        _ => Err(format!("--sun-disk {text}: on, off or SIZE:FALLOFF is needed")),
    }
}

fn behind(text: &str) -> Result<Behind, String> {
    if text == "sky" { Ok(Behind::Sky) } else { Ok(Behind::Constant(radiance("--background", text)?)) }
}

/// Three numbers in nits.
fn radiance(option: &str, text: &str) -> Result<DVec3, String> {
    let rgb = three(text).filter(|rgb| rgb.min_element() >= 0.0 && rgb.max_element() <= MOST);
    let sky = if option == "--background" { " or sky" } else { "" };
    rgb.ok_or_else(|| format!("{option} {text}: three numbers from 0 to 1e10, R,G,B in nits,{sky} are needed"))
}

fn exposure(text: &str) -> Result<f32, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let wrong = || format!("--exposure {text}: EV100, or APERTURE,SHUTTER,ISO such as 16,1/125,100, is needed");
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

/// Seconds as a number or a fraction.
fn seconds(text: &str) -> Option<f64> {
    match text.split_once('/') {
        Some((over, under)) => Some(finite(over)? / finite(under)?).filter(|s| s.is_finite()),
        None => finite(text),
    }
}

fn ev100(option: &str, text: &str) -> Result<f32, String> {
    let value: f32 = text.trim().parse().map_err(|_| format!("{option} {text}: a number is needed"))?;
    in_range(&format!("{option} {text}"), value)
}

fn in_range(given: &str, value: f32) -> Result<f32, String> {
    let (low, high) = EV100_RANGE;
    let fits = (low..=high).contains(&value);
    if fits { Ok(value) } else { Err(format!("{given}: exposure values go from {low} to {high}")) }
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
        let mut parser = Parser::from_args(words.iter().map(OsString::from));
        while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
            let lexopt::Arg::Long(name) = arg else { return Err("no option".into()) };
            let name = name.to_owned();
            assert!(asked.take(&name, &mut parser)?, "--{name}: unknown");
        }
        Ok(asked)
    }

    #[test]
    fn options_set_what_they_name() {
        let found = taken(&["--environment", "uniform:1,2.5,0", "--ibl-intensity", "0.5", "--background", "sky"]);
        let uniform = Around::Uniform(DVec3::new(1.0, 2.5, 0.0));
        let expected = Lighting { around: uniform, intensity: 0.5, behind: Behind::Sky, ..Lighting::default() };
        assert_eq!(found, Ok(expected));
        let file = taken(&["--environment", "a/uniform.hdr", "--background", "1,0,2e3", "--sun", "off"]);
        let expected = Lighting {
            around: Around::File("a/uniform.hdr".into()),
            behind: Behind::Constant(DVec3::new(1.0, 0.0, 2000.0)),
            sun: Sun::Off,
            ..Lighting::default()
        };
        assert_eq!(file, Ok(expected));
    }

    #[test]
    fn lamps_are_found_as_asked() {
        let found = |words: &[&str]| taken(words).map(|found| found.lights);
        assert_eq!((found(&[]), found(&["--lights", "all"])), (Ok(LightSearch::default()), Ok(LightSearch::All)));
    }

    #[test]
    fn the_sun_has_a_direction_of_any_length() {
        for (text, degrees) in [("0,3e200,-4e200:5000", SOLAR_DIAMETER_DEG), ("0,6e-300,-8e-300:5000:2", 2.0)] {
            let Ok(Sun::Given { toward, illuminance_lux, diameter_deg }) = sun(text) else { panic!("{text}") };
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
        // Sunny sixteen: EV 15 at 1/128 s.
        assert_eq!(exposure("16,1/128,100"), Ok(15.0));
        assert_eq!(exposure("16,0.0078125,200"), Ok(14.0));
        assert_eq!(exposure("-3.5"), Ok(-3.5));
    }

    #[test]
    fn wrong_words_are_named() {
        let cases: [(&[&str], &str); 26] = [
            (&["--sun-disk", "yes"], "--sun-disk yes: on, off or SIZE:FALLOFF"),
            (&["--sun-disk", "0.5:80"], "--sun-disk 0.5:80: SIZE goes from"),
            (&["--environment"], "--environment: a file is missing"),
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
            (&["--sun"], "--sun: a value is missing"),
            (&["--lights", "some"], "--lights some: "),
            (&["--lights", "froxels:far=1"], "--lights near=5: less than `far`"),
            (&["--background", "blue"], "--background blue"),
            (&["--background", "1,2,3,4"], "--background 1,2,3,4"),
            (&["--exposure", "16,1/0,100"], "--exposure 16,1/0,100"),
            (&["--exposure", "0,1/60,100"], "--exposure 0,1/60,100: all three must be above 0"),
            (&["--exposure", "16,1/60"], "--exposure 16,1/60"),
            (&["--exposure", "99"], "--exposure 99: exposure values go from"),
            (&["--exposure", "1000,1e-9,1"], "--exposure 1000,1e-9,1: exposure values go from"),
            (&["--ev100", "NaN"], "--ev100 NaN"),
            (&["--ev100", "3", "--exposure", "3"], "--exposure: the exposure is given already"),
        ];
        for (words, named) in cases {
            let error = taken(words).expect_err("the command line is wrong");
            assert!(error.contains(named) && !error.contains('\n'), "{words:?}: {error}");
        }
    }
}
