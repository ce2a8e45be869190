//! `columns`: a stone colonnade that shows long shadows and ambient occlusion in corners.

use glam::{DMat4, DVec3, Vec2, Vec3};

use super::camera::camera;
use crate::geometry::{ProfilePoint, cuboid, plane, profile_of_revolution, sphere, torus};
use crate::material::Material;
use crate::material::MaterialId;
use crate::mesh::Mesh;
use crate::mesh::MeshId;
use crate::scene::Scene;

const PAIRS: u32 = 6;
const SPACING_M: f64 = 2.0;
/// From the middle of the aisle to the columns' axes.
const AISLE_M: f64 = 1.8;
/// Height of the floor on top of the steps.
const FLOOR_M: f64 = 0.36;
/// From the floor to the top of the capitals.
const COLUMN_M: f64 = 3.2;

pub(super) fn scene() -> Scene {
    let mut scene = Scene { name: "columns".into(), ..Scene::default() };
    let stone = Material::dielectric("stone", Vec3::new(0.55, 0.50, 0.42), 0.85);
    let stone = scene.add_material(stone);
    let dark = Material::dielectric("dark stone", Vec3::new(0.30, 0.27, 0.24), 0.7);
    let dark = scene.add_material(dark);
    let earth = Vec3::new(0.22, 0.20, 0.16);
    let ground = scene.add_material(Material::dielectric("ground", earth, 0.95));
    scene.ground_albedo = Some(earth);

    let field = scene.add_mesh(plane(Vec2::splat(60.0), 8, Vec2::splat(30.0)));
    scene.add_instance("ground", field, ground, DMat4::IDENTITY);
    steps(&mut scene, stone);
    colonnade(&mut scene, stone, dark);
    props(&mut scene);

    let eye = DVec3::new(6.6, 2.5, 9.6);
    scene.cameras.push(camera("outside", eye, DVec3::new(0.0, 1.75, 0.6), 40.0));
    let eye = DVec3::new(0.5, FLOOR_M + 1.5, 6.8);
    let target = DVec3::new(-0.3, FLOOR_M + 1.3, 0.0);
    scene.cameras.push(camera("aisle", eye, target, 50.0));
    scene
}

/// Returns half the length of the floor along z.
fn half_length() -> f64 {
    f64::from(PAIRS - 1) * SPACING_M / 2.0 + 1.0
}

fn put_box(scene: &mut Scene, name: &str, material: MaterialId, min: DVec3, max: DVec3) {
    let half = (max - min) / 2.0;
    let mesh = scene.add_mesh(cuboid(half.as_vec3()));
    let at = DMat4::from_translation((min + max) / 2.0);
    scene.add_instance(name, mesh, material, at);
}

/// Adds three steps, each 12 cm high and 35 cm deep, up to the floor.
fn steps(scene: &mut Scene, stone: MaterialId) {
    for step in 0..3_u32 {
        let reach = 0.35 * f64::from(2 - step);
        let (x, z) = (AISLE_M + 0.7 + reach, half_length() + reach);
        let (low, high) = (0.12 * f64::from(step), 0.12 * f64::from(step + 1));
        let (min, max) = (DVec3::new(-x, low, -z), DVec3::new(x, high, z));
        put_box(scene, "step", stone, min, max);
    }
}

