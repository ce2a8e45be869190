//! Scenes by the names that users write.

use std::path::Path;

use crate::builtin::{NAMES, builtin};
use crate::error::SceneError;
#[cfg(feature = "gltf")]
use crate::import::load;
use crate::progress::ProgressFn;
use crate::scene::Scene;

impl Scene {
    /// Loads what a user names: a built-in scene, or a glTF or GLB file.
    ///
    /// A built-in name wins over a file of the same name; `./spheres` is the file.
    ///
    /// # Errors
    ///
    /// One line that names the file and the reason; for a name that is neither, the built-in names.
    pub fn open(name: &str, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        if NAMES.contains(&name) {
            return builtin(name);
        }
        let path = Path::new(name);
        // A bare word that is no file is a misspelt name rather than a missing file.
        let bare = !name.contains(['/', '\\', '.']);
        if bare && !path.exists() {
            return builtin(name);
        }
        load(path, progress)
    }
}

/// A build without import refuses every file.
#[cfg(not(feature = "gltf"))]
fn load(path: &Path, _: &mut ProgressFn<'_>) -> Result<Scene, SceneError> {
    Err(SceneError::Unsupported { file: path.into(), feature: crate::error::Unsupported::Gltf })
}
