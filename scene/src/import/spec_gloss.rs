//! Conversion of KHR_materials_pbrSpecularGlossiness to metallic-roughness materials.
//!
//! Filament's `shading_model_specularGlossiness` uses the specular color as f0 and a perceptual roughness of 1 −
//! glossiness. The diffuse color is multiplied by 1 − max(f0). The equivalent in KHR_materials_specular has an index of
//! refraction of 0: a dielectric of f0 1, tinted by the specular color. Textured roughness becomes a new image, since
//! glossiness is inverted and stored in alpha.

use glam::{Vec3, Vec4};
use gltf_json as json;

use super::object::Object;
use super::source::{Source, Warnings};
use super::texture::Textures;
use crate::error::SceneError;
use crate::material::{Material, Specular};
use crate::texture::TextureRole;

/// Name of the extension.
const NAME: &str = "KHR_materials_pbrSpecularGlossiness";

/// Returns true if the extension replaces the metallic-roughness parameters of a glTF material.
pub(super) fn replaces(json: &json::Material) -> bool {
    json.extensions.as_ref().is_some_and(|extensions| extensions.others.contains_key(NAME))
}

/// Replaces the metallic-roughness parameters of `material` if the glTF material `json`, named `at`, has the extension.
pub(super) fn read(
    source: &Source<'_>,
    at: &str,
    json: &json::Material,
    textures: &mut Textures,
    warnings: &mut Warnings,
    material: &mut Material,
) -> Result<(), SceneError> {
    let Some(json) = Object::of_material(source, at, json, NAME)? else {
        return Ok(());
    };
    let diffuse = json.vector("diffuseFactor", Vec4::ONE.to_array())?;
    let diffuse = Vec4::from_array(diffuse).clamp(Vec4::ZERO, Vec4::ONE);
    let specular = json.color("specularFactor", Vec3::ONE, 1.0, warnings)?;
    let glossiness = json.unit("glossinessFactor", 1.0, warnings)?;
    let mut slot = |key: &str| match json.texture(key)? {
        Some(reference) => textures.slot(source, json.at(), &reference, TextureRole::Color, warnings),
        None => Ok(None),
    };
    let base_color_texture = slot("diffuseTexture")?;
    let color_texture = slot("specularGlossinessTexture")?;
    let metallic_roughness_texture = color_texture.map(|slot| textures.roughness_of_glossiness(slot, glossiness));
    *material = Material {
        base_color: diffuse,
        base_color_texture,
        metallic: 0.0,
        roughness: if metallic_roughness_texture.is_some() { 1.0 } else { 1.0 - glossiness },
        metallic_roughness_texture,
        ior: 0.0,
        specular: Some(Specular { factor: 1.0, color: specular, texture: None, color_texture }),
        ..std::mem::take(material)
    };
    Ok(())
}
