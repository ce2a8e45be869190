//! Extensions of glTF: which ones the importer supports, and how others are treated.

use std::path::Path;

use gltf_json::Root;

use super::source::Warnings;
use crate::error::{SceneError, Unsupported};

/// Treatment of an extension by the importer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// Everything the extension specifies is read.
    Full,
    /// The extension is read in a build with this feature of the crate.
    Feature(&'static str),
    /// The extension is not read. A file that uses it loads with a warning; a file that requires it is rejected.
    None,
}

/// One extension of glTF and its support.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extension {
    /// Name in `extensionsUsed`.
    pub name: &'static str,
    /// Treatment by the importer.
    pub support: Support,
    /// One line on what is read or converted, or what a file loses without the extension.
    pub note: &'static str,
}

const fn full(name: &'static str, note: &'static str) -> Extension {
    Extension { name, support: Support::Full, note }
}

const fn feature(name: &'static str, feature: &'static str, note: &'static str) -> Extension {
    Extension { name, support: Support::Feature(feature), note }
}

const fn none(name: &'static str, note: &'static str) -> Extension {
    Extension { name, support: Support::None, note }
}

/// Every Khronos (`KHR_`) and multi-vendor (`EXT_`) extension of glTF 2.0, sorted by name. `docs/reference/files.md`
/// contains this table.
pub const EXTENSIONS: &[Extension] = &[
    none("EXT_instance_features", "feature identifiers of instances are not read"),
    none("EXT_lights_ies", "light profiles are not read; the light is equal in all directions"),
    none("EXT_lights_image_based", "the environment of the application is used"),
    none("EXT_mesh_features", "feature identifiers of vertices are not read"),
    full("EXT_mesh_gpu_instancing", "only one instance of a skinned mesh is drawn"),
    none("EXT_mesh_manifold", "the mesh is drawn; its manifold indices are not read"),
    none("EXT_mesh_primitive_edge_visibility", "edges are not drawn"),
    none("EXT_mesh_primitive_restart", "an index that restarts a strip is refused as out of range"),
    feature("EXT_meshopt_compression", "meshopt", "all modes and filters"),
    none("EXT_structural_metadata", "metadata is not read"),
    none("EXT_texture_astc", "ASTC images are not decoded"),
    feature("EXT_texture_webp", "webp", "still images, lossy and lossless; preferred over the fallback image"),
    none("KHR_accessor_float64", "accessors of 64-bit floats are refused"),
    full(
        "KHR_animation_pointer",
        "animates node transforms and weights, factors and texture transforms of materials, lights and cameras; other \
         properties keep their value, with a warning",
    ),
    none("KHR_audio_emitter", "sound is not played"),
    feature("KHR_draco_mesh_compression", "draco", "bitstreams up to 2.2, every encoding of meshes"),
    none("KHR_gaussian_splatting", "splats are not drawn"),
    none("KHR_implicit_shapes", "shapes are not drawn; they serve physics"),
    none("KHR_interactivity", "behavior graphs are not run"),
    full("KHR_lights_punctual", "directional, point and spot lights"),
    full("KHR_materials_anisotropy", ""),
    full("KHR_materials_clearcoat", ""),
    full("KHR_materials_diffuse_transmission", ""),
    full("KHR_materials_dispersion", ""),
    full("KHR_materials_emissive_strength", "emission is in nits"),
    full("KHR_materials_ior", ""),
    full("KHR_materials_iridescence", ""),
    full("KHR_materials_pbrSpecularGlossiness", "converted to a metallic-roughness material, as Filament shades it"),
    full("KHR_materials_sheen", ""),
    full("KHR_materials_specular", ""),
    full("KHR_materials_transmission", ""),
    full("KHR_materials_unlit", ""),
    full(
        "KHR_materials_variants",
        "`LoadOptions::variant` or `--variant` chooses one; the default materials otherwise",
    ),
    full("KHR_materials_volume", ""),
    none("KHR_materials_volume_scatter", "the volume absorbs and does not scatter"),
    full("KHR_mesh_quantization", ""),
    feature("KHR_meshopt_compression", "meshopt", "all modes and filters, versions 0 and 1 of attributes"),
    none("KHR_node_hoverability", "input is not handled"),
    none("KHR_node_selectability", "input is not handled"),
    full("KHR_node_visibility", "meshes and lights of hidden nodes are left out; the value cannot be animated"),
    none("KHR_physics_rigid_bodies", "nothing is simulated"),
    none("KHR_techniques_webgl", "shaders in files are not read"),
    feature(
        "KHR_texture_basisu",
        "basisu",
        "ETC1S and UASTC become BC7, ETC2 or ASTC where the device samples these, RGBA8 otherwise; preferred over the fallback image",
    ),
    none("KHR_texture_procedurals", "procedural textures are not evaluated"),
    full("KHR_texture_transform", ""),
    none("KHR_xmp", "metadata is not read"),
    none("KHR_xmp_json_ld", "metadata is not read"),
];

/// Returns [`EXTENSIONS`] as a Markdown table.
pub fn extensions_table() -> String {
    let row = |extension: &Extension| {
        let support = match extension.support {
            Support::Full => "yes".to_owned(),
            Support::Feature(feature) => format!("with the feature `{feature}`"),
            Support::None => "no".to_owned(),
        };
        format!("| `{}` | {support} | {} |\n", extension.name, extension.note)
    };
    let rows: String = EXTENSIONS.iter().map(row).collect();
    format!("| extension | read | note |\n| --- | --- | --- |\n{rows}")
}

/// Returns true if this build reads the extension.
pub(super) fn is_supported(name: &str) -> bool {
    let known = EXTENSIONS.iter().find(|extension| extension.name == name);
    known.is_some_and(|extension| match extension.support {
        Support::Full => true,
        Support::Feature(feature) => is_enabled(feature),
        Support::None => false,
    })
}

/// Returns true if this crate was compiled with the feature.
fn is_enabled(feature: &str) -> bool {
    let enabled = [
        ("draco", cfg!(feature = "draco")),
        ("meshopt", cfg!(feature = "meshopt")),
        ("webp", cfg!(feature = "webp")),
        ("basisu", cfg!(feature = "basisu")),
    ];
    enabled.contains(&(feature, true))
}

/// Checks the version and the extensions of a document.
///
/// Warns once for each optional extension that is not supported.
///
/// # Errors
///
/// Fails for a version other than 2, and for a required extension that is not supported.
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
        let known = EXTENSIONS.iter().find(|extension| extension.name == name);
        let effect = known.map_or(String::new(), |extension| match extension.support {
            Support::Feature(feature) => format!(": compile framegraph-scene with its feature `{feature}`"),
            Support::Full | Support::None => format!(": {}", extension.note),
        });
        if materials > 0 {
            warnings.push(format!("{name} is ignored ({materials} materials use it){effect}"));
        } else {
            warnings.push(format!("{name} is ignored{effect}"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_are_sorted_and_unique() {
        assert!(EXTENSIONS.windows(2).all(|pair| pair[0].name < pair[1].name));
    }

    #[test]
    fn the_document_has_the_table_of_extensions() {
        let document = include_str!("../../../docs/reference/files.md");
        let after = document.split_once("<!-- table: extensions -->\n").map(|(_, after)| after);
        let table = after.and_then(|after| after.split_once("<!-- end -->")).map(|(table, _)| table);
        let expected = extensions_table();
        assert!(
            table == Some(&expected),
            "docs/reference/files.md: the table is out of date; replace it by the output of `cargo run -p framegraph-scene --example \
             extensions`:\n{expected}"
        );
    }
}
