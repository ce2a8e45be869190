//! `lamps`: a yard at night with punctual lights of limited range, two thirds point lights and one third spot lights
//! that point down.

use glam::{DMat4, DVec2, DVec3, Vec2, Vec3};

use super::camera::camera;
use crate::geometry::{cuboid, plane, sphere};
use crate::light::{Light, LightKind};
use crate::material::{EmissiveUnit, Material};
use crate::scene::Scene;

/// Default number of lights.
pub(super) const COUNT: u32 = 1000;
/// Maximum number of lights.
pub(super) const MOST: u32 = 65_536;
const BULB_M: f32 = 0.05;
const CANDELA: f32 = 12.0;
const POINT_RANGE_M: f32 = 2.2;
const SPOT_RANGE_M: f32 = 3.5;
const COLORS: [[f32; 3]; 6] =
    [[1.0, 0.55, 0.25], [1.0, 0.25, 0.15], [0.9, 0.9, 0.4], [0.25, 0.8, 0.45], [0.25, 0.5, 1.0], [0.75, 0.35, 1.0]];

/// Returns the scene. The yard widens away from the camera like its view: from 6 m to 26 m on either side, over 40 m.
pub(super) fn scene(count: u32) -> Scene {
    let mut scene = Scene { name: "lamps".into(), ..Scene::default() };
    let floor = Material::dielectric("floor", Vec3::splat(0.32), 0.45);
    let floor = scene.add_material(floor);
    let ground = scene.add_mesh(plane(Vec2::splat(90.0), 8, Vec2::splat(45.0)));
    scene.add_instance("ground", ground, floor, DMat4::from_translation(DVec3::new(0.0, 0.0, -20.0)));
    blocks(&mut scene);

    let bulb = scene.add_mesh(sphere(BULB_M, 12, 8));
    let glowing = COLORS.map(|color| {
        let emissive = Vec3::from_array(color) * 60.0;
        scene.add_material(Material {
            emissive,
            emissive_unit: EmissiveUnit::Nits,
            ..Material::dielectric("bulb", Vec3::ZERO, 1.0)
        })
    });
    for number in 0..count {
        let spread = spread(number + 1);
        let is_spot = number % 3 == 2;
        let height_m = if is_spot { 2.4 } else { 0.25 + 0.9 * f64::from(number % 7) / 6.0 };
        let at = place(spread, height_m);
        let hue = number as usize % COLORS.len();
        let kind = if is_spot {
            LightKind::Spot {
                intensity_candela: 4.0 * CANDELA,
                range_m: Some(SPOT_RANGE_M),
                inner_cone_rad: 0.2,
                outer_cone_rad: 0.5,
            }
        } else {
            LightKind::Point { intensity_candela: CANDELA, range_m: Some(POINT_RANGE_M) }
        };
        let color = Vec3::from_array(COLORS[hue]);
        scene.lights.push(Light { kind, color, position: at, ..Light::directional("lamp", Vec3::NEG_Y, 0.0) });
        scene.add_instance("bulb", bulb, glowing[hue], DMat4::from_translation(at));
    }
    scene.cameras.push(camera("gate", DVec3::new(0.0, 7.5, 11.0), DVec3::new(0.0, 0.0, -10.0), 42.0));
    scene.cameras.push(camera("ground", DVec3::new(0.5, 1.2, 2.0), DVec3::new(-2.0, 0.8, -10.0), 60.0));
    scene
}

/// Returns a point of a low-discrepancy sequence over the unit square (Roberts, "The Unreasonable Effectiveness of
/// Quasirandom Sequences", 2018).
fn spread(number: u32) -> DVec2 {
    let ratio = 1.324_717_957_244_746;
    (f64::from(number) * DVec2::new(1.0 / ratio, 1.0 / (ratio * ratio))).fract()
}

/// Returns a position in the yard. The square root gives the wide far rows the density of the near ones.
fn place(spread: DVec2, height_m: f64) -> DVec3 {
    let depth = (spread.y * (1.0 - 0.053) + 0.053).sqrt();
    DVec3::new((2.0 * spread.x - 1.0) * 26.0 * depth, height_m, 12.0 - 52.0 * depth)
}

/// Adds upright stone blocks of different heights.
fn blocks(scene: &mut Scene) {
    let stone = Material::dielectric("stone", Vec3::new(0.50, 0.47, 0.42), 0.8);
    let stone = scene.add_material(stone);
    for number in 0..120_u32 {
        let height_m = 0.4 + 0.35 * f64::from(number % 5);
        let mesh = scene.add_mesh(cuboid(Vec3::new(0.3, 0.5 * height_m as f32, 0.3)));
        let turned = DMat4::from_rotation_y(f64::from(number) * 0.7);
        let at = place(spread(number * 13 + 7), 0.5 * height_m);
        scene.add_instance("block", mesh, stone, DMat4::from_translation(at) * turned);
    }
}