fn colonnade(scene: &mut Scene, stone: MaterialId, dark: MaterialId) {
    let shaft = scene.add_mesh(shaft());
    let block = scene.add_mesh(cuboid(Vec3::new(0.36, 0.06, 0.36)));
    let put = |scene: &mut Scene, name: &str, mesh: MeshId, at: DVec3| {
        scene.add_instance(name, mesh, stone, DMat4::from_translation(at));
    };
    for pair in 0..PAIRS {
        let z = (f64::from(pair) - f64::from(PAIRS - 1) / 2.0) * SPACING_M;
        for x in [-AISLE_M, AISLE_M] {
            put(scene, "plinth", block, DVec3::new(x, FLOOR_M + 0.06, z));
            put(scene, "shaft", shaft, DVec3::new(x, FLOOR_M + 0.12, z));
            put(scene, "abacus", block, DVec3::new(x, FLOOR_M + COLUMN_M - 0.06, z));
        }
    }
    let (low, high) = (FLOOR_M + COLUMN_M, FLOOR_M + COLUMN_M + 0.4);
    let z = half_length() - 0.5;
    for x in [-AISLE_M, AISLE_M] {
        let (min, max) = (DVec3::new(x - 0.32, low, -z), DVec3::new(x + 0.32, high, z));
        put_box(scene, "beam", stone, min, max);
    }
    // Cross beams leave the roof open, so that the sun draws them on the floor.
    for pair in 0..PAIRS {
        let z = (f64::from(pair) - f64::from(PAIRS - 1) / 2.0) * SPACING_M;
        let x = AISLE_M + 0.5;
        let min = DVec3::new(-x, high, z - 0.14);
        put_box(scene, "rafter", dark, min, DVec3::new(x, high + 0.24, z + 0.14));
    }
}

/// Returns a shaft with a rounded base and capital and a slight swelling, from y = 0 to the abacus.
fn shaft() -> Mesh {
    let height = (COLUMN_M - 0.24) as f32;
    // Half circles from (r, top) to (r, bottom): mouldings.
    let moulding = |radius: f32, top: f32, thickness: f32| -> Vec<ProfilePoint> {
        (0..=8_u8)
            .map(|i| {
                let t = f32::from(i) / 8.0;
                let (sin, cos) = (t * std::f32::consts::PI).sin_cos();
                let half = thickness / 2.0;
                ProfilePoint {
                    at: Vec2::new(radius + half * sin, top - half + half * cos),
                    normal: Vec2::new(sin, cos),
                    v: t * 0.1,
                }
            })
            .collect()
    };
    let (top, bottom) = (height - 0.14, 0.14);
    let body: Vec<ProfilePoint> = (0..=12_u8)
        .map(|i| {
            let t = f32::from(i) / 12.0;
            // Thinner at the top by a sixth, with the swelling (entasis) of a quarter sine.
            let radius = |t: f32| 0.22 + 0.045 * (t * std::f32::consts::FRAC_PI_2).sin();
            let slope = (radius(t + 1e-3) - radius(t - 1e-3)) / (2e-3 * (top - bottom));
            ProfilePoint {
                at: Vec2::new(radius(t), top + (bottom - top) * t),
                normal: Vec2::new(1.0, slope).normalize(),
                v: t * 4.0,
            }
        })
        .collect();
    let capital = moulding(0.24, height, 0.14);
    let base = moulding(0.27, 0.14, 0.14);
    let mut mesh = profile_of_revolution(&[&capital, &body, &base], 48);
    mesh.name = "shaft".into();
    mesh
}

/// Adds objects on the floor that cast and receive shadows.
fn props(scene: &mut Scene) {
    let bronze = Material::metal("bronze", Vec3::new(0.714, 0.428, 0.181), 0.35);
    let bronze = scene.add_material(bronze);
    let clay = Material::dielectric("clay", Vec3::new(0.45, 0.14, 0.07), 0.8);
    let clay = scene.add_material(clay);
    let ball = scene.add_mesh(sphere(0.42, 48, 24));
    let ring = scene.add_mesh(torus(0.34, 0.09, 48, 24));
    let crate_mesh = scene.add_mesh(cuboid(Vec3::splat(0.3)));
    let at = |x: f64, y: f64, z: f64| DMat4::from_translation(DVec3::new(x, FLOOR_M + y, z));
    scene.add_instance("ball", ball, bronze, at(0.55, 0.42, 3.1));
    let lean = DMat4::from_rotation_y(0.6) * DMat4::from_rotation_x(1.1);
    scene.add_instance("ring", ring, bronze, at(-0.7, 0.385, 4.3) * lean);
    scene.add_instance("crate", crate_mesh, clay, at(-0.75, 0.3, 1.6) * DMat4::from_rotation_y(0.5));
    scene.add_instance("crate", crate_mesh, clay, at(-0.70, 0.9, 1.65) * DMat4::from_rotation_y(0.9));
    scene.add_instance("ball", ball, clay, at(0.8, 0.42, -1.2));
}
