//! Options for light, background, camera, exposure and tone curve, verified by pixel values of rendered pictures.
//!
//! The scene is a gray card, two meters wide and facing +z. An orthographic camera shows it in the center of a picture
//! twice as wide. Radiance is read from the EXR; rounding to half floats is below 1/1000.

use framegraph_scene::environment::direction_from_equirect_uv;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Cache folder of image-based light, apart from the user's cache.
const LIGHT: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/light");
/// Reflectance of the card.
const GREY: f64 = 0.5;
/// Relative tolerance for half floats and sums of a few.
const ROUNDING: f64 = 2e-3;
/// EV100 with unit exposure: 1 / (1.2 · 2^EV100) is 1.
const UNIT_EXPOSURE: &str = "-0.26303440583";

const CARD: &str = r#"{
  "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3, "color": [1, 1, 1]}]}},
  "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
  "nodes": [{"mesh": 0}, {"name": "wide", "camera": 0, "translation": [0, 0, 2]},
    {"name": "close", "camera": 1, "translation": [0, 0, 2]}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "cameras": [
    {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 10}},
    {"type": "orthographic", "orthographic": {"xmag": 0.5, "ymag": 0.5, "znear": 0.1, "zfar": 10}}
  ],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0}]}],
  "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
    {"bufferView": 1, "componentType": 5126, "count": 6, "type": "VEC3"}
  ],
  "bufferViews": [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 72}],
  "buffers": [{"uri": "card.bin", "byteLength": 144}]
}"#;

/// Creates a folder with the card; `None` without an adapter, which is reported as a skip.
fn folder(test: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder can be written");
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0_f32]];
    let positions = corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]);
    let normals = corners.iter().flat_map(|_| [0.0, 0.0, 1.0]);
    let bytes: Vec<u8> = positions.chain(normals).flat_map(f32::to_le_bytes).collect();
    fs::write(folder.join("card.bin"), bytes).expect("the folder can be written");
    fs::write(folder.join("card.gltf"), CARD).expect("the folder can be written");
    let Err(why) = try_shot(&folder, "probe", &[]) else { return Some(folder) };
    assert!(why.contains("no adapter"), "{why}");
    test_report::skip(test, why.trim());
    None
}

/// One picture: exposed radiance and 8-bit display values.
struct Shot {
    linear: image::Rgba32FImage,
    codes: image::RgbaImage,
}

const SIDE: u32 = 32;

impl Shot {
    /// Radiance at the center of the card.
    fn card(&self) -> [f64; 3] {
        self.at(SIDE / 2, SIDE / 2)
    }

    /// Radiance of the background.
    fn background(&self) -> [f64; 3] {
        self.at(1, SIDE / 2)
    }

    fn at(&self, x: u32, y: u32) -> [f64; 3] {
        let [r, g, b, _] = self.linear.get_pixel(x, y).0;
        [r, g, b].map(f64::from)
    }
}

