//! Scenes that need no file.

mod balls;
mod columns;
mod glass;
mod lobes;
mod materials;
mod metals;
mod pattern;
mod spheres;

pub use metals::{METALS, Metal};

use super::Scene;
use super::camera::{Camera, Projection};
use super::error::{SceneError, one_line};

use glam::DVec3;

/// The names [`builtin`] knows, sorted.
pub const NAMES: [&str; 6] = ["balls", "columns", "glass", "lobes", "materials", "spheres"];

/// A scene made in code: `balls` (what an environment does to five surfaces), `columns` (a colonnade, for shadows and
/// occlusion), `glass` (what lets light through), `lobes` (what a material may have beside the metal-rough base: a row of
/// balls each), `materials` (one object for each material feature), `spheres` (metallic × roughness on a ground plane).
///
/// The scenes have a camera each and no lights or environment of their own: they are meant to stand
/// under any sky. The same name gives the same scene to the bit on every machine whose `sin` and
/// `pow` agree.
///
/// # Errors
///
/// For an unknown name; the message lists the known ones.
pub fn builtin(name: &str) -> Result<Scene, SceneError> {
    match name {
        "balls" => Ok(balls::scene()),
        "columns" => Ok(columns::scene()),
        "glass" => Ok(glass::scene()),
        "lobes" => Ok(lobes::scene()),
        "materials" => Ok(materials::scene()),
        "spheres" => Ok(spheres::scene()),
        _ => Err(SceneError::UnknownScene { name: one_line(name), known: NAMES.join(", ") }),
    }
}

/// A camera of a built-in scene, upright, with the far plane at infinity.
fn camera(name: &str, eye: DVec3, target: DVec3, fov_y_deg: f64) -> Camera {
    let projection = Projection::perspective(fov_y_deg.to_radians(), 0.05);
    let mut camera =
        Camera::look_at(eye, target, DVec3::Y, projection).expect("the cameras of built-in scenes look somewhere");
    camera.name = name.into();
    camera
}

#[cfg(test)]
mod tests;
