//! `panes`: intersecting blended surfaces that no object order draws correctly, on checkered ground.
//!
//! Left: colored panes that intersect in one vertical axis. Right: a transparent ball within a transparent ball.

use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

use super::camera::camera;
use super::ground;
use crate::geometry::{plane, sphere};
use crate::material::{AlphaMode, Material};
use crate::scene::Scene;

/// Default number of intersecting panes.
pub(super) const COUNT: u32 = 5;
/// Maximum number of panes in `panes:N`.
pub(super) const MOST: u32 = 64;

/// Contrasting hues, used in turn.
const COLORS: [Vec3; 4] =
    [Vec3::new(0.8, 0.06, 0.05), Vec3::new(0.05, 0.55, 0.1), Vec3::new(0.06, 0.12, 0.8), Vec3::new(0.8, 0.6, 0.05)];

pub(super) fn scene(count: u32) -> Scene {
    let mut scene = Scene { name: "panes".into(), ..Scene::default() };
    ground::checkered(&mut scene, [Vec3::splat(0.1), Vec3::splat(0.55)], 0.8, 1.0);
    let pane = scene.add_mesh(plane(Vec2::new(1.8, 1.4), 12, Vec2::ONE));
    for number in 0..count {
        let albedo = COLORS[number as usize % COLORS.len()];
        let material = scene.add_material(clear("pane", albedo, 0.55));
        // No pane is seen edge-on, and all lean inward like the sides of a tent.
        let about = PI * (f64::from(number) + 0.35) / f64::from(count.max(1));
        let turned = DQuat::from_rotation_y(about) * DQuat::from_rotation_x(FRAC_PI_2);
        let place = DMat4::from_rotation_translation(turned, DVec3::new(-1.05, 0.75, 0.0));
        scene.add_instance("pane", pane, material, place);
    }
    for (radius, albedo, alpha, at) in [
        (0.7, Vec3::new(0.8, 0.08, 0.06), 0.4, DVec3::new(1.05, 0.75, 0.0)),
        (0.3, Vec3::new(0.06, 0.08, 0.8), 0.75, DVec3::new(1.2, 0.75, 0.25)),
    ] {
        let ball = scene.add_mesh(sphere(radius, 48, 24));
        let material = scene.add_material(clear("ball", albedo, alpha));
        scene.add_instance("ball", ball, material, DMat4::from_translation(at));
    }
    let eye = DVec3::new(0.0, 1.5, 4.6);
    scene.cameras.push(camera("front", eye, DVec3::new(0.0, 0.68, 0.0), 34.0));
    scene
}

/// Returns a double-sided blended material.
fn clear(name: &str, albedo: Vec3, alpha: f32) -> Material {
    let base_color = albedo.extend(alpha);
    let own = Material::dielectric(name, albedo, 0.4);
    Material { base_color, alpha: AlphaMode::Blend, double_sided: true, ..own }
}
