//! Clear sky and sun.

use std::f64::consts::PI;

use glam::DVec3;

use crate::color::luminance_from_rec709;
use crate::environment::*;
use crate::light::{Light, LightKind};

/// Photometric values of a clear sky with the sun at 40° (IES RP-21). The sky gives 0.8 + 15.5 √sin 40° = 13.2 klx on
/// the ground, the sun 127.5 e^(−0.21 m) = 92 klx. The sky is blue away from the sun.
#[test]
fn the_sky_is_photometrically_plausible() {
    let sky = Sky::default();
    let environment = sky.environment(256).expect("the default sky");
    let sun = environment.sun.as_ref().expect("the sun is up");
    let LightKind::Directional { illuminance_lux, angular_radius_rad } = sun.kind else {
        panic!("the sun is a directional light");
    };
    assert!((91_000.0..93_000.0).contains(&illuminance_lux), "{illuminance_lux}");
    assert!((angular_radius_rad.to_degrees() - 0.2666).abs() < 1e-3);
    assert!((sun.direction.as_dvec3() + sky.toward_sun).length() < 1e-6);
    let luminance = luminance_from_rec709(sun.color.as_dvec3());
    assert!((luminance - 1.0).abs() < 1e-4 && sun.color.x > sun.color.z);

    let model = SkyModel::new(&sky).expect("the default sky");
    let away = DVec3::new(-sky.toward_sun.x, 0.8, -sky.toward_sun.z).normalize();
    let blue = model.radiance(away);
    assert!(blue.z > 1.5 * blue.x, "{blue}");
    let mut sky_lux = 0.0;
    environment.map.for_each_texel(|d, solid_angle, radiance| {
        assert!(radiance.min_element() >= 0.0 && radiance.is_finite());
        if d.y > 0.0 {
            sky_lux += luminance_from_rec709(radiance) * d.y * solid_angle;
        }
    });
    // 1 % for the integration, and for some blue clipped by the gamut.
    assert!((sky_lux / 13_227.0 - 1.0).abs() < 0.01, "{sky_lux} lx");
    // The ground reflects a fifth of the light of sun and sky.
    let ground = luminance_from_rec709(model.radiance(DVec3::NEG_Y));
    let expected = 0.2 * (sky_lux + f64::from(illuminance_lux) * sky.toward_sun.y) / PI;
    assert!((ground / expected - 1.0).abs() < 0.02, "{ground} for {expected}");
}

#[test]
fn a_low_sun_is_dim_and_red_and_none_shines_from_below() {
    let at = |elevation_deg: f64| {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        sun_light(DVec3::new(cos, sin, 0.0), 2.5)
    };
    let lux = |light: &Light| match light.kind {
        LightKind::Directional { illuminance_lux, .. } => illuminance_lux,
        _ => 0.0,
    };
    let (high, low) = (at(80.0).expect("up"), at(2.0).expect("up"));
    assert!(lux(&high) > 100_000.0 && lux(&low) < 10_000.0);
    assert!(low.color.x / low.color.z > 10.0 * high.color.x / high.color.z);
    assert!(at(0.0).is_none() && at(-5.0).is_none());
    assert!(at(1e-9).expect("just up").color.is_finite());
}

#[test]
fn sky_parameters_out_of_range_are_named() {
    let fails = |sky: Sky, width: u32, word: &str| {
        let error = sky.environment(width).expect_err(word).to_string();
        assert!(error.contains(word), "{error}");
    };
    let sky = Sky::default();
    fails(Sky { toward_sun: DVec3::NEG_Y, ..sky }, 64, "sun direction");
    fails(Sky { toward_sun: DVec3::ZERO, ..sky }, 64, "sun direction");
    fails(Sky { toward_sun: DVec3::NAN, ..sky }, 64, "sun direction");
    fails(Sky { turbidity: 1.0, ..sky }, 64, "turbidity");
    fails(Sky { turbidity: f64::NAN, ..sky }, 64, "turbidity");
    fails(Sky { ground_albedo: DVec3::splat(1.5), ..sky }, 64, "ground albedo");
    fails(sky, 0, "sky width");
    assert!(Environment::uniform(DVec3::NEG_ONE).is_err());
    assert!(Environment::uniform(DVec3::INFINITY).is_err());
    let uniform = Environment::uniform(DVec3::splat(0.5)).expect("a plain radiance");
    assert!((uniform.average_luminance_nits() - 0.5).abs() < 1e-6);
}
