//! `glass`: transmissive materials before a colorful wall on a checkered ground.
//!
//! Back row: balls of glass by roughness. Middle row: by index of refraction. Front row: a tinted ball, a
//! tinted ring, an amber block, a thin wall clear and frosted.

use glam::{DMat4, DVec3, Vec2, Vec3};

use super::camera::camera;
use super::ground;
use crate::color::linear_from_hex;
use crate::geometry::{cuboid, plane, sphere, torus};
use crate::material::{Material, Transmission, Volume};
use crate::mesh::MeshId;
use crate::scene::Scene;

const RADIUS_M: f32 = 0.42;
const SPACING_M: f64 = 1.1;

pub(super) fn scene() -> Scene {
    let mut scene = Scene { name: "glass".into(), ..Scene::default() };
    surroundings(&mut scene);
    balls(&mut scene);
    bodies(&mut scene);
    let eye = DVec3::new(0.0, 4.2, 6.2);
    scene.cameras.push(camera("front", eye, DVec3::new(0.0, 0.35, -0.3), 38.0));
    let eye = DVec3::new(-0.6, 0.9, 3.4);
    scene.cameras.push(camera("close", eye, DVec3::new(-0.9, 0.45, 0.0), 38.0));
    scene
}

/// Returns clear glass with an index of refraction and a perceptual roughness; thin-walled without `volume`.
fn glass(name: &str, ior: f32, roughness: f32, volume: Option<Volume>) -> Material {
    Material {
        ior,
        transmission: Some(Transmission { factor: 1.0, texture: None, volume }),
        ..Material::dielectric(name, Vec3::ONE, roughness)
    }
}

fn ball_of(thickness: f32) -> Volume {
    Volume { thickness, ..Volume::default() }
}

/// Returns the transform of the object in `column` (0 to 4) of a row, `y` meters above the ground.
fn stand(column: usize, z: f64, y: f64) -> DMat4 {
    DMat4::from_translation(DVec3::new((column as f64 - 2.0) * SPACING_M, y, z))
}

fn surroundings(scene: &mut Scene) {
    ground::checkered(scene, [Vec3::splat(0.08), Vec3::splat(0.5)], 0.7, 1.0);
    // Stripes that make refraction visible.
    let stripe = scene.add_mesh(cuboid(Vec3::new(0.2, 0.8, 0.05)));
    for (column, hex) in
        [0xc8_2a_2a, 0xe8_e4_dc, 0xd8_a8_30, 0x1c_8a_3c, 0xe8_e4_dc, 0x1a_4c_b4, 0x80_30_a0, 0xe8_e4_dc]
            .into_iter()
            .enumerate()
    {
        let material = scene.add_material(Material::dielectric("stripe", linear_from_hex(hex), 0.8));
        let x = (column as f64 - 3.5) * 0.8;
        scene.add_instance("stripe", stripe, material, DMat4::from_translation(DVec3::new(x, 0.8, -2.6)));
    }
}

fn balls(scene: &mut Scene) {
    let ball = scene.add_mesh(sphere(RADIUS_M, 64, 32));
    let place = |scene: &mut Scene, mesh: MeshId, material: Material, column: usize, z: f64| {
        let name = material.name.clone();
        let material = scene.add_material(material);
        scene.add_instance(&name, mesh, material, stand(column, z, f64::from(RADIUS_M)));
    };
    for (column, roughness) in [0.0, 0.1, 0.2, 0.4, 0.7].into_iter().enumerate() {
        let name = format!("roughness {roughness:.1}");
        place(scene, ball, glass(&name, 1.5, roughness, Some(ball_of(2.0 * RADIUS_M))), column, -1.4);
    }
    for (column, ior) in [1.0, 1.1, 1.33, 1.8, 2.42].into_iter().enumerate() {
        let name = format!("index {ior:.2}");
        place(scene, ball, glass(&name, ior, 0.0, Some(ball_of(2.0 * RADIUS_M))), column, 0.0);
    }
}

fn bodies(scene: &mut Scene) {
    let tinted = |thickness: f32| Volume {
        thickness,
        attenuation_color: Vec3::new(0.1, 0.6, 0.45),
        attenuation_distance_m: 0.5,
        ..Volume::default()
    };
    let ball = scene.add_mesh(sphere(RADIUS_M, 64, 32));
    let ring = scene.add_mesh(torus(0.3, 0.12, 64, 32));
    let block = scene.add_mesh(cuboid(Vec3::new(0.3, 0.42, 0.15)));
    let pane = scene.add_mesh(plane(Vec2::splat(0.9), 1, Vec2::ONE));
    let upright = DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let mut place = |mesh: MeshId, material: Material, at: DMat4| {
        let name = material.name.clone();
        let material = scene.add_material(material);
        scene.add_instance(&name, mesh, material, at);
    };
    let z = 1.3;
    place(ball, glass("tinted", 1.5, 0.0, Some(tinted(2.0 * RADIUS_M))), stand(0, z, 0.42));
    let lean = DMat4::from_rotation_x(0.9);
    place(ring, glass("tinted ring", 1.5, 0.0, Some(tinted(0.24))), stand(1, z, 0.4) * lean);
    let amber = Volume { attenuation_color: Vec3::new(1.0, 0.45, 0.05), attenuation_distance_m: 0.3, ..ball_of(0.3) };
    place(block, glass("amber", 1.55, 0.05, Some(amber)), stand(2, z, 0.42) * DMat4::from_rotation_y(0.5));
    let wall = |name: &str, roughness| Material { double_sided: true, ..glass(name, 1.5, roughness, None) };
    place(pane, wall("clear wall", 0.0), stand(3, z, 0.45) * upright);
    place(pane, wall("frosted wall", 0.5), stand(4, z, 0.45) * upright);
}
