//! Punctual lights: cones, ranges, distances, and an eye far from the world's origin.

use crate::stage::{gpu, lighting};
use framegraph_passes::Shading;
use framegraph_passes::light::shading::LightWindow;
use framegraph_scene::light::LightKind;
use framegraph_scene::{Environment, Light, Material, Specular};
use glam::{DMat4, DVec3, Vec3};
use std::error::Error;
use std::f64::consts::PI;
use tests::measure::board::{Board, Eye, card};
use truth::surface::Surface;

type TestResult = Result<(), Box<dyn Error>>;

const ALBEDO: DVec3 = DVec3::new(0.9, 0.7, 0.5);
const NORMAL: DVec3 = DVec3::new(0.36, -0.48, 0.8);
const TANGENT: DVec3 = DVec3::new(0.8, 0.6, 0.0);
const COLOR: DVec3 = DVec3::new(1.0, 0.5, 0.25);
/// Half angles of a spot light in radians, unlike any other number here.
const CONES: [f64; 2] = [0.5, 0.9];

/// Returns the illuminance of a light over π on a surface that faces it, by KHR_lights_punctual; `axis` is that of a
/// spot light.
fn over_pi(candela: f64, range_m: Option<f64>, axis: Option<DVec3>, to_lamp: DVec3) -> f64 {
    let distance = to_lamp.length();
    let window = range_m.map_or(1.0, |range| (1.0 - (distance / range).powi(4)).clamp(0.0, 1.0));
    let cone = axis.map_or(1.0, |axis| {
        let [inner, outer] = CONES.map(f64::cos);
        let cos = axis.dot(-to_lamp / distance);
        ((cos - outer) / (inner - outer)).clamp(0.0, 1.0).powi(2)
    });
    candela * window * cone / (distance * distance * PI)
}

struct Lamp {
    at: DVec3,
    candela: f64,
    range_m: Option<f64>,
    axis: Option<DVec3>,
}

impl Lamp {
    fn light(&self, origin: DVec3) -> Light {
        let (intensity_candela, range_m) = (self.candela as f32, self.range_m.map(|r| r as f32));
        let [inner_cone_rad, outer_cone_rad] = CONES.map(|angle| angle as f32);
        let kind = match self.axis {
            None => LightKind::Point { intensity_candela, range_m },
            Some(_) => LightKind::Spot { intensity_candela, range_m, inner_cone_rad, outer_cone_rad },
        };
        let direction = self.axis.unwrap_or(DVec3::NEG_Y).as_vec3();
        let base = Light::directional("lamp", direction, 0.0);
        Light { kind, color: COLOR.as_vec3(), position: origin + self.at, ..base }
    }
}

/// Creates a row of white and metal cards below a light, which sees them at every angle.
fn row(eye: Eye, origin: DVec3) -> (Board, Vec<Surface>) {
    let mut board = Board { eye, origin, ..Board::default() };
    let none = Some(Specular { factor: 0.0, ..Specular::default() });
    let materials = [
        Material { specular: none, ..Material::dielectric("chalk", ALBEDO.as_vec3(), 1.0) },
        Material::metal("metal", Vec3::new(0.9, 0.7, 0.5), 0.5),
    ];
    let surfaces = [Surface::chalk(ALBEDO, NORMAL), Surface::metal_rough(ALBEDO, 1.0, 0.5, 0.04, NORMAL)];
    let surfaces = (0..20).map(|index: usize| {
        board.hang(materials[index % 2].clone(), card(0.9, NORMAL, TANGENT, 1.0), DMat4::IDENTITY);
        surfaces[index % 2]
    });
    let surfaces = surfaces.collect();
    (board, surfaces)
}

/// Compares each card under each light with the formulas, seen from an eye at `origin`.
fn check(name: &str, eye: Eye, origin: DVec3) -> TestResult {
    let Some(gpu) = gpu(name) else { return Ok(()) };
    let shading = Shading { compensate_punctual: false, ..Shading::default() };
    let dark = Environment::uniform(DVec3::ZERO)?;
    let axis = DVec3::new(0.28, 0.0, -0.96);
    let lamps = [
        ("point", Lamp { at: DVec3::new(8.0, 0.5, 2.0), candela: 60.0, range_m: None, axis: None }),
        ("point with a range", Lamp { at: DVec3::new(8.0, 0.5, 2.0), candela: 60.0, range_m: Some(6.0), axis: None }),
        ("spot", Lamp { at: DVec3::new(8.0, 0.5, 3.0), candela: 90.0, range_m: None, axis: Some(axis) }),
        (
            "spot with a range",
            Lamp { at: DVec3::new(8.0, 0.5, 3.0), candela: 90.0, range_m: Some(5.0), axis: Some(axis) },
        ),
    ];
    for (what, lamp) in lamps {
        let (mut board, surfaces) = row(eye, origin);
        board.scene.lights = vec![lamp.light(origin)];
        let seen = board.render_lit(&gpu, lighting(&gpu, &dark, &shading)?, &shading)?;
        let mut lit = 0;
        for (index, surface) in surfaces.iter().enumerate() {
            let to_lamp = origin + lamp.at - board.middle(index);
            let share = over_pi(lamp.candela, lamp.range_m, lamp.axis, to_lamp);
            let expected = COLOR * surface.per_light(board.toward_viewer(index), to_lamp.normalize()) * share;
            // Half floats; at the edge of a cone or range, only the center of a card is exact.
            let apart = (seen[index].nits - expected).abs() - 3e-3 * expected;
            assert!(apart.max_element() < 3e-4, "{what}, card {index}: {} for {expected}", seen[index].nits);
            lit += usize::from(expected.x > 0.01);
        }
        // Some cards are inside the cone and range, and some outside.
        assert!(lit > 4 && (lamp.range_m.is_none() && lamp.axis.is_none() || lit < 20), "{what}: {lit} are lit");
    }
    Ok(())
}

