//! Errors of image-based light against brute force, printed by the program `ibl_errors` and bounded by tests.

pub mod albedo;
pub mod board;
pub mod bounds;
pub mod cards;
pub mod columns;
pub mod controller;
pub mod facts;
pub mod furnace;
pub mod grading;
pub mod half;
pub mod half_model;
pub mod half_table;
pub mod harmonics;
pub mod lights;
pub mod occlusion;
pub mod prediction;
pub mod reflection;
pub mod specular;
pub mod temporal;

use framegraph_scene::environment::{EquirectMap, direction_from_equirect_uv};
use glam::{DVec2, DVec3};

/// Creates a gray map whose texels average `radiance` over 4×4 points, which smooths edges.
pub fn averaged_map(width: u32, radiance: impl Fn(DVec3) -> f64) -> EquirectMap {
    let height = width / 2;
    let mut texels = Vec::with_capacity((width * height) as usize);
    for y in 0..height {
        for x in 0..width {
            let point = |i: u32| {
                let at = DVec2::new(f64::from(4 * x + i % 4), f64::from(4 * y + i / 4)) + 0.5;
                radiance(direction_from_equirect_uv(at / (4.0 * DVec2::new(f64::from(width), f64::from(height)))))
            };
            let mean = ((0..16).map(point).sum::<f64>() / 16.0) as f32;
            texels.push([mean, mean, mean, 1.0]);
        }
    }
    EquirectMap::new(width, height, texels)
}
