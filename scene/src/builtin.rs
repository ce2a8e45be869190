//! Built-in scenes: procedural geometry, no files.

mod balls;
mod camera;
mod columns;
mod glass;
mod ground;
mod lamps;
mod lobes;
mod materials;
mod metal;
mod optics;
mod panes;
mod pattern;
mod spheres;

pub use metal::{METALS, Metal};

use super::error::SceneError;
use super::scene::Scene;

/// Names that [`builtin`] accepts, sorted.
pub const NAMES: [&str; 9] = ["balls", "columns", "glass", "lamps", "lobes", "materials", "optics", "panes", "spheres"];

/// Returns a built-in scene.
///
/// - `balls`: five materials that show an environment.
/// - `columns`: a colonnade, for shadows and occlusion.
/// - `glass`: transmissive materials.
/// - `lamps`: 1000 punctual lights of limited range; `lamps:N` has N of them, at most 65,536.
/// - `lobes`: extensions of the metallic-roughness model, a row of balls for each.
/// - `materials`: one object for each material feature.
/// - `optics`: thin films, dispersion and diffuse transmission, a row for each.
/// - `panes`: intersecting blended panes, and a ball within a ball; `panes:N` has N panes, at most 64.
/// - `spheres`: metallic × roughness on a ground plane.
///
/// Every scene has a camera. Only `lamps` has lights; no scene has an environment, so that any sky fits. A name gives
/// the same scene, bit for bit, on every machine whose `sin` and `pow` agree.
///
/// # Errors
///
/// Fails for an unknown name; the message lists the known ones.
pub fn builtin(name: &str) -> Result<Scene, SceneError> {
    match name {
        "balls" => Ok(balls::scene()),
        "columns" => Ok(columns::scene()),
        "glass" => Ok(glass::scene()),
        "lamps" => Ok(lamps::scene(lamps::COUNT)),
        "lobes" => Ok(lobes::scene()),
        "materials" => Ok(materials::scene()),
        "optics" => Ok(optics::scene()),
        "panes" => Ok(panes::scene(panes::COUNT)),
        "spheres" => Ok(spheres::scene()),
        _ => match name.split_once(':') {
            Some(("lamps", count)) => {
                let number = count.parse().ok().filter(|number| *number <= lamps::MOST);
                let wrong = || SceneError::LampCount { count: count.into(), most: lamps::MOST };
                number.map(lamps::scene).ok_or_else(wrong)
            }
            Some(("panes", count)) => {
                let number = count.parse().ok().filter(|number| *number <= panes::MOST);
                let wrong = || SceneError::PaneCount { count: count.into(), most: panes::MOST };
                number.map(panes::scene).ok_or_else(wrong)
            }
            _ => Err(SceneError::UnknownScene { name: name.into(), known: &NAMES }),
        },
    }
}

#[cfg(test)]
mod tests;
