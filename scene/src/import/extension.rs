//! Which extensions are understood.

use std::path::Path;

use gltf_json::Root;

use super::lobes;
use super::source::Warnings;
use crate::error::{SceneError, Unsupported};

/// The extensions that this importer honours in full beside those of [`lobes`].
const SUPPORTED: [&str; 6] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

fn is_supported(name: &str) -> bool {
    SUPPORTED.contains(&name) || lobes::EXTENSIONS.contains(&name)
}

/// Refuses a document that requires something else, and warns of what will be ignored: optional
/// extensions by name and number of materials, and animation, skins and morph targets.
pub(super) fn check(file: &Path, root: &Root, warnings: &mut Warnings) -> Result<(), SceneError> {
    let unsupported = |feature| SceneError::Unsupported { file: file.into(), feature };
    let version = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    if !(version == "2" || version.starts_with("2.")) {
        return Err(unsupported(Unsupported::GltfVersion(version.clone())));
    }
    let missing = root.extensions_required.iter().filter(|name| !is_supported(name));
    let missing: Vec<String> = missing.cloned().collect();
    if !missing.is_empty() {
        return Err(unsupported(Unsupported::Extensions(missing)));
    }
    for name in &root.extensions_used {
        if is_supported(name) {
            continue;
        }
        let materials = root
            .materials
            .iter()
            .filter(|m| m.extensions.as_ref().is_some_and(|e| e.others.contains_key(name)))
            .count();
        if materials > 0 {
            warnings.push(format!("{name} is ignored ({materials} materials use it)"));
        } else {
            warnings.push(format!("{name} is ignored"));
        }
    }
    Ok(())
}
