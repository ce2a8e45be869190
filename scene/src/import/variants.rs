//! KHR_materials_variants: alternative materials of primitives, selected by variant name.

use gltf_json::mesh::Primitive;
use serde_json::Value;

use super::source::Source;
use crate::error::{SceneError, one_line};

/// Name of the extension.
const NAME: &str = "KHR_materials_variants";

/// Variants of a file and the selected one.
pub(super) struct Variants {
    /// Names in file order.
    pub names: Vec<String>,
    /// Number of the selected variant; `None` for the default materials.
    chosen: Option<usize>,
}

impl Variants {
    /// Reads the variants of a file and looks up the requested one.
    ///
    /// # Errors
    ///
    /// Fails if the file has no variant of that name.
    pub fn read(source: &Source<'_>, wanted: Option<&str>) -> Result<Self, SceneError> {
        let variants = source.json.get("extensions").and_then(|e| e.get(NAME)).and_then(|e| e.get("variants"));
        let variants = variants.and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let name = |variant: &Value| one_line(variant.get("name").and_then(Value::as_str).unwrap_or_default());
        let names: Vec<String> = variants.iter().map(name).collect();
        let chosen = match wanted {
            None => None,
            Some(wanted) => Some(names.iter().position(|name| name == wanted).ok_or_else(|| {
                SceneError::UnknownVariant { file: source.file.into(), name: wanted.into(), known: names.clone() }
            })?),
        };
        Ok(Self { names, chosen })
    }

    /// Returns the material index of a primitive: that of the selected variant, otherwise the default.
    pub fn material(&self, source: &Source<'_>, at: &str, primitive: &Primitive) -> Result<Option<usize>, SceneError> {
        let default = primitive.material.map(|index| index.value());
        let Some(chosen) = self.chosen else {
            return Ok(default);
        };
        let extension = primitive.extensions.as_ref().and_then(|e| e.others.get(NAME));
        let mappings = extension.and_then(|e| e.get("mappings")).and_then(Value::as_array);
        let is_chosen = |mapping: &&Value| {
            let variants = mapping.get("variants").and_then(Value::as_array);
            variants.is_some_and(|all| all.iter().any(|variant| variant.as_u64() == Some(chosen as u64)))
        };
        let Some(mapping) = mappings.into_iter().flatten().find(is_chosen) else {
            return Ok(default);
        };
        let index = mapping.get("material").and_then(Value::as_u64).and_then(|index| usize::try_from(index).ok());
        index.map(Some).ok_or_else(|| source.malformed(at, format!("{NAME}: a mapping has no index of a material")))
    }
}
