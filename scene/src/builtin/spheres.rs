//! `spheres`: balls by metallic (rows) and roughness (columns).

use glam::{DMat4, DVec3, Vec3};

use super::camera::camera;
use super::ground;
use crate::geometry::sphere;
use crate::material::Material;
use crate::scene::Scene;

const COLUMNS: u32 = 7;
const ROWS: u32 = 5;
const RADIUS_M: f32 = 0.45;

/// Returns the scene. Roughness grows from 0 to 1 from left to right, metallic from 0 to 1 from back to front.
pub(super) fn scene() -> Scene {
    let mut scene = Scene { name: "spheres".into(), ..Scene::default() };
    let ball = scene.add_mesh(sphere(RADIUS_M, 64, 32));
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let roughness = column as f32 / (COLUMNS - 1) as f32;
            let metallic = row as f32 / (ROWS - 1) as f32;
            let name = format!("metallic {metallic:.2} roughness {roughness:.2}");
            let material = scene.add_material(Material {
                metallic,
                ..Material::dielectric(&name, Vec3::new(0.95, 0.55, 0.18), roughness)
            });
            let at = DVec3::new(
                (f64::from(column) - f64::from(COLUMNS - 1) / 2.0) * 1.1,
                f64::from(RADIUS_M),
                (f64::from(row) - f64::from(ROWS - 1) / 2.0) * 1.3,
            );
            scene.add_instance(&name, ball, material, DMat4::from_translation(at));
        }
    }

    ground::checkered(&mut scene, [Vec3::splat(0.16), Vec3::splat(0.30)], 0.6, 2.0);
    let eye = DVec3::new(0.0, 7.0, 8.2);
    scene.cameras.push(camera("front", eye, DVec3::new(0.0, 0.0, 0.2), 38.0));
    let eye = DVec3::new(3.2, 0.7, 4.4);
    scene.cameras.push(camera("low", eye, DVec3::new(-0.5, 0.3, 0.0), 40.0));
    scene
}
