//! Scenes by the names that users write.

use std::path::Path;

use crate::builtin::{NAMES, builtin};
use crate::error::SceneError;
#[cfg(feature = "gltf")]
use crate::import::load_with;
use crate::options::LoadOptions;
use crate::progress::ProgressFn;
use crate::scene::Scene;

impl Scene {
    /// [`Scene::open_with`] the default options.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn open(name: &str, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        Self::open_with(name, &LoadOptions::default(), progress)
    }

    /// Loads what a user names: a built-in scene, or a glTF or GLB file.
    ///
    /// A built-in name wins over a file of the same name; `./spheres` is the file.
    ///
    /// # Errors
    ///
    /// One line that names the file and the reason; for a name that is neither, the built-in names.
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
        // A bare word that is no file is a misspelt name rather than a missing file.
        let bare = !name.contains(['/', '\\', '.']);
        if bare && !path.exists() {
            return built_in(name);
        }
        load_with(path, options, progress)
    }
}

/// A build without import refuses every file.
#[cfg(not(feature = "gltf"))]
fn load_with(path: &Path, _: &LoadOptions, _: &mut ProgressFn<'_>) -> Result<Scene, SceneError> {
    Err(SceneError::Unsupported { file: path.into(), feature: crate::error::Unsupported::Gltf })
}
