//! `optics`: thin films, dispersion and diffuse transmission, a row for each.
//!
//! From back to front: a sheet by diffuse transmission; a thin film on a black dielectric by thickness, then on
//! titanium by index of refraction; glass by dispersion. The quantity grows from left to right.

use glam::{DMat4, DVec3, Vec2, Vec3};

use super::camera::camera;
use super::ground;
use super::metal::METALS;
use crate::color::linear_from_hex;
use crate::geometry::{plane, sphere};
use crate::material::{DiffuseTransmission, Iridescence, Material, Transmission, Volume};
use crate::mesh::MeshId;
use crate::scene::Scene;

const COLUMNS: u32 = 6;
const RADIUS_M: f32 = 0.45;

pub(super) fn scene() -> Scene {
    let mut scene = Scene { name: "optics".into(), ..Scene::default() };
    ground::checkered(&mut scene, [Vec3::splat(0.08), Vec3::splat(0.5)], 0.6, 0.5);
    let ball = scene.add_mesh(sphere(RADIUS_M, 64, 32));
    let sheet = scene.add_mesh(plane(Vec2::splat(2.0 * RADIUS_M), 1, Vec2::ONE));
    let level = DMat4::IDENTITY;
    // Upright, with the back toward the sky behind.
    let upright = DMat4::from_rotation_x(1.2);
    let rows: [(MeshId, DMat4, fn(u32) -> Material); 4] =
        [(sheet, upright, leaf), (ball, level, film), (ball, level, film_on_metal), (ball, level, glass)];
    for (row, (mesh, turned, material)) in rows.into_iter().enumerate() {
        for column in 0..COLUMNS {
            let material = material(column);
            let name = material.name.clone();
            let material = scene.add_material(material);
            let x = (f64::from(column) - f64::from(COLUMNS - 1) / 2.0) * 1.15;
            let at = DVec3::new(x, f64::from(RADIUS_M), (row as f64 - 1.5) * 1.25);
            scene.add_instance(&name, mesh, material, DMat4::from_translation(at) * turned);
        }
    }
    scene.cameras.push(camera("front", DVec3::new(0.0, 5.2, 7.2), DVec3::new(0.0, 0.2, 0.0), 38.0));
    scene.cameras.push(camera("close", DVec3::new(2.2, 1.6, 4.6), DVec3::new(0.6, 0.3, 0.4), 38.0));
    scene
}

/// Returns 0 for the first column and 1 for the last.
fn share(column: u32) -> f32 {
    column as f32 / (COLUMNS - 1) as f32
}

fn film(column: u32) -> Material {
    let max_thickness_nm = 100.0 + 500.0 * share(column);
    let iridescence = Iridescence { ior: 1.8, max_thickness_nm, ..Iridescence::default() };
    let name = format!("film of {max_thickness_nm:.0} nm");
    Material { iridescence: Some(iridescence), ..Material::dielectric(&name, Vec3::ZERO, 0.1) }
}

fn film_on_metal(column: u32) -> Material {
    let ior = 1.2 + share(column);
    let iridescence = Iridescence { ior, ..Iridescence::default() };
    let [.., titanium] = METALS;
    Material { iridescence: Some(iridescence), ..Material::metal(&format!("film of index {ior:.1}"), titanium.f0, 0.2) }
}

/// Returns glass of dispersion 0 to 5. Exaggerated for visibility: diamond has 0.36.
fn glass(column: u32) -> Material {
    let dispersion = 5.0 * share(column);
    let volume = Some(Volume { thickness: 2.0 * RADIUS_M, ..Volume::default() });
    Material {
        ior: 1.6,
        dispersion: (dispersion > 0.0).then_some(dispersion),
        transmission: Some(Transmission { factor: 1.0, texture: None, volume }),
        ..Material::dielectric(&format!("dispersion {dispersion:.0}"), Vec3::ONE, 0.0)
    }
}

fn leaf(column: u32) -> Material {
    let factor = share(column);
    let color = linear_from_hex(0xd8_e0_40);
    let scattered = DiffuseTransmission { factor, color, ..DiffuseTransmission::default() };
    let name = format!("diffuse transmission {factor:.1}");
    Material {
        // Importers skip a factor of 0; this scene shows that it has no effect.
        diffuse_transmission: Some(scattered),
        double_sided: true,
        ..Material::dielectric(&name, linear_from_hex(0x30_80_28), 0.6)
    }
}
