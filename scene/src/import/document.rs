//! JSON of a glTF file: version check, repair of JSON that the schema types reject, and parsing.
//!
//! In a few places `gltf-json` is stricter than the specification, and some exporters violate it. Both are handled here
//! on plain JSON, before the schema types parse it.

use std::collections::BTreeMap;
use std::path::Path;

use gltf_json::Root;
use serde_json::{Map, Value};

use crate::error::{SceneError, Unsupported};

/// A parsed glTF document.
pub(super) struct Document {
    /// The document as schema types. Indices in it are unchecked.
    pub root: Root,
    /// The document as JSON without `extras`, for extensions that the schema types do not cover.
    pub json: Value,
    /// Members [`SWITCHES`] of `extras`, by JSON pointer to their object (RFC 6901).
    pub switches: BTreeMap<String, Value>,
}

/// The member of `extras` that holds [switches](super::switches).
pub(super) const SWITCHES: &str = "framegraph";

/// Node index of an animation channel without a node.
pub(super) const NO_NODE: u32 = u32::MAX;

/// Parses the JSON of a file.
///
/// # Errors
///
/// Fails for text that is not JSON, for glTF 1.0, and for a document that violates the schema. The error contains the
/// JSON path.
pub(super) fn parse(file: &Path, text: &[u8]) -> Result<Document, SceneError> {
    let malformed = |reason: String| SceneError::malformed(file, "JSON", reason);
    let mut json: Value = serde_json::from_slice(text).map_err(|e| malformed(e.to_string()))?;
    if let Some(version) = old_version(&json) {
        return Err(SceneError::Unsupported { file: file.into(), feature: Unsupported::GltfVersion(version) });
    }
    let switches = switches_of(&json);
    tidy(&mut json);
    fill_in(&mut json);
    // The schema types would accept an array as the fields of an object.
    if !json.is_object() {
        return Err(malformed("it is not an object; a glTF file is a JSON object with `asset`".into()));
    }
    let root = serde_path_to_error::deserialize(&json).map_err(|error| {
        let path = error.path().to_string();
        malformed(if path == "." { error.inner().to_string() } else { format!("{path}: {}", error.inner()) })
    })?;
    Ok(Document { root, json, switches })
}

/// Returns the version if this is a glTF 1 document, which stores dictionaries where glTF 2 stores arrays.
fn old_version(json: &Value) -> Option<String> {
    let stated = json.get("asset").and_then(|asset| asset.get("version")).map(|version| match version {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    });
    if let Some(version) = &stated
        && !(version == "1" || version.starts_with("1."))
    {
        return None;
    }
    let dictionaries = ["accessors", "buffers", "bufferViews", "materials", "meshes", "nodes", "scenes"];
    let is_old = stated.is_some() || dictionaries.iter().any(|key| json.get(key).is_some_and(Value::is_object));
    is_old.then(|| stated.unwrap_or_else(|| "1.0".into()))
}

/// Returns the members [`SWITCHES`] in `extras` of nodes, materials and lights.
fn switches_of(json: &Value) -> BTreeMap<String, Value> {
    let mut found = BTreeMap::new();
    for array in ["/nodes", "/materials", "/extensions/KHR_lights_punctual/lights"] {
        for (number, object) in json.pointer(array).and_then(Value::as_array).into_iter().flatten().enumerate() {
            if let Some(stated) = object.get("extras").and_then(|extras| extras.get(SWITCHES)) {
                let mut stated = stated.clone();
                tidy(&mut stated);
                found.insert(format!("{array}/{number}"), stated);
            }
        }
    }
    found
}

/// Converts integral floats to integers and removes `extras`.
///
/// JSON Schema accepts 24.0 as an integer; the schema types do not.
fn tidy(json: &mut Value) {
    /// Largest magnitude up to which all integers are exact in f64.
    const LARGEST: f64 = 9_007_199_254_740_992.0;
    let mut stack = vec![json];
    while let Some(value) = stack.pop() {
        match value {
            Value::Number(number) => {
                let whole = number.as_f64().filter(|n| number.is_f64() && n.fract() == 0.0 && n.abs() <= LARGEST);
                if let Some(whole) = whole {
                    *value = Value::from(whole as i64);
                }
            }
            Value::Array(values) => stack.extend(values),
            Value::Object(members) => {
                members.remove("extras");
                stack.extend(members.values_mut());
            }
            Value::Null | Value::Bool(_) | Value::String(_) => {}
        }
    }
}

/// Adds optional members that the schema types require.
fn fill_in(json: &mut Value) {
    for scene in objects(json.get_mut("scenes")) {
        scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    for animation in objects(json.get_mut("animations")) {
        for channel in objects(animation.get_mut("channels")) {
            // A channel without a node is ignored, or has another target by KHR_animation_pointer.
            if let Some(Value::Object(target)) = channel.get_mut("target") {
                target.entry("node").or_insert_with(|| Value::from(NO_NODE));
            }
        }
    }
}

/// Iterates over the objects of an array.
fn objects(array: Option<&mut Value>) -> impl Iterator<Item = &mut Map<String, Value>> {
    array.and_then(Value::as_array_mut).into_iter().flatten().filter_map(Value::as_object_mut)
}
