//! Image-based lighting on the default adapter, compared with brute force: bounds on the output of `ibl_errors`.

use crate::light_document::numbers;
use crate::stage;
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::ibl::{DfgSettings, DfgTable, IblSettings, ImageLight};
use framegraph_scene::environment::{Sh, ShBands, ShWindow, SunExtraction};
use framegraph_scene::{Environment, progress};
use framegraph_shader_mirrors::dfg::Visibility;
use framegraph_wgpu::Gpu;
use glam::DVec3;
use std::error::Error;
use tests::files::asset;
use tests::lookup::{self, Mapping};
use tests::measure::furnace::{Compensation, F0};
use tests::measure::harmonics::Scene;
use tests::measure::specular::Feature;
use tests::measure::{albedo, furnace, harmonics, specular};
use truth::albedo::Masking;
use truth::sphere::directions;

type TestResult = Result<(), Box<dyn Error>>;

fn light(gpu: &Gpu, environment: &Environment) -> Result<ImageLight, Box<dyn Error>> {
    let settings = IblSettings { cube_texels: 64, ..Default::default() };
    Ok(ImageLight::new(gpu, environment, &settings, &Cache::off(), &mut progress::silent)?)
}

fn table(gpu: &Gpu, texels: u32, visibility: Visibility) -> Result<DfgTable, Box<dyn Error>> {
    Ok(DfgTable::new(gpu, DfgSettings { texels, visibility }, &Cache::off(), &mut progress::silent)?)
}

/// The design's table: largest error and lowest value for two, three and five bands.
#[test]
fn harmonics_have_the_stated_error_and_a_wrong_band_is_detected() {
    let keep = |sh: Sh| sh;
    let bands = [ShBands::Two, ShBands::Three, ShBands::Five];
    for (scene, stated) in [
        (Scene::Sun, [(0.25, -0.25), (0.094, -0.040), (0.059, -0.031)]),
        (Scene::SunAndAmbient, [(0.21, -0.042), (0.078, 0.0), (0.049, 0.0)]),
    ] {
        let printed = numbers("Spherical harmonics", &[scene.name()]);
        for ((bands, (worst, lowest)), printed) in bands.into_iter().zip(stated).zip(&printed) {
            let e = harmonics::errors(scene, bands, ShWindow::None, 1500, keep);
            let apart = (e.worst - printed[0]).abs().max((e.lowest - printed[1]).abs());
            assert!(apart < 6e-5, "{scene:?} {bands:?}: {e:?}, and docs/measurements/image-light.md has {printed:?}");
            // The design's figures have two digits.
            assert!((e.worst - worst).abs() < 0.005 && (e.lowest - lowest).abs() < 0.005, "{scene:?} {bands:?}: {e:?}");
        }
    }
    let sky = harmonics::errors(Scene::Sky, ShBands::Three, ShWindow::None, 20, keep);
    assert!(sky.worst < 0.0065, "{sky:?}");
    for (window, worst) in
        [(ShWindow::Hann, 0.30), (ShWindow::Sinc, 0.21), (ShWindow::Laplacian { lambda: 0.01 }, 0.135)]
    {
        let e = harmonics::errors(Scene::Sun, ShBands::Three, window, 1500, keep);
        assert!((e.worst - worst).abs() < 0.005, "{window:?}: {e:?}");
        let printed = numbers("Spherical harmonics", &[&format!("{window:?}")]).concat();
        let apart = [e.worst, e.lowest, e.clamped].iter().zip(&printed).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(
            printed.len() == 3 && apart < 6e-5,
            "{window:?}: {e:?}, and docs/measurements/image-light.md has {printed:?}"
        );
    }
    let spoil = |sh: Sh| {
        let scale = |(i, c): (usize, &DVec3)| if i >= 4 { *c * 1.2 } else { *c };
        Sh::from_coefficients(sh.bands(), sh.radiance_coefficients().iter().enumerate().map(scale).collect())
    };
    let wrong = harmonics::errors(Scene::Sky, ShBands::Three, ShWindow::None, 20, spoil);
    assert!(wrong.worst > 0.0065, "a third band 20 % too strong: {wrong:?}");
}

