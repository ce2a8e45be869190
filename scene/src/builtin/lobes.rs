//! `lobes`: extensions of the metallic-roughness model, a row of balls for each.
//!
//! From back to front: index of refraction; specular factor and tint; sheen by roughness; anisotropy by strength, then
//! by direction; clear coat by roughness. The quantity grows from left to right.

use glam::{DMat4, DVec3, Vec3};

use super::camera::camera;
use super::ground;
use crate::color::linear_from_hex;
use crate::geometry::sphere;
use crate::material::{Anisotropy, ClearCoat, Material, Sheen, Specular};
use crate::mesh::MeshId;
use crate::scene::Scene;

const COLUMNS: u32 = 6;
const RADIUS_M: f32 = 0.45;

pub(super) fn scene() -> Scene {
    let mut scene = Scene { name: "lobes".into(), ..Scene::default() };
    ground::checkered(&mut scene, [Vec3::splat(0.16), Vec3::splat(0.30)], 0.6, 2.0);
    let ball = scene.add_mesh(sphere(RADIUS_M, 64, 32));
    let rows: [fn(u32) -> Material; 6] = [ior, specular, sheen, anisotropy, direction, clear_coat];
    for (row, material) in rows.into_iter().enumerate() {
        for column in 0..COLUMNS {
            place(&mut scene, ball, row, column, material(column));
        }
    }
    let eye = DVec3::new(0.0, 7.4, 8.0);
    scene.cameras.push(camera("front", eye, DVec3::new(0.0, 0.0, 0.1), 38.0));
    let eye = DVec3::new(2.6, 1.9, 5.6);
    scene.cameras.push(camera("close", eye, DVec3::new(0.4, 0.3, 1.4), 38.0));
    scene
}

/// Returns 0 for the first column and 1 for the last.
fn share(column: u32) -> f32 {
    column as f32 / (COLUMNS - 1) as f32
}

fn ior(column: u32) -> Material {
    let ior = 1.0 + share(column) * 1.5;
    Material { ior, ..Material::dielectric(&format!("index {ior:.1}"), linear_from_hex(0x80_20_28), 0.15) }
}

/// Returns a material whose specular factor grows to 1, after which the specular color changes.
fn specular(column: u32) -> Material {
    let (factor, color) = match column {
        0..=2 => (column as f32 / 2.0, Vec3::ONE),
        3 => (1.0, Vec3::new(1.0, 0.2, 0.1)),
        4 => (1.0, Vec3::new(0.1, 1.0, 0.3)),
        _ => (1.0, Vec3::new(4.0, 8.0, 16.0)),
    };
    let specular = Specular { factor, color, ..Specular::default() };
    let name = format!("specular {factor:.1} {color}");
    Material { specular: Some(specular), ..Material::dielectric(&name, Vec3::splat(0.03), 0.2) }
}

fn sheen(column: u32) -> Material {
    let roughness = 0.15 + 0.85 * share(column);
    let color = if column.is_multiple_of(2) { Vec3::splat(0.9) } else { Vec3::new(0.9, 0.35, 0.2) };
    let sheen = Sheen { color, roughness, ..Sheen::default() };
    let name = format!("sheen roughness {roughness:.2}");
    Material { sheen: Some(sheen), ..Material::dielectric(&name, linear_from_hex(0x24_30_58), 0.9) }
}

fn brushed(name: &str, strength: f32, rotation_rad: f32) -> Material {
    let anisotropy = Anisotropy { strength, rotation_rad, texture: None };
    Material { anisotropy: Some(anisotropy), ..Material::metal(name, Vec3::new(0.91, 0.92, 0.92), 0.25) }
}

fn anisotropy(column: u32) -> Material {
    // Importers skip a strength of 0; this scene shows that it has no effect.
    let strength = share(column);
    brushed(&format!("anisotropy {strength:.1}"), strength, 0.0)
}

fn direction(column: u32) -> Material {
    let degrees = 180.0 * column as f32 / COLUMNS as f32;
    brushed(&format!("anisotropy along {degrees:.0} degrees"), 0.9, degrees.to_radians())
}

fn clear_coat(column: u32) -> Material {
    let roughness = share(column) * 0.6;
    let coat = ClearCoat { factor: 1.0, roughness, normal_scale: 1.0, ..ClearCoat::default() };
    let name = format!("clear coat roughness {roughness:.2}");
    Material { clear_coat: Some(coat), ..Material::metal(&name, linear_from_hex(0xa0_18_10), 0.5) }
}

fn place(scene: &mut Scene, ball: MeshId, row: usize, column: u32, material: Material) {
    let name = material.name.clone();
    let material = scene.add_material(material);
    let x = (f64::from(column) - f64::from(COLUMNS - 1) / 2.0) * 1.15;
    let z = (row as f64 - 2.5) * 1.2;
    scene.add_instance(&name, ball, material, DMat4::from_translation(DVec3::new(x, f64::from(RADIUS_M), z)));
}
