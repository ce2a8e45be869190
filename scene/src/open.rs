//! Opening scenes by name.

use std::path::Path;

use crate::builtin::{NAMES, builtin};
use crate::error::SceneError;
#[cfg(feature = "gltf")]
use crate::import::load_with;
use crate::options::LoadOptions;
use crate::progress::ProgressFn;
use crate::scene::Scene;

impl Scene {
    /// Opens a scene with the default options.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Scene::open_with`].
    pub fn open(name: &str, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        Self::open_with(name, &LoadOptions::default(), progress)
    }

    /// Opens a built-in scene, or loads a glTF or GLB file.
    ///
    /// A built-in name takes precedence over a file of the same name; `./spheres` is the file.
    ///
    /// # Errors
    ///
    /// Returns a one-line error with the file and the reason. If `name` is neither built-in nor a file, the error lists
    /// the built-in names.
    pub fn open_with(name: &str, options: &LoadOptions, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        let built_in = |name: &str| match (builtin(name), &options.variant) {
            (Ok(scene), Some(variant)) => {
                Err(SceneError::UnknownVariant { file: scene.name.into(), name: variant.clone(), known: Vec::new() })
            }
            (scene, _) => scene,
        };
        if NAMES.contains(&name) {
            return built_in(name);
        }
        let path = Path::new(name);
        // A name without path or extension that is not a file is probably a misspelled built-in name.
        let bare = !name.contains(['/', '\\', '.']);
        if bare && !path.exists() {
            return built_in(name);
        }
        load_with(path, options, progress)
    }
}

/// Rejects every file: this build has no importer.
#[cfg(not(feature = "gltf"))]
fn load_with(path: &Path, _: &LoadOptions, _: &mut ProgressFn<'_>) -> Result<Scene, SceneError> {
    Err(SceneError::Unsupported { file: path.into(), feature: crate::error::Unsupported::Gltf })
}
