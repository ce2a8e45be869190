//! Sun extraction from synthetic and real maps.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::environment::*;
use crate::light::LightKind;
use crate::progress::silent;
use crate::test_files::file;

/// Returns a gradient of 1 to 2 with a disc of `radiance` and `radius_rad` toward `sun`.
fn with_disc(width: u32, sun: DVec3, radius_rad: f64, radiance: f64) -> EquirectMap {
    EquirectMap::from_fn(width, width / 2, |d| {
        let sky = DVec3::splat(1.5 + 0.5 * d.y);
        if d.dot(sun) > radius_rad.cos() { DVec3::new(1.0, 0.9, 0.7) * radiance } else { sky }
    })
}

fn environment(map: EquirectMap) -> Environment {
    Environment { name: "test".into(), map, sun: None, filtered: None, warnings: Vec::new() }
}

fn kind(light: &LightKind) -> (f64, f64) {
    match light {
        LightKind::Directional { illuminance_lux, angular_radius_rad } => {
            (f64::from(*illuminance_lux), f64::from(*angular_radius_rad))
        }
        other => panic!("a sun is directional, not {other:?}"),
    }
}

#[test]
fn a_known_disc_becomes_its_light() {
    let sun = DVec3::new(0.48, 0.6, -0.64);
    let (radius, radiance) = (0.012, 5e4);
    let mut environment = environment(with_disc(2048, sun, radius, radiance));
    let before: Vec<DVec3> = [sun, DVec3::Y, DVec3::NEG_X].map(|n| environment.map.irradiance(n)).to_vec();
    let found = environment.extract_sun();
    let SunExtraction::Extracted { light, texels, contrast } = &found else { panic!("{found}") };
    assert!(*contrast > 1e4 && *texels > 30, "{contrast} {texels}");
    let (lux, angular_radius) = kind(&light.kind);
    let solid_angle = TAU * (1.0 - radius.cos());
    let luminance = 0.2126 + 0.9 * 0.7152 + 0.7 * 0.0722;
    // The disc has 48 texels, so its area is inexact.
    assert!((lux / (radiance * luminance * solid_angle) - 1.0).abs() < 0.05, "{lux}");
    assert!((angular_radius / radius - 1.0).abs() < 0.03, "{angular_radius}");
    // Half a texel is 1.5 mrad.
    assert!((-light.direction.as_dvec3()).dot(sun) > (0.0015_f64).cos(), "{}", light.direction);
    assert!((light.color.y / light.color.x - 0.9).abs() < 1e-3);
    // The light and the remaining map give the original irradiance.
    let color = light.color.as_dvec3() * lux;
    for (n, before) in [sun, DVec3::Y, DVec3::NEG_X].into_iter().zip(before) {
        let direct = color * (-light.direction.as_dvec3()).dot(n).max(0.0);
        let after = environment.map.irradiance(n) + direct;
        assert!(((after - before) / before).abs().max_element() < 1e-5, "{n}: {after} for {before}");
    }
    assert!(environment.sun.as_ref() == Some(light));
    assert_eq!(environment.extract_sun(), SunExtraction::Apart);
}

#[test]
fn what_is_large_or_dim_is_no_sun() {
    let sun = DVec3::new(0.0, 0.6, 0.8);
    for map in [
        EquirectMap::from_fn(4, 2, |_| DVec3::ONE),
        EquirectMap::from_fn(64, 32, |_| DVec3::ZERO),
        with_disc(256, sun, 0.0, 0.0),
        with_disc(256, sun, 0.25, 1000.0),
        with_disc(256, sun, 0.02, 15.0),
    ] {
        let mut environment = environment(map.clone());
        let found = environment.extract_sun();
        assert!(matches!(found, SunExtraction::None { contrast } if contrast < 20.0), "{found}");
        assert!(environment.map == map && environment.sun.is_none());
    }
    // The sun of the procedural sky is separate.
    let mut sky = Sky::default().environment(64).expect("the default sky");
    assert_eq!(sky.extract_sun(), SunExtraction::Apart);
}

/// Suns of real maps are found where they are visible, and irradiance is conserved.
#[test]
fn real_suns_are_found_and_lamps_are_left() {
    for (name, elevation_deg) in [("park", Some(10.2)), ("sunset", Some(3.2)), ("venice", None), ("studio", None)] {
        let Some(path) = file(&format!("assets/hdri/{name}.hdr")) else { return };
        let mut environment = Environment::load(&path, &mut silent).expect("a good file");
        let before = environment.map.irradiance(DVec3::Y);
        let total = environment.map.average();
        let found = environment.extract_sun();
        println!("{name}: {found}");
        let Some(elevation) = elevation_deg else {
            assert!(matches!(found, SunExtraction::None { .. }), "{name}: {found}");
            continue;
        };
        let SunExtraction::Extracted { light, .. } = &found else { panic!("{name}: {found}") };
        let toward = -light.direction.as_dvec3();
        assert!((toward.y.asin().to_degrees() - elevation).abs() < 1.0, "{name}: {toward}");
        let (lux, radius) = kind(&light.kind);
        assert!(radius.to_degrees() > 0.3 && radius.to_degrees() < 1.5, "{name}: {}", radius.to_degrees());
        let after = environment.map.irradiance(DVec3::Y) + light.color.as_dvec3() * (lux * toward.y.max(0.0));
        assert!(((after - before) / before).abs().max_element() < 1e-4, "{name}: {after} for {before}");
        // Averages decrease by the flux of the light over 4π; the spread over its disc is 1e-4 of it.
        let fallen = (total - environment.map.average()) * 4.0 * PI;
        assert!((fallen / (light.color.as_dvec3() * lux) - 1.0).abs().max_element() < 1e-3, "{name}");
    }
}
