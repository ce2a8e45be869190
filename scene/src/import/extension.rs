//! Which extensions are understood.

use std::path::Path;

use gltf_json::Root;

use super::source::Warnings;
use crate::error::{SceneError, Unsupported};

/// The extensions this importer honours in full.
pub(super) const SUPPORTED: [&str; 12] = [
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Refuses a document that requires something else, and warns of what will be ignored: optional
/// extensions by name and number of materials, and animation, skins and morph targets.
pub(super) fn check(file: &Path, root: &Root, warnings: &mut Warnings) -> Result<(), SceneError> {
    let unsupported = |feature| SceneError::Unsupported { file: file.into(), feature };
    let version = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    if !(version == "2" || version.starts_with("2.")) {
        return Err(unsupported(Unsupported::GltfVersion(version.clone())));
    }
    let missing = root.extensions_required.iter().filter(|name| !SUPPORTED.contains(&name.as_str()));
    let missing: Vec<String> = missing.cloned().collect();
    if !missing.is_empty() {
        return Err(unsupported(Unsupported::Extensions(missing)));
    }
    for name in &root.extensions_used {
        if SUPPORTED.contains(&name.as_str()) {
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
    for (what, count) in [
        ("animations are ignored; nodes stand as they are", root.animations.len()),
        ("skins are ignored; meshes stand as modelled", root.skins.len()),
    ] {
        if count > 0 {
            warnings.push(format!("{count} {what}"));
        }
    }
    let morphed = |mesh: &&gltf_json::Mesh| mesh.primitives.iter().any(|p| p.targets.is_some());
    let count = root.meshes.iter().filter(morphed).count();
    if count > 0 {
        warnings.push(format!("the morph targets of {count} meshes are ignored"));
    }
    Ok(())
}
