//! The member `framegraph` of an object's `extras`: switches of the renderer that glTF has no words for.
//!
//! `extras` may hold anything, so a wrong value is a warning, and the default stays.

use glam::Vec3;
use gltf_json::Value;

use super::document::EXTRAS;
use super::source::{Source, Warnings};

/// The member `framegraph` of the `extras` of one object.
pub(super) struct Extras<'a> {
    /// Place in the file, for messages: `material 3: extras.framegraph`.
    at: String,
    json: &'a Value,
}

impl<'a> Extras<'a> {
    /// Returns the member of the object at a JSON pointer of the document; `at` names the object in messages.
    pub fn find(source: &Source<'a>, at: &str, pointer: &str, warnings: &mut Warnings) -> Option<Self> {
        let json = source.json.pointer(pointer)?.get("extras")?.get(EXTRAS)?;
        Self { at: format!("{at}: extras.{EXTRAS}"), json }.object(warnings)
    }

    /// Returns a member that is an object of its own.
    pub fn child(&self, key: &str, warnings: &mut Warnings) -> Option<Self> {
        let json = self.json.get(key)?;
        Self { at: format!("{}.{key}", self.at), json }.object(warnings)
    }

    /// Returns a boolean, if it is there and is one.
    pub fn flag(&self, key: &str, warnings: &mut Warnings) -> Option<bool> {
        let value = self.json.get(key)?;
        value.as_bool().or_else(|| self.ignored(key, "no boolean", warnings))
    }

    /// Returns a number within `min…max`, if it is there; a number outside is clamped with a warning.
    pub fn number(&self, key: &str, [min, max]: [f32; 2], warnings: &mut Warnings) -> Option<f32> {
        let Some(value) = self.json.get(key)?.as_f64() else {
            return self.ignored(key, "no number", warnings);
        };
        let value = value as f32;
        let held = value.clamp(min, max);
        if held != value {
            warnings.push(format!("{}.{key}: {value} was clamped to {held}", self.at));
        }
        Some(held)
    }

    /// Returns a color of three channels in 0…1, linear Rec.709, if it is there; channels outside are clamped with a warning.
    pub fn color(&self, key: &str, warnings: &mut Warnings) -> Option<Vec3> {
        let channels = self.json.get(key)?.as_array().map_or(&[][..], Vec::as_slice);
        let [Some(r), Some(g), Some(b)] = [0, 1, 2].map(|i| channels.get(i).and_then(Value::as_f64)) else {
            return self.ignored(key, "not three numbers", warnings);
        };
        let color = Vec3::new(r as f32, g as f32, b as f32);
        let held = color.clamp(Vec3::ZERO, Vec3::ONE);
        if channels.len() != 3 {
            return self.ignored(key, "not three numbers", warnings);
        }
        if held != color {
            warnings.push(format!("{}.{key}: {color} was clamped to 0…1", self.at));
        }
        Some(held)
    }

    /// Returns this if it is an object, and adds a warning otherwise.
    fn object(self, warnings: &mut Warnings) -> Option<Self> {
        if self.json.is_object() {
            return Some(self);
        }
        warnings.push(format!("{} is no object; it is ignored", self.at));
        None
    }

    /// Adds the warning about a value that is ignored.
    fn ignored<T>(&self, key: &str, why: &str, warnings: &mut Warnings) -> Option<T> {
        warnings.push(format!("{}.{key} is {why}; it is ignored", self.at));
        None
    }
}