#[test]
fn cones_and_ranges_are_those_of_the_specification() -> TestResult {
    check("cones_and_ranges_are_those_of_the_specification", Eye::Parallel, DVec3::ZERO)
}

/// At 100 km, f32 has steps of 8 mm; uploaded positions are relative to the eye.
#[test]
fn a_hundred_kilometers_from_the_origin_nothing_changes() -> TestResult {
    let origin = DVec3::new(1e5 + 0.123, -7e4 - 0.371, 9e4 + 0.777);
    check("a_hundred_kilometers_from_the_origin_nothing_changes", Eye::Perspective, origin)
}

/// Filament's options: squared range window, and lights that fade with the distance from the eye.
#[test]
fn filaments_window_and_far_fade_are_options() -> TestResult {
    let Some(gpu) = gpu("filaments_window_and_far_fade_are_options") else { return Ok(()) };
    // Cards are 5 to 11 m from the eye, so the fade ends within the row.
    let (range_m, far_m) = (9.0_f64, 9.6_f64);
    let plain = Shading { compensate_punctual: false, ..Shading::default() };
    let shading = Shading { light_window: LightWindow::Filament, light_fade_m: Some(far_m as f32), ..plain };
    let dark = Environment::uniform(DVec3::ZERO)?;
    let lamp = Lamp { at: DVec3::new(6.0, 0.5, 2.0), candela: 60.0, range_m: Some(range_m), axis: None };
    let (mut board, surfaces) = row(Eye::Perspective, DVec3::ZERO);
    board.scene.lights = vec![lamp.light(DVec3::ZERO)];
    let seen = board.render_lit(&gpu, lighting(&gpu, &dark, &shading)?, &shading)?;
    let (mut full, mut partly, mut none) = (0, 0, 0);
    for (index, surface) in surfaces.iter().enumerate() {
        let middle = board.middle(index);
        let to_lamp = lamp.at - middle;
        let window = (1.0 - (to_lamp.length() / range_m).powi(4)).clamp(0.0, 1.0);
        let fade = (5.0 - 5.0 * ((middle - board.camera_m()).length() / far_m).powi(2)).clamp(0.0, 1.0);
        let share = over_pi(lamp.candela, lamp.range_m, None, to_lamp) * window * fade;
        let expected = COLOR * surface.per_light(board.toward_viewer(index), to_lamp.normalize()) * share;
        // Half floats; the center of a card is compared, which is imprecise where the fade is steep.
        let apart = (seen[index].nits - expected).abs() - 3e-3 * expected;
        assert!(apart.max_element() < 2e-3, "card {index}: {} for {expected}, fade {fade}", seen[index].nits);
        full += usize::from(fade == 1.0 && window > 0.0 && expected.x > 0.01);
        partly += usize::from((0.1..0.9).contains(&fade) && expected.x > 0.01);
        none += usize::from(fade == 0.0);
    }
    assert!(full > 2 && partly > 0 && none > 0, "{full} are lit, {partly} fade, {none} are beyond");
    Ok(())
}

/// Lights add up, also a directional light beside the sun, and colors are applied.
#[test]
fn lights_add_up() -> TestResult {
    let Some(gpu) = gpu("lights_add_up") else { return Ok(()) };
    let shading = Shading { compensate_punctual: false, ..Shading::default() };
    let (mut board, surfaces) = row(Eye::Perspective, DVec3::new(3.0, 4.0, -5.0));
    let toward = [DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.48, 0.36, 0.8)];
    let sun = Light::directional("sun", -toward[0].as_vec3(), 2.0 * PI as f32);
    let fill = Light::directional("fill", -toward[1].as_vec3(), PI as f32);
    let point = Lamp { at: DVec3::new(4.0, 0.5, 2.0), candela: 30.0, range_m: None, axis: None };
    board.scene.lights =
        vec![Light { color: Vec3::X, ..fill }, point.light(board.origin), Light { color: Vec3::Y, ..sun }];
    let dark = Environment::uniform(DVec3::ZERO)?;
    let seen = board.render_lit(&gpu, lighting(&gpu, &dark, &shading)?, &shading)?;
    for (index, surface) in surfaces.iter().enumerate() {
        let view = board.toward_viewer(index);
        let to_point = board.origin + point.at - board.middle(index);
        let expected = surface.per_light(view, toward[0]) * DVec3::Y * 2.0
            + surface.per_light(view, toward[1]) * DVec3::X
            + COLOR * surface.per_light(view, to_point.normalize()) * over_pi(30.0, None, None, to_point);
        let apart = (seen[index].nits - expected).abs() - 3e-3 * expected;
        assert!(apart.max_element() < 3e-4, "card {index}: {} for {expected}", seen[index].nits);
    }
    Ok(())
}