/// The shader's irradiance matches the CPU's projection, in all three forms.
#[test]
fn irradiance_on_the_device_is_that_of_the_projection() -> TestResult {
    let Some(gpu) = stage::gpu("irradiance_on_the_device_is_that_of_the_projection") else { return Ok(()) };
    let environment = framegraph_scene::environment::Sky::default().environment(64)?;
    let normals = directions(200);
    let asked: Vec<[f32; 4]> = normals.iter().map(|n| n.as_vec3().extend(0.0).to_array()).collect();
    for bands in [ShBands::Two, ShBands::Three, ShBands::Five] {
        let settings = IblSettings { cube_texels: 64, bands, ..Default::default() };
        let light = ImageLight::new(&gpu, &environment, &settings, &Cache::off(), &mut progress::silent)?;
        let sh = Sh::project(&environment.map, bands);
        for (n, got) in normals.iter().zip(lookup::irradiance(&gpu, &light, &asked)?) {
            let exact = sh.irradiance_over_pi_at(*n).max(DVec3::ZERO);
            let apart = (DVec3::from_array(got) - exact).abs().max_element();
            assert!(apart < 2e-5 * f64::from(light.luminance_nits), "{bands:?} {n}: {got:?} for {exact}");
        }
        // The sun is a separate light, but the sky around it and the ground that it lights are bright.
        let toward = light.dominant_direction.ok_or("a sky has a bright side")?;
        let sun = -light.sun.as_ref().ok_or("the sun is up")?.direction;
        assert!(toward.dot(sun) > 0.5, "{toward}");
    }
    Ok(())
}

/// Uniform light: irradiance and every level of the cube equal it, and a perfect conductor reflects all of it.
#[test]
fn a_white_furnace_is_white() -> TestResult {
    let Some(gpu) = stage::gpu("a_white_furnace_is_white") else { return Ok(()) };
    let radiance = DVec3::new(0.5, 0.25, 1.0);
    let light = light(&gpu, &Environment::uniform(radiance)?)?;
    let mut asked = Vec::new();
    for (i, d) in directions(300).into_iter().enumerate() {
        asked.push(d.as_vec3().extend(i as f32 / 299.0).to_array());
    }
    let specular = lookup::specular(&gpu, &light, Mapping::Lod, &asked)?;
    let irradiance = lookup::irradiance(&gpu, &light, &asked)?;
    for got in specular.iter().chain(&irradiance) {
        // Powers of two are exact in every format; sums of samples have an error of 0.001.
        let apart = (DVec3::from_array(*got) / radiance - DVec3::ONE).abs().max_element();
        assert!(apart < 1e-3, "{got:?}");
    }
    let table = table(&gpu, 64, Visibility::Exact)?;
    let points: Vec<[f64; 2]> =
        (0..100).map(|i| [0.05 + 0.95 * f64::from(i % 10) / 9.0, f64::from(i / 10) / 9.0]).collect();
    for ([nov, r], [_, green, _]) in points.iter().zip(lookup::dfg(&gpu, &table, &points)?) {
        let given_back = green * (1.0 + (1.0 / green.max(0.3) - 1.0));
        assert!((given_back - 1.0).abs() < 1e-6, "{nov} {r}: {given_back}");
    }
    Ok(())
}

/// Radiance from 0.001 nits to the sun's disc is stored with a precision of six bits.
#[test]
fn any_photometric_range_fits() -> TestResult {
    let Some(gpu) = stage::gpu("any_photometric_range_fits") else { return Ok(()) };
    let asked: Vec<[f32; 4]> = directions(60).iter().map(|d| d.as_vec3().extend(0.4).to_array()).collect();
    for nits in [1e-3, 1.6e9] {
        let color = DVec3::new(1.0, 0.7, 0.3) * nits;
        let light = light(&gpu, &Environment::uniform(color)?)?;
        for got in lookup::specular(&gpu, &light, Mapping::Lod, &asked)? {
            let apart = (DVec3::from_array(got) / color - DVec3::ONE).abs().max_element();
            assert!(apart < 1.0 / 64.0, "{nits}: {got:?}");
        }
        let first = light.irradiance[0].truncate().as_dvec3();
        assert!((first / color - DVec3::ONE).abs().max_element() < 1e-6, "{nits}");
        let rest = light.irradiance[1..].iter().map(|c| f64::from(c.abs().max_element())).fold(0.0, f64::max);
        assert!(rest < 1e-6 * nits && light.dominant_direction.is_none(), "{nits}: {rest}");
    }
    Ok(())
}

