//! Material extensions that the schema leaves as JSON, with checked members.

use glam::Vec3;
use gltf_json as json;
use gltf_json::Value;

use super::source::{Source, Warnings};
use super::texture::{Reference, TransformSource};
use crate::error::SceneError;

/// An extension of a material.
pub(super) struct Object<'a> {
    source: &'a Source<'a>,
    /// Place for messages: `material 3: KHR_materials_sheen`.
    at: String,
    json: &'a Value,
}

impl<'a> Object<'a> {
    /// Returns the extension `name` of a material, if present.
    pub fn of_material(
        source: &'a Source<'a>,
        at: &str,
        material: &'a json::Material,
        name: &str,
    ) -> Result<Option<Self>, SceneError> {
        let extensions = material.extensions.as_ref();
        let Some(json) = extensions.and_then(|e| e.others.get(name)) else {
            return Ok(None);
        };
        let at = format!("{at}: {name}");
        if json.is_object() {
            Ok(Some(Self { source, at, json }))
        } else {
            Err(source.malformed(&at, "it is not an object"))
        }
    }

    /// Returns the place in the file, for messages.
    pub fn at(&self) -> &str {
        &self.at
    }

    /// Returns true if an animation changes a property of this extension, which may thus become visible.
    pub fn is_animated(&self) -> bool {
        self.source.is_animated(&self.at)
    }

    /// Returns an error about this extension.
    pub fn malformed(&self, reason: impl Into<String>) -> SceneError {
        self.source.malformed(&self.at, reason)
    }

    /// Returns a number in f32 range, or `default`.
    pub fn number(&self, key: &str, default: f32) -> Result<f32, SceneError> {
        self.json.get(key).map_or(Ok(default), |value| self.finite(key, value))
    }

    /// Returns a number in 0…1; others are clamped with a warning.
    pub fn unit(&self, key: &str, default: f32, warnings: &mut Warnings) -> Result<f32, SceneError> {
        let value = self.number(key, default)?;
        Ok(self.clamped(key, Vec3::splat(value), 1.0, warnings).x)
    }

    /// Returns a number of at least `min`; a smaller one is raised with a warning.
    pub fn at_least(&self, key: &str, default: f32, min: f32, warnings: &mut Warnings) -> Result<f32, SceneError> {
        let value = self.number(key, default)?;
        if value < min {
            warnings.push(format!("{}: its {key} was raised from {value} to {min}", self.at));
        }
        Ok(value.max(min))
    }

    /// Returns a color with channels in 0…`most`; others are clamped with a warning.
    pub fn color(&self, key: &str, default: Vec3, most: f32, warnings: &mut Warnings) -> Result<Vec3, SceneError> {
        Ok(self.clamped(key, Vec3::from_array(self.vector(key, default.to_array())?), most, warnings))
    }

    /// Returns `N` numbers in f32 range, or `default`.
    pub fn vector<const N: usize>(&self, key: &str, default: [f32; N]) -> Result<[f32; N], SceneError> {
        let Some(value) = self.json.get(key) else {
            return Ok(default);
        };
        let channels = value.as_array().filter(|channels| channels.len() == N);
        let channels = channels.ok_or_else(|| self.malformed(format!("its {key} is not {N} numbers")))?;
        let mut vector = [0.0; N];
        for (channel, value) in vector.iter_mut().zip(channels) {
            *channel = self.finite(key, value)?;
        }
        Ok(vector)
    }

    /// Returns a texture reference.
    pub fn texture(&self, key: &str) -> Result<Option<Reference<'a>>, SceneError> {
        let Some(info) = self.json.get(key) else {
            return Ok(None);
        };
        let whole = |name: &str| info.get(name).map(|value| value.as_u64().and_then(|v| u32::try_from(v).ok()));
        let Some(Some(texture)) = whole("index") else {
            return Err(self.malformed(format!("its {key} has no index of a texture")));
        };
        let Some(uv_set) = whole("texCoord").unwrap_or(Some(0)) else {
            return Err(self.malformed(format!("its {key} has no valid texCoord")));
        };
        let transform = info.get("extensions").and_then(|e| e.get("KHR_texture_transform"));
        Ok(Some(Reference { texture: texture as usize, uv_set, transform: transform.map(TransformSource::Json) }))
    }

    /// Returns the `scale` of a normal texture, by default 1.
    pub fn normal_scale(&self, key: &str) -> Result<f32, SceneError> {
        let scale = self.json.get(key).and_then(|info| info.get("scale"));
        scale.map_or(Ok(1.0), |value| self.finite(&format!("{key} scale"), value))
    }

    fn finite(&self, key: &str, value: &Value) -> Result<f32, SceneError> {
        let Some(number) = value.as_f64() else {
            return Err(self.malformed(format!("its {key} is not a number")));
        };
        let number = number as f32;
        if number.is_finite() { Ok(number) } else { Err(self.malformed(format!("its {key} is {number}"))) }
    }

    fn clamped(&self, key: &str, value: Vec3, most: f32, warnings: &mut Warnings) -> Vec3 {
        let held = value.clamp(Vec3::ZERO, Vec3::splat(most));
        if held != value {
            let range = if most.is_finite() { format!("0…{most}") } else { "0 or more".into() };
            warnings.push(format!("{}: its {key} was clamped to {range}", self.at));
        }
        held
    }
}
