//! Environments from Khronos textures, written by an independent encoder: exact values and correct lighting.

use crate::stage::gpu;
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::ibl::{IblSettings, ImageLight};
use framegraph_scene::environment::{Environment, ShBands, SunExtraction};
use framegraph_scene::{LoadOptions, Memory, progress};
use glam::DVec3;
use std::error::Error;
use std::path::Path;
use tests::cube_file::{CubeFile, Texels};

type TestResult = Result<(), Box<dyn Error>>;

/// Returns light that differs in every direction and channel, above 0 and at most 7.
fn light(d: DVec3) -> DVec3 {
    DVec3::new(3.0 + 2.0 * d.x + d.y * d.z, 2.0 + d.y, 1.0 + 0.5 * d.z + 0.25 * d.x * d.y)
}

/// Integrates radiance with nine polynomials over the sphere, scaled as by `cmgen`: squared basis factors times the
/// cosine's over π (Ramamoorthi and Hanrahan 2001; Sloan 2008). The integral is a sum over a point lattice.
fn harmonics(radiance: impl Fn(DVec3) -> DVec3) -> Vec<DVec3> {
    use std::f64::consts::PI;
    let count = 20_000;
    let mut sums = vec![DVec3::ZERO; 9];
    for i in 0..count {
        let y = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
        let d = DVec3::new((1.0 - y * y).sqrt() * cos, y, (1.0 - y * y).sqrt() * sin);
        let polynomials =
            [1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3.0 * d.z * d.z - 1.0, d.z * d.x, d.x * d.x - d.y * d.y];
        for (sum, p) in sums.iter_mut().zip(polynomials) {
            *sum += radiance(d) * (p * 4.0 * PI / f64::from(count));
        }
    }
    let squares = [0.25, 0.75, 0.75, 0.75, 3.75, 3.75, 0.3125, 3.75, 0.9375].map(|k: f64| k / PI);
    let cosine = |i: usize| [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25][i];
    sums.iter().enumerate().map(|(i, sum)| *sum * (squares[i] * cosine(i))).collect()
}

fn load(bytes: &[u8]) -> Result<Environment, String> {
    let options = LoadOptions { memory: Memory::new(64 << 20).into(), ..LoadOptions::default() };
    let loaded = Environment::load_bytes(Path::new("a/cube.ktx"), bytes, &options, &mut progress::silent);
    loaded.map_err(|error| error.to_string())
}

/// Returns the largest error of a cube's map in excess of half a texel's slope and the format's rounding.
fn shows(environment: &Environment, error: f64) -> f64 {
    let mut worst = 0.0_f64;
    environment.map.for_each_texel(|direction, _, radiance| {
        let apart = (radiance - light(direction)).abs().max_element() - error * light(direction).max_element();
        worst = worst.max(apart);
    });
    worst
}

/// Every format in both versions and byte orders, with each texel in its position.
#[test]
fn cubes_are_read_to_the_precision_of_their_texels() {
    let cube = CubeFile::new(32, 1, |_, d| light(d));
    for texels in Texels::ALL {
        let files = [cube.ktx1(texels, false), cube.ktx1(texels, true), cube.ktx2(texels)];
        for (index, file) in files.iter().enumerate() {
            let environment = load(file).unwrap_or_else(|error| panic!("{texels:?} {index}: {error}"));
            assert_eq!((environment.map.width(), environment.map.height()), (128, 64));
            assert!(environment.filtered.is_none() && environment.warnings.is_empty(), "{texels:?} {index}");
            // Bilinear filtering has an error proportional to curvature, or to slope at the corners of faces.
            let worst = shows(&environment, texels.error());
            assert!(worst < 0.04, "{texels:?} {index}: off by {worst}");
        }
    }
    // Negative control: one face exchanged with its neighbor.
    let mut wrong = cube.clone();
    wrong.levels[0].rotate_right(32 * 32);
    let environment = load(&wrong.ktx2(Texels::Rgba32)).expect("a sound file");
    assert!(shows(&environment, 0.0) > 1.0, "the control is not noticed");
}

/// A file with irradiance is prefiltered light: its levels and harmonics are used unchanged.
#[test]
fn irradiance_makes_a_cube_filtered_light() -> TestResult {
    let factors = harmonics(light);
    let dimmer = |level: u32, d: DVec3| light(d) / f64::from(1 + level);
    let cube = CubeFile::new(16, 3, dimmer).with_sh(&factors);
    for file in [cube.ktx1(Texels::Rg11b10, false), cube.ktx1(Texels::Rg11b10, true), cube.ktx2(Texels::Rg11b10)] {
        let mut environment = load(&file)?;
        let filtered = environment.filtered.clone().ok_or("it is filtered")?;
        assert_eq!((filtered.size_texels, filtered.levels.len(), filtered.sh.bands()), (16, 3, ShBands::Three));
        for (stated, found) in cube.levels.iter().flatten().zip(filtered.levels.iter().flatten()) {
            let found = DVec3::new(found[0].into(), found[1].into(), found[2].into());
            assert!((*stated - found).abs().max_element() <= stated.max_element() / 64.0, "{stated}: {found}");
        }
        for (stated, found) in factors.iter().zip(filtered.sh.irradiance_over_pi()) {
            let apart = *stated - glam::Vec3::from(found).as_dvec3();
            // Nine decimals in the file, then f32.
            assert!(apart.abs().max_element() < 1e-6, "{stated}: {found:?}");
        }
        // The stated harmonics agree with the map's own irradiance, summed over texels.
        for normal in [DVec3::X, DVec3::NEG_Y, DVec3::new(0.6, 0.0, 0.8)] {
            let summed = environment.map.irradiance(normal) / std::f64::consts::PI;
            let apart = (filtered.sh.irradiance_over_pi_at(normal) - summed).abs().max_element();
            assert!(apart < 0.03, "{normal}: {summed}, off by {apart}");
        }
        assert_eq!(environment.extract_sun(), SunExtraction::Filtered);
    }
    // A single level cannot be prefiltered light.
    let single = CubeFile { levels: cube.levels[..1].to_vec(), ..cube.clone() };
    assert!(load(&single.ktx1(Texels::Rg11b10, false))?.filtered.is_none());
    Ok(())
}