/// Cached light equals computed light, bit for bit.
#[test]
fn light_from_the_cache_is_the_same_light() -> TestResult {
    let Some(gpu) = stage::gpu("light_from_the_cache_is_the_same_light") else { return Ok(()) };
    let folder = std::env::temp_dir().join(format!("same-light-{}", std::process::id()));
    let cache = Cache::at(&folder);
    let environment = framegraph_scene::environment::Sky::default().environment(64)?;
    let settings = IblSettings { cube_texels: 64, ..Default::default() };
    let mut asked = Vec::new();
    for (i, d) in directions(500).into_iter().enumerate() {
        asked.push(d.as_vec3().extend((i % 11) as f32 / 10.0).to_array());
    }
    let mut seen = Vec::new();
    for from_cache in [false, true] {
        let light = ImageLight::new(&gpu, &environment, &settings, &cache, &mut progress::silent)?;
        let table =
            DfgTable::new(&gpu, DfgSettings { texels: 32, ..Default::default() }, &cache, &mut progress::silent)?;
        assert_eq!((light.from_cache, table.from_cache), (from_cache, from_cache));
        let points = [[0.1, 0.3], [0.9, 0.9]];
        let specular = lookup::specular(&gpu, &light, Mapping::Lod, &asked)?;
        assert!(specular.iter().all(|got| got[2] > 0.0));
        seen.push((specular, lookup::irradiance(&gpu, &light, &asked)?, lookup::dfg(&gpu, &table, &points)?));
    }
    assert!(seen[0] == seen[1], "computed and found light differ");
    std::fs::remove_dir_all(folder)?;
    Ok(())
}

#[test]
fn the_cube_holds_what_lobes_gather_and_a_wrong_level_is_noticed() -> TestResult {
    let Some(gpu) = stage::gpu("the_cube_holds_what_lobes_gather_and_a_wrong_level_is_noticed") else { return Ok(()) };
    let disc = Feature::Disc(5.0);
    let light = specular::light_of(&gpu, disc, 512, [256, 5])?;
    // Roughness values of levels: errors of sampling, resolution and rounding. The program prints 3.5, 1.5, 1.0 and 0.6
    // % for a map four times as fine.
    for (roughness, bound) in [(0.133_975, 0.08), (0.292_893, 0.04), (0.5, 0.03), (1.0, 0.025)] {
        let e = specular::errors(&gpu, &light, disc, roughness, Mapping::Lod, 11)?;
        assert!(e.worst < bound, "roughness {roughness}: {e:?}");
    }
    // Between levels, the design states 47 % at 0.4 and 26 % at 0.7.
    let printed = numbers("Specular cube", &["disc of radius 5°", "256 → 16, 5"]);
    for (roughness, stated, column) in [(0.4, 0.47, 4), (0.7, 0.26, 6)] {
        let e = specular::errors(&gpu, &light, disc, roughness, Mapping::Lod, 11)?;
        assert!((e.worst - stated).abs() < 0.04, "roughness {roughness}: {e:?}");
        // The document's map is four times as fine.
        assert!((e.worst - printed[column][0]).abs() < 0.02, "roughness {roughness}: {e:?} for {:?}", printed[column]);
    }
    let wrong = specular::errors(&gpu, &light, disc, 0.5, Mapping::Linear, 11)?;
    assert!(wrong.worst > 0.2, "levels in proportion to roughness: {wrong:?}");
    let edge = specular::light_of(&gpu, Feature::Edge, 512, [256, 5])?;
    let e = specular::errors(&gpu, &edge, Feature::Edge, 0.5, Mapping::Lod, 11)?;
    assert!(e.worst < 0.01, "{e:?}");
    Ok(())
}

