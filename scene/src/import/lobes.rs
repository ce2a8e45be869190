//! Material lobes: the KHR_materials extensions of the metallic-roughness model.
//!
//! A lobe that its factor disables is omitted with its textures, since it has no effect, unless an animation changes
//! it.

use glam::Vec3;
use gltf_json as json;

use super::object::Object;
use super::source::{Source, Warnings};
use super::texture::{Reference, Textures};
use crate::error::SceneError;
use crate::material::{
    Anisotropy, ClearCoat, DiffuseTransmission, Iridescence, Material, Sheen, Specular, Transmission, Volume,
};
use crate::texture::{TextureRole, TextureSlot};

/// Context for reading a material.
struct Reading<'a, 'b> {
    source: &'a Source<'a>,
    textures: &'b mut Textures,
    warnings: &'b mut Warnings,
}

/// Reads the lobes of the glTF material `json`, named `at`, into `material`.
pub(super) fn read(
    source: &Source<'_>,
    at: &str,
    json: &json::Material,
    textures: &mut Textures,
    warnings: &mut Warnings,
    material: &mut Material,
) -> Result<(), SceneError> {
    let mut reading = Reading { source, textures, warnings };
    let of = |name: &str| Object::of_material(source, at, json, name);
    if let Some(json) = of("KHR_materials_clearcoat")? {
        material.clear_coat = reading.clear_coat(&json)?;
    }
    if let Some(json) = of("KHR_materials_sheen")? {
        material.sheen = reading.sheen(&json)?;
    }
    if let Some(json) = of("KHR_materials_anisotropy")? {
        material.anisotropy = reading.anisotropy(&json)?;
    }
    if let Some(json) = of("KHR_materials_transmission")? {
        material.transmission = reading.transmission(&json)?;
    }
    if let Some(json) = of("KHR_materials_diffuse_transmission")? {
        material.diffuse_transmission = reading.diffuse_transmission(&json)?;
    }
    let passes = material.transmission.is_some() || material.diffuse_transmission.is_some();
    if let Some(json) = of("KHR_materials_volume")?.filter(|_| passes) {
        let volume = reading.volume(&json)?;
        material.transmission = material.transmission.map(|lobe| Transmission { volume, ..lobe });
        material.diffuse_transmission =
            material.diffuse_transmission.map(|lobe| DiffuseTransmission { volume, ..lobe });
    }
    if let Some(json) = of("KHR_materials_dispersion")? {
        let dispersion = json.at_least("dispersion", 0.0, 0.0, reading.warnings)?;
        material.dispersion = (dispersion > 0.0 || json.is_animated()).then_some(dispersion);
    }
    if let Some(json) = of("KHR_materials_specular")? {
        material.specular = reading.specular(&json)?;
    }
    if let Some(json) = of("KHR_materials_iridescence")? {
        material.iridescence = reading.iridescence(&json)?;
    }
    Ok(())
}

impl Reading<'_, '_> {
    fn slot(&mut self, json: &Object<'_>, key: &str, role: TextureRole) -> Result<Option<TextureSlot>, SceneError> {
        let reference: Option<Reference<'_>> = json.texture(key)?;
        let Some(reference) = reference else {
            return Ok(None);
        };
        self.textures.slot(self.source, json.at(), &reference, role, self.warnings)
    }

    fn clear_coat(&mut self, json: &Object<'_>) -> Result<Option<ClearCoat>, SceneError> {
        let factor = json.unit("clearcoatFactor", 0.0, self.warnings)?;
        let roughness = json.unit("clearcoatRoughnessFactor", 0.0, self.warnings)?;
        let normal_scale = json.normal_scale("clearcoatNormalTexture")?;
        if factor == 0.0 && !json.is_animated() {
            return Ok(None);
        }
        Ok(Some(ClearCoat {
            factor,
            roughness,
            normal_scale,
            texture: self.slot(json, "clearcoatTexture", TextureRole::Linear)?,
            roughness_texture: self.slot(json, "clearcoatRoughnessTexture", TextureRole::Linear)?,
            normal_texture: self.slot(json, "clearcoatNormalTexture", TextureRole::Normal)?,
            keeps_base_f0: false,
        }))
    }

    fn sheen(&mut self, json: &Object<'_>) -> Result<Option<Sheen>, SceneError> {
        let color = json.color("sheenColorFactor", Vec3::ZERO, 1.0, self.warnings)?;
        let roughness = json.unit("sheenRoughnessFactor", 0.0, self.warnings)?;
        if color == Vec3::ZERO && !json.is_animated() {
            return Ok(None);
        }
        Ok(Some(Sheen {
            color,
            roughness,
            color_texture: self.slot(json, "sheenColorTexture", TextureRole::Color)?,
            roughness_texture: self.slot(json, "sheenRoughnessTexture", TextureRole::Linear)?,
        }))
    }