/// On the device, the file's light is used, regardless of the settings.
#[test]
fn filtered_light_is_taken_as_it_is() -> TestResult {
    let Some(gpu) = gpu("filtered_light_is_taken_as_it_is") else { return Ok(()) };
    let factors = harmonics(light);
    // Brighter than the range of half floats, so that the cube is scaled.
    let cube = CubeFile::new(16, 5, |_, d| light(d) * 2e4).with_sh(&factors);
    let environment = load(&cube.ktx1(Texels::Rgba32, false))?;
    let settings = IblSettings { bands: ShBands::Five, ..IblSettings::default() };
    let made = ImageLight::new(&gpu, &environment, &settings, &Cache::off(), &mut progress::silent)?;
    assert_eq!((made.cube_texels, made.level_count, made.roughness_one_lod), (16, 5, 4.0));
    assert_eq!((made.bands, made.texel_nits, made.from_cache), (ShBands::Three, 4.0, false));
    for (stated, found) in factors.iter().zip(made.irradiance) {
        assert!((*stated - found.truncate().as_dvec3()).abs().max_element() < 1e-6, "{stated}: {found}");
    }
    let toward = made.dominant_direction.ok_or("it is uneven")?;
    // Red, a fifth of luminance, points to +x with strength 2; green, most of it, to +y with strength 1.
    assert!(toward.y > toward.x && toward.x > 0.4, "{toward}");
    Ok(())
}

/// Errors are one line each, and sizes claimed by a file are checked before allocation.
#[test]
fn broken_cubes_are_errors_of_one_line() {
    let cube = CubeFile::new(4, 2, |_, d| light(d)).with_sh(&harmonics(light));
    let (first, second) = (cube.ktx1(Texels::Rg11b10, false), cube.ktx2(Texels::Rg11b10));
    assert!(load(&first).is_ok() && load(&second).is_ok());
    let with = |file: &[u8], at: usize, word: u32| {
        let mut file = file.to_vec();
        file[at..at + 4].copy_from_slice(&word.to_le_bytes());
        file
    };
    let text = |sh: &str| CubeFile { sh: Some(sh.into()), ..cube.clone() }.ktx1(Texels::Rg11b10, false);
    for (file, word) in [
        (first[..60].to_vec(), "ends within its header"),
        (first[..first.len() - 1].to_vec(), "ends within its levels"),
        (with(&first, 12, 7), "endianness is 0x00000007"),
        (with(&first, 28, 0x8058), "OpenGL format 0x8058"),
        (with(&first, 36, 8), "8×4, not square"),
        (with(&with(&first, 36, 1 << 30), 40, 1 << 30), "over the limit of 4096"),
        (with(&with(&first, 36, 0), 40, 0), "0×0"),
        (with(&first, 48, 2), "2 layers"),
        (with(&first, 52, 1), "1 faces"),
        (with(&first, 56, 9), "9 levels"),
        (with(&first, 60, u32::MAX), "ends within its metadata"),
        (with(&first, 64, 1 << 20), "ends within its metadata"),
        (text("1 2 3"), "nine lines"),
        (text(&"1 2 inf\n".repeat(9)), "nine lines"),
        (text(&"1 2 3\n".repeat(10)), "nine lines"),
        (second[..70].to_vec(), "ends within its header"),
        (second[..second.len() - 1].to_vec(), "ends within its levels"),
        (with(&second, 12, 37), "Vulkan format 0x25"),
        (with(&second, 44, 2), "supercompressed (scheme 2)"),
        (with(&second, 80, u32::MAX), "ends within its levels"),
        (with(&second, 84, u32::MAX), "ends within its levels"),
        (with(&second, 88, 100), "level 0 has 100 bytes, not 384"),
        (with(&second, 56, u32::MAX), "ends within its metadata"),
    ] {
        let error = load(&file).expect_err(word);
        assert!(error.starts_with("a/cube.ktx: ") && error.contains(word) && !error.contains('\n'), "{word}: {error}");
    }
    // Twelve levels of a small cube are rejected, and so is a cube that exceeds the memory budget.
    let large = CubeFile::new(1024, 1, |_, _| DVec3::ONE).ktx2(Texels::Rg11b10);
    assert!(load(&large).is_err_and(|error| error.contains("a cube of 1024²") && error.contains("--memory")));
}