#[test]
fn tables_err_less_than_stated_and_the_wrong_term_is_noticed() -> TestResult {
    let Some(gpu) = stage::gpu("tables_err_less_than_stated_and_the_wrong_term_is_noticed") else { return Ok(()) };
    for (visibility, masking) in [(Visibility::Exact, Masking::Smith), (Visibility::Fast, Masking::Hammon)] {
        let e = albedo::errors(&gpu, &table(&gpu, 64, visibility)?, masking, 24)?;
        // Design 1.3 for 64²: at most 0.0057, and 0.036 for 1/E. Cloth: 4096 uniform samples.
        assert!(e.albedo < 0.0057 && e.fresnel < 0.0057 && e.compensation < 0.036 && e.cloth < 0.006, "{e:?}");
        // The document uses 400 points, this test 24, so its maximum is no larger.
        let printed = numbers("DFG tables", &[&format!("{visibility:?} 64²")]).concat();
        let found = [e.albedo, e.albedo_rms, e.fresnel, e.compensation, e.cloth];
        let near = |(found, printed): (&f64, &f64)| *found <= printed * 1.2 + 5e-5;
        assert!(
            found.iter().zip(&printed).all(near) && e.albedo_rms > 0.3 * printed[1],
            "{visibility:?}: {found:?} for {printed:?}"
        );
    }
    let wrong = albedo::errors(&gpu, &table(&gpu, 64, Visibility::Fast)?, Masking::Smith, 24)?;
    assert!(wrong.albedo > 0.05, "{wrong:?}");
    Ok(())
}

/// Compensation, compared with a random walk: the design's errors within the noise of 4000 paths.
#[test]
fn compensation_has_the_stated_error() -> TestResult {
    let Some(gpu) = stage::gpu("compensation_has_the_stated_error") else { return Ok(()) };
    let table = table(&gpu, 64, Visibility::Exact)?;
    let with = furnace::errors(&gpu, &table, Compensation::Table, 4000)?;
    // f0 = 1, 0.9, 0.6, 0.3, 0.04.
    for ((e, f0), (mean, worst)) in
        with.iter().zip(F0).zip([(0.0, 0.0), (0.005, 0.047), (0.016, 0.145), (0.021, 0.13), (0.034, -0.08)])
    {
        assert!((e.mean - mean).abs() < 0.006 && (e.worst - worst).abs() < 0.025, "f0 = {f0}: {e:?}");
    }
    for (e, printed) in with.iter().zip(numbers("White furnace: relative", &["Table"])) {
        assert!((e.mean - printed[0]).abs() < 0.006 && (e.worst - printed[1]).abs() < 0.025, "{e:?} for {printed:?}");
    }
    let [none, ..] = furnace::errors(&gpu, &table, Compensation::None, 100)?;
    assert!(none.mean > 0.15 && (none.worst + 0.69).abs() < 0.015, "the loss that is known: {none:?}");
    Ok(())
}

/// A map damaged by lossy compression, with radiance down to -1876. Clamped texels are counted, and the light is finite
/// and non-negative everywhere, with and without its sun.
#[test]
fn a_map_with_negative_radiance_becomes_sound_light() -> TestResult {
    let test = "a_map_with_negative_radiance_becomes_sound_light";
    let Some(gpu) = stage::gpu(test) else { return Ok(()) };
    let Some(path) = asset(test, "hdri/park_negative.exr") else { return Ok(()) };
    let environment = Environment::load(&path, &mut progress::silent)?;
    assert_eq!(environment.warnings.len(), 1);
    assert!(
        environment.warnings[0].contains("148 of 131072 texels had negative radiance"),
        "{:?}",
        environment.warnings
    );
    let mut asked = Vec::new();
    for (i, d) in directions(2000).into_iter().enumerate() {
        asked.push(d.as_vec3().extend((i % 11) as f32 / 10.0).to_array());
    }
    let mut apart = environment.clone();
    let found = apart.extract_sun();
    let SunExtraction::Extracted { light: sun, .. } = &found else { panic!("{found}") };
    asked.push((-sun.direction).extend(0.0).to_array());
    let mut brightest = Vec::new();
    for environment in [environment, apart] {
        let extract = environment.sun.is_some();
        let light = light(&gpu, &environment)?;
        assert_eq!(light.sun.is_some(), extract);
        let mut peak = 0.0_f64;
        for got in lookup::specular(&gpu, &light, Mapping::Lod, &asked)? {
            let sound = |c: f64| c.to_bits() & (0x7ff << 52) != 0x7ff << 52 && c >= 0.0;
            assert!(got.into_iter().all(sound), "{got:?}");
            peak = got.into_iter().fold(peak, f64::max);
        }
        assert!(light.irradiance.iter().all(|c| c.is_finite()) && light.luminance_nits > 0.0);
        brightest.push(peak);
    }
    assert!(brightest[1] < 0.5 * brightest[0], "without its sun the map is dimmer: {brightest:?}");
    Ok(())
}