    fn anisotropy(&mut self, json: &Object<'_>) -> Result<Option<Anisotropy>, SceneError> {
        let strength = json.unit("anisotropyStrength", 0.0, self.warnings)?;
        let rotation_rad = json.number("anisotropyRotation", 0.0)?;
        if strength == 0.0 && !json.is_animated() {
            return Ok(None);
        }
        let texture = self.slot(json, "anisotropyTexture", TextureRole::Linear)?;
        Ok(Some(Anisotropy { strength, rotation_rad, texture }))
    }

    fn transmission(&mut self, json: &Object<'_>) -> Result<Option<Transmission>, SceneError> {
        let factor = json.unit("transmissionFactor", 0.0, self.warnings)?;
        if factor == 0.0 && !json.is_animated() {
            return Ok(None);
        }
        let texture = self.slot(json, "transmissionTexture", TextureRole::Linear)?;
        Ok(Some(Transmission { factor, texture, volume: None }))
    }

    fn diffuse_transmission(&mut self, json: &Object<'_>) -> Result<Option<DiffuseTransmission>, SceneError> {
        let factor = json.unit("diffuseTransmissionFactor", 0.0, self.warnings)?;
        let color = json.color("diffuseTransmissionColorFactor", Vec3::ONE, 1.0, self.warnings)?;
        if factor == 0.0 && !json.is_animated() {
            return Ok(None);
        }
        let texture = self.slot(json, "diffuseTransmissionTexture", TextureRole::Linear)?;
        let color_texture = self.slot(json, "diffuseTransmissionColorTexture", TextureRole::Color)?;
        Ok(Some(DiffuseTransmission { factor, texture, color, color_texture, volume: None }))
    }

    fn iridescence(&mut self, json: &Object<'_>) -> Result<Option<Iridescence>, SceneError> {
        let factor = json.unit("iridescenceFactor", 0.0, self.warnings)?;
        let ior = json.at_least("iridescenceIor", 1.3, 1.0, self.warnings)?;
        let min_thickness_nm = json.at_least("iridescenceThicknessMinimum", 100.0, 0.0, self.warnings)?;
        let max_thickness_nm = json.at_least("iridescenceThicknessMaximum", 400.0, 0.0, self.warnings)?;
        if factor == 0.0 && !json.is_animated() {
            return Ok(None);
        }
        let texture = self.slot(json, "iridescenceTexture", TextureRole::Linear)?;
        let thickness_texture = self.slot(json, "iridescenceThicknessTexture", TextureRole::Linear)?;
        // Without a texture the film has uniform thickness; zero thickness means no film.
        if thickness_texture.is_none() && max_thickness_nm == 0.0 && !json.is_animated() {
            return Ok(None);
        }
        Ok(Some(Iridescence { factor, texture, ior, min_thickness_nm, max_thickness_nm, thickness_texture }))
    }

    fn volume(&mut self, json: &Object<'_>) -> Result<Option<Volume>, SceneError> {
        let thickness = json.number("thicknessFactor", 0.0)?;
        if thickness < 0.0 {
            return Err(json.malformed(format!("its thicknessFactor is {thickness}")));
        }
        let attenuation_color = json.color("attenuationColor", Vec3::ONE, 1.0, self.warnings)?;
        let attenuation_distance_m = json.number("attenuationDistance", f32::INFINITY)?;
        if attenuation_distance_m <= 0.0 {
            return Err(json.malformed(format!("its attenuationDistance is {attenuation_distance_m}")));
        }
        if thickness == 0.0 && !json.is_animated() {
            return Ok(None);
        }
        let thickness_texture = self.slot(json, "thicknessTexture", TextureRole::Linear)?;
        Ok(Some(Volume { thickness, thickness_texture, attenuation_color, attenuation_distance_m }))
    }

    fn specular(&mut self, json: &Object<'_>) -> Result<Option<Specular>, SceneError> {
        let specular = Specular {
            factor: json.unit("specularFactor", 1.0, self.warnings)?,
            color: json.color("specularColorFactor", Vec3::ONE, f32::INFINITY, self.warnings)?,
            texture: self.slot(json, "specularTexture", TextureRole::Linear)?,
            color_texture: self.slot(json, "specularColorTexture", TextureRole::Color)?,
        };
        Ok(Some(specular).filter(|specular| *specular != Specular::default() || json.is_animated()))
    }
}
