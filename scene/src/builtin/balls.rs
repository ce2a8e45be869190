//! `balls`: five materials that show an environment.

use glam::{DMat4, DVec3, Vec3};

use super::camera::camera;
use super::metal::METALS;
use crate::geometry::sphere;
use crate::material::{ClearCoat, Material, Sheen};
use crate::scene::Scene;

const RADIUS_M: f32 = 0.5;
const SPACING_M: f64 = 1.12;

/// Returns the scene. From left to right: smooth silver, gold of roughness 0.45, white of albedo 0.8, cloth with a
/// sheen, red metal under a clear coat.
pub(super) fn scene() -> Scene {
    let mut scene = Scene { name: "balls".into(), ..Scene::default() };
    let ball = scene.add_mesh(sphere(RADIUS_M, 96, 48));
    let [gold, silver, ..] = METALS;
    let sheen = Sheen { color: Vec3::new(0.75, 0.65, 0.95), roughness: 0.45, ..Sheen::default() };
    let coat = ClearCoat { factor: 1.0, roughness: 0.03, normal_scale: 1.0, ..ClearCoat::default() };
    let surfaces = [
        Material::metal("mirror", silver.f0, 0.0),
        Material::metal("rough metal", gold.f0, 0.45),
        Material::dielectric("white", Vec3::splat(0.8), 1.0),
        Material { sheen: Some(sheen), ..Material::dielectric("cloth", Vec3::new(0.10, 0.03, 0.20), 0.9) },
        Material { clear_coat: Some(coat), ..Material::metal("varnish", Vec3::new(0.65, 0.02, 0.02), 0.55) },
    ];
    let middle = (surfaces.len() - 1) as f64 / 2.0;
    for (index, surface) in surfaces.into_iter().enumerate() {
        let at = DVec3::new((index as f64 - middle) * SPACING_M, 0.0, 0.0);
        let name = surface.name.clone();
        let material = scene.add_material(surface);
        scene.add_instance(&name, ball, material, DMat4::from_translation(at));
    }
    scene.cameras.push(camera("front", DVec3::new(0.0, 0.35, 10.5), DVec3::ZERO, 19.0));
    scene.cameras.push(camera("wide", DVec3::new(0.0, 0.6, 8.8), DVec3::ZERO, 10.5));
    scene
}