fn try_shot(folder: &Path, name: &str, args: &[&str]) -> Result<Shot, String> {
    let (png, exr) = (format!("{name}.png"), format!("{name}.exr"));
    let side = format!("{SIDE}x{SIDE}");
    let always = ["card.gltf", "--size", &side, "--frames", "1", "--out", &png, "--linear-out", &exr, "--no-shadows"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_render"));
    command.env("FRAMEGRAPH_LIGHT_CACHE", LIGHT);
    let done = command.env("NODEVICE_SELECT", "1").current_dir(folder).args(always).args(args).output();
    let Output { status, stderr, .. } = done.expect("the program starts");
    if !status.success() {
        return Err(format!("{args:?}: {status}: {}", String::from_utf8_lossy(&stderr)));
    }
    let open = |name: &str| image::open(folder.join(name)).map_err(|e| format!("{name}: {e}"));
    Ok(Shot { linear: open(&exr)?.into_rgba32f(), codes: open(&png)?.into_rgba8() })
}

fn shot(folder: &Path, args: &[&str]) -> Shot {
    try_shot(folder, "shot", args).unwrap_or_else(|message| panic!("{message}"))
}

#[track_caller]
fn close(what: &str, found: [f64; 3], expected: [f64; 3]) {
    let fits = found.iter().zip(expected).all(|(f, e)| (f - e).abs() <= ROUNDING * e.abs());
    assert!(fits, "{what}: {found:?}, expected {expected:?}");
}

/// No sun and unit exposure.
const EVEN: [&str; 4] = ["--sun", "off", "--exposure", UNIT_EXPOSURE];

#[test]
fn an_even_environment_and_its_factor() {
    let Some(folder) = folder("even") else { return };
    let even = |more: &[&str]| shot(&folder, &[&EVEN, more].concat());
    let unit = even(&["--environment", "uniform:1,1,1"]);
    close("background", unit.background(), [1.0; 3]);
    let [card, ..] = unit.card();
    assert!((card - GREY).abs() < 0.03, "half of the light comes back, and some of the highlight: {card}");
    let colored = even(&["--environment", "uniform:3,0.25,7"]);
    close("background", colored.background(), [3.0, 0.25, 7.0]);
    close("card", colored.card(), [3.0 * card, 0.25 * card, 7.0 * card]);
    let factor = even(&["--environment", "uniform:3,0.25,7", "--ibl-intensity", "2.5"]);
    close("background", factor.background(), [7.5, 0.625, 17.5]);
    close("card", factor.card(), [7.5 * card, 0.625 * card, 17.5 * card]);
    let off = even(&["--environment", "uniform:3,0.25,7", "--ibl-intensity", "0"]);
    close("card", off.card(), [0.0; 3]);
}

#[test]
fn the_sun_and_the_background() {
    let Some(folder) = folder("sun") else { return };
    let dark = |more: &[&str]| {
        shot(&folder, &[&["--environment", "uniform:0,0,0", "--exposure", UNIT_EXPOSURE], more].concat())
    };
    // The file has a light of 3 lux along -z. It is the sun if no other exists, and else a punctual light.
    let [own, ..] = dark(&[]).card();
    let sun = |given: &str| dark(&["--sun", given]).card()[0] - own;
    // Lambertian reflection, plus the highlight of a rough dielectric within a tenth.
    assert!((own / (GREY * 3.0 / std::f64::consts::PI) - 1.0).abs() < 0.1, "{own}");
    let head_on = own * 10.0 / 3.0;
    close("a sun in front", [sun("0,0,5:10"); 3], [head_on; 3]);
    close("twice the light", [sun("0,0,1:20"); 3], [2.0 * head_on; 3]);
    let slanted = sun("0,2.4,1.8:10");
    assert!((slanted / (0.6 * head_on) - 1.0).abs() < 0.03, "the cosine of the angle: {slanted} of {head_on}");
    close("a sun from behind", dark(&["--sun", "0,0,-1:10"]).card(), [own; 3]);
    close("no sun", dark(&["--sun", "off"]).card(), [0.0; 3]);
    let behind = dark(&["--background", "4,2,0.5"]);
    close("background", behind.background(), [4.0, 2.0, 0.5]);
    close("lights nothing", behind.card(), [own; 3]);
}

/// A small bright patch in a black map becomes a directional light and scales with the environment intensity.
#[test]
fn the_sun_of_a_map_is_a_light() {
    let Some(folder) = folder("map") else { return };
    let (width, height, nits) = (128_u32, 64_u32, 5000.0_f32);
    let mut map = image::Rgb32FImage::new(width, height);
    let mut expected = 0.0;
    // The left and right edges of the map meet at +z, the direction that the card faces.
    for (y, x) in [(31, 0), (31, width - 1), (32, 0), (32, width - 1)] {
        let uv = glam::DVec2::new((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height));
        let cosine = direction_from_equirect_uv(uv).z;
        map.put_pixel(x, y, image::Rgb([nits; 3]));
        let polar = std::f64::consts::PI * (f64::from(y) + 0.5) / f64::from(height);
        let texel = 2.0 * std::f64::consts::PI.powi(2) / f64::from(width * height) * polar.sin();
        expected += f64::from(nits) * texel * cosine;
    }
    map.save(folder.join("sun.exr")).expect("the folder can be written");
    let lit = |more: &[&str]| {
        shot(&folder, &[&["--environment", "sun.exr", "--exposure", UNIT_EXPOSURE], more].concat()).card()[0]
    };
    let dark = shot(&folder, &["--environment", "uniform:0,0,0", "--exposure", UNIT_EXPOSURE]).card()[0];
    // The light of the file has 3 lux. The tolerance of 1/100 covers the size of the patch, which becomes a single
    // direction.
    let (once, twice) = (lit(&[]) - dark, lit(&["--ibl-intensity", "2"]) - dark);
    assert!((once / (dark / 3.0 * expected) - 1.0).abs() < 0.01, "{once} for {expected} lux");
    close("twice the environment", [twice; 3], [2.0 * once; 3]);
    assert!(lit(&["--sun", "off"]) < 1e-3 * once, "nothing of it is left in the map");
    // Three bands of spherical harmonics overestimate a frontal light by 17/16.
    let texels = lit(&["--sun", "in-map"]) - dark;
    assert!((texels / once - 1.0).abs() < 0.1, "as texels {texels}, as a light {once}");
}

#[test]
fn a_clear_sky_shows_the_disc_of_its_sun() {
    let Some(folder) = folder("disc") else { return };
    let sky = |more: &[&str]| {
        let view = ["--camera", "0,0,3:0,1,2:90", "--msaa", "1", "--exposure", "16,1/125,100"];
        shot(&folder, &[&view, more].concat())
    };
    // A disc of radiance E / (π sin² r) is far brighter than the sky, which reaches ten thousand nits at most.
    let lit = |shot: &Shot| shot.linear.pixels().filter(|p| p.0[0] > 3.0).count();
    let counts = [0.0, 8.0, 24.0].map(|degrees| lit(&sky(&["--sun", &format!("0,1,-1:90000:{degrees}")])));
    assert!(counts[0] <= 1 && counts[1] > counts[0] && counts[2] > 4 * counts[1], "{counts:?}");
    let (own, off) = (sky(&[]), sky(&["--sun", "off", "--ibl-intensity", "2"]));
    let [before, after] = [&own, &off].map(|shot| shot.at(4, 28)[2]);
    assert!((after / before - 2.0).abs() < 0.01, "the sky that is seen follows the factor: {before}, {after}");
    let behind = ["--background", "sky", "--environment", "uniform:0,0,0"];
    close("a sky that is only seen", sky(&behind).at(4, 28), own.at(4, 28));
}

#[test]
fn exposure_in_three_ways() {
    let Some(folder) = folder("exposure") else { return };
    let even = |more: &[&str]| shot(&folder, &[&["--environment", "uniform:100,50,20", "--sun", "off"], more].concat());
    let at = |exposure: f64| [100.0, 50.0, 20.0].map(|nits| nits * exposure);
    close("EV 7", even(&["--exposure", "7"]).background(), at(1.0 / (1.2 * 128.0)));
    close("EV 7 by its older name", even(&["--ev100", "7"]).background(), at(1.0 / (1.2 * 128.0)));
    // f/4 at 1/25 s and ISO 200: 16 · 25 / 2 = 200.
    close("settings", even(&["--exposure", "4,1/25,200"]).background(), at(1.0 / (1.2 * 200.0)));
    // Metering shows a white card in this light as white.
    let [r, g, b] = even(&[]).background();
    assert!((0.2126 * r + 0.7152 * g + 0.0722 * b - 1.0).abs() < 0.01, "{r} {g} {b}");
}

#[test]
fn the_camera_of_the_file() {
    let Some(folder) = folder("camera") else { return };
    let seen = |more: &[&str]| {
        let lit =
            ["--environment", "uniform:1,1,1", "--exposure", UNIT_EXPOSURE, "--background", "0,0,0", "--sun", "off"];
        shot(&folder, &[&lit, more].concat()).background()[0] > 0.0
    };
    assert!(!seen(&["--camera-from-gltf"]), "the first sees the card with what is around it");
    assert!(seen(&["--camera-from-gltf", "--camera", "close"]), "the second sees the card alone");
    let message = try_shot(&folder, "none", &["--camera-from-gltf", "--camera", "other"]).err().unwrap_or_default();
    assert!(message.contains("other") && message.contains("wide, close"), "{message}");
    fs::write(folder.join("card.gltf"), CARD.replace("\"camera\": 0,", "").replace("\"camera\": 1,", ""))
        .expect("writable");
    let message = try_shot(&folder, "none", &["--camera-from-gltf"]).err().unwrap_or_default();
    assert!(message.contains("--camera-from-gltf: `card.gltf` has no camera"), "{message}");
}

/// The EXR contains radiance before post-processing, independent of its settings and of the plan.
#[test]
fn radiance_is_that_before_post_processing() {
    let Some(folder) = folder("linear") else { return };
    let even = |more: &[&str]| {
        let lit = ["--environment", "uniform:3,0.25,7", "--exposure", UNIT_EXPOSURE, "--sun", "off"];
        shot(&folder, &[&lit, more].concat())
    };
    let plain = even(&["--inline", "on", "--msaa", "4"]);
    close("background", plain.background(), [3.0, 0.25, 7.0]);
    for args in [
        &["--inline", "off", "--msaa", "4"][..],
        &["--inline", "on", "--msaa", "1"],
        &["--inline", "off", "--msaa", "1", "--split-post", "--tone-map", "filmic", "--compensation", "2"],
        &["--vignette", "3", "--grade", "saturation=0"],
    ] {
        let other = even(args);
        for y in (0..SIDE).step_by(5) {
            for x in (0..SIDE).step_by(5) {
                close(&format!("{args:?} at {x} {y}"), other.at(x, y), plain.at(x, y));
            }
        }
    }
    let codes = |shot: &Shot| shot.codes.get_pixel(SIDE / 2, SIDE / 2).0;
    let graded = even(&["--tone-map", "filmic"]);
    assert_ne!(codes(&plain), codes(&graded), "the picture is not the same");
}

/// Tone curves with a single formula, at one gray value. Other tests compare complex curves with Filament's pictures and
/// charts.
#[test]
fn tone_curves_by_name() {
    let Some(folder) = folder("tone") else { return };
    let x = 0.4_f64;
    let hill = |x: f64| {
        let fit = |v: f64| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081);
        fit(x)
    };
    let curves = [
        ("linear", x),
        ("linear-2020", x),
        ("hill", hill(x)),
        ("filmic", x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)),
        ("neutral", x - 0.04),
        // The curve gives the code: its light is what a display makes of that.
        ("mobile", ((x / (x + 0.155) * 1.019 + 0.055) / 1.055).powf(2.4)),
    ];
    for (name, light) in curves {
        let args = ["--environment", "uniform:1,1,1", "--background", "0.4,0.4,0.4", "--exposure", UNIT_EXPOSURE];
        let found = shot(&folder, &[&args[..], &["--dither", "0", "--tone-map", name]].concat());
        let code = f64::from(found.codes.get_pixel(1, 1).0[1]);
        let expected = 255.0 * (1.055 * light.powf(1.0 / 2.4) - 0.055);
        assert!((code - expected).abs() < 1.0, "{name}: {code}, expected {expected}");
    }
}
