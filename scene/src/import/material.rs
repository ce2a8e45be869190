//! Metallic-roughness materials (glTF 2.0, section 3.9) and their extensions.

use std::collections::BTreeMap;

use glam::{Vec3, Vec4};
use gltf_json as json;
use gltf_json::validation::Checked;
use gltf_json::{Index, material};

use super::line_material::{LineStreams, for_lines};
use super::lobes;
use super::object::Object;
use super::source::{Source, Warnings, beyond};
use super::spec_gloss;
use super::switches::Switches;
use super::texture::{Reference, Roughness, Textures, TransformSource};
use crate::error::{SceneError, one_line};
use crate::material::MaterialId;
use crate::material::{AlphaMode, EmissiveUnit, Material};
use crate::texture::{Sampler, Texture, TextureRole, TextureSlot};

/// Materials of a scene, imported on first use, each once.
pub(super) struct Materials<'a> {
    source: &'a Source<'a>,
    /// Imported materials by file index; `None` is glTF's default material.
    known: BTreeMap<Option<usize>, MaterialId>,
    /// Variants for lines and points, by material number and vertex streams.
    without_area: BTreeMap<(usize, LineStreams), MaterialId>,
    materials: Vec<Material>,
    textures: Textures,
}

/// Results of importing the materials of a scene.
pub(super) struct Tables {
    /// Ids by file index; `None` is glTF's default material.
    pub known: BTreeMap<Option<usize>, MaterialId>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub samplers: Vec<Sampler>,
    /// File indices of the images.
    pub images: Vec<usize>,
    /// Images computed from those of the file; their ids follow.
    pub computed: Vec<Roughness>,
}

impl<'a> Materials<'a> {
    pub fn new(source: &'a Source<'a>) -> Self {
        let (known, without_area) = (BTreeMap::new(), BTreeMap::new());
        Self { source, known, without_area, materials: Vec::new(), textures: Textures::default() }
    }

    /// Returns the material of a primitive, named `at`.
    pub fn import(
        &mut self,
        index: Option<usize>,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<MaterialId, SceneError> {
        if let Some(id) = self.known.get(&index) {
            return Ok(*id);
        }
        let material = match index {
            None => Material::default(),
            Some(i) => {
                let all = &self.source.root.materials;
                let json = all.get(i).ok_or_else(|| self.source.malformed(at, beyond("material", i, all)))?;
                self.read(json, i, warnings)?
            }
        };
        self.materials.push(material);
        let id = MaterialId::new(self.materials.len() - 1);
        self.known.insert(index, id);
        Ok(id)
    }

    /// Returns the variant of a material for a primitive: the material itself for triangles, and that of [`for_lines`]
    /// for lines and points.
    pub fn for_primitive(&mut self, id: MaterialId, primitive: &json::mesh::Primitive) -> MaterialId {
        let Some(streams) = LineStreams::of(primitive) else { return id };
        if let Some(known) = self.without_area.get(&(id.index(), streams)) {
            return *known;
        }
        let (material, form) = (self.get(id), for_lines(self.get(id), streams));
        let own = if form == *material {
            id
        } else {
            self.materials.push(form);
            MaterialId::new(self.materials.len() - 1)
        };
        self.without_area.insert((id.index(), streams), own);
        own
    }

    pub fn get(&self, id: MaterialId) -> &Material {
        &self.materials[id.index()]
    }

    pub fn finish(mut self) -> Tables {
        self.textures.number_computed();
        Tables {
            known: self.known,
            materials: self.materials,
            textures: self.textures.textures,
            samplers: self.textures.samplers,
            images: self.textures.images,
            computed: self.textures.computed,
        }
    }

    fn read(&mut self, json: &json::Material, index: usize, warnings: &mut Warnings) -> Result<Material, SceneError> {
        let at = format!("material {index}");
        let source = self.source;
        let unit = |what: &str, value: f32, warnings: &mut Warnings| in_unit_range(source, &at, what, value, warnings);
        let pbr = &json.pbr_metallic_roughness;
        let metallic = unit("metallicFactor", pbr.metallic_factor.0, warnings)?;
        let roughness = unit("roughnessFactor", pbr.roughness_factor.0, warnings)?;
        let base = &pbr.base_color_factor.0;
        let mut base_color = Vec4::ZERO;
        for (channel, value) in base.iter().enumerate() {
            base_color[channel] = unit("baseColorFactor", *value, warnings)?;
        }
        let alpha = alpha_mode(json).map_err(|reason| source.malformed(&at, reason))?;
        let (emissive, emissive_unit) = emissive(json).map_err(|reason| source.malformed(&at, reason))?;

        let ior = ior(source, &at, json)?;

        let mut slot = |reference: Option<Reference<'_>>, role, warnings: &mut Warnings| {
            reference.map_or(Ok(None), |reference| self.textures.slot(source, &at, &reference, role, warnings))
        };
        // Textures that specular-glossiness replaces are not decoded.
        let of_pbr = |info| of_info(info).filter(|_| !spec_gloss::replaces(json));
        let base_color_texture = slot(of_pbr(pbr.base_color_texture.as_ref()), TextureRole::Color, warnings)?;
        let metallic_roughness_texture =
            slot(of_pbr(pbr.metallic_roughness_texture.as_ref()), TextureRole::Linear, warnings)?;
        let emissive_texture = slot(of_info(json.emissive_texture.as_ref()), TextureRole::Color, warnings)?;
        let normal_texture: Option<TextureSlot> =
            slot(of_normal(json.normal_texture.as_ref()), TextureRole::Normal, warnings)?;
        let occlusion_texture = slot(of_occlusion(json.occlusion_texture.as_ref()), TextureRole::Linear, warnings)?;

        let normal_scale = json.normal_texture.as_ref().map_or(1.0, |t| t.scale);
        if !normal_scale.is_finite() {
            return Err(source.malformed(&at, format!("its normal scale is {normal_scale}")));
        }
        let strength = json.occlusion_texture.as_ref().map_or(1.0, |t| t.strength.0);
        let occlusion_strength = unit("occlusion strength", strength, warnings)?;
        let unlit = json.extensions.as_ref().is_some_and(|e| e.unlit.is_some());
        let mut material = Material {
            name: one_line(json.name.as_deref().unwrap_or_default()),
            base_color,
            metallic,
            roughness,
            emissive,
            emissive_unit,
            ior,
            normal_scale,
            occlusion_strength,
            alpha,
            double_sided: json.double_sided,
            unlit,
            base_color_texture,
            metallic_roughness_texture,
            normal_texture,
            occlusion_texture,
            emissive_texture,
            ..Material::default()
        };
        lobes::read(source, &at, json, &mut self.textures, warnings, &mut material)?;
        spec_gloss::read(source, &at, json, &mut self.textures, warnings, &mut material)?;
        Switches::of(source.document, &format!("/materials/{index}"), &at, warnings).material(&mut material);
        Ok(material)
    }
}

/// Returns a factor in 0…1. Others are clamped with a warning; factors that are not finite are errors.
fn in_unit_range(
    source: &Source<'_>,
    at: &str,
    what: &str,
    value: f32,
    warnings: &mut Warnings,
) -> Result<f32, SceneError> {
    if !value.is_finite() {
        return Err(source.malformed(at, format!("its {what} is {value}")));
    }
    let clamped = value.clamp(0.0, 1.0);
    if clamped != value {
        warnings.push(format!("{at}: its {what} of {value} was clamped to {clamped}"));
    }
    Ok(clamped)
}

fn alpha_mode(json: &json::Material) -> Result<AlphaMode, String> {
    match json.alpha_mode {
        Checked::Valid(material::AlphaMode::Opaque) => Ok(AlphaMode::Opaque),
        Checked::Valid(material::AlphaMode::Blend) => Ok(AlphaMode::Blend),
        Checked::Valid(material::AlphaMode::Mask) => {
            let cutoff = json.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0);
            if cutoff.is_finite() && cutoff >= 0.0 {
                Ok(AlphaMode::Mask { cutoff })
            } else {
                Err(format!("its alpha cutoff is {cutoff}"))
            }
        }
        Checked::Invalid => Err("unknown alpha mode".into()),
    }
}

/// Returns the emissive factor; KHR_materials_emissive_strength multiplies it and makes it nits.
fn emissive(json: &json::Material) -> Result<(Vec3, EmissiveUnit), String> {
    let extensions = json.extensions.as_ref();
    let strength = extensions.and_then(|e| e.emissive_strength.as_ref());
    let (factor, unit) = match strength {
        Some(strength) => (strength.emissive_strength.0, EmissiveUnit::Nits),
        None => (1.0, EmissiveUnit::Display),
    };
    let emissive = Vec3::from_array(json.emissive_factor.0) * factor;
    if emissive.is_finite() && emissive.min_element() >= 0.0 {
        Ok((emissive, unit))
    } else {
        Err(format!("its emission is {emissive}"))
    }
}

/// Returns the index of refraction (KHR_materials_ior).
fn ior(source: &Source<'_>, at: &str, json: &json::Material) -> Result<f32, SceneError> {
    let Some(extension) = Object::of_material(source, at, json, "KHR_materials_ior")? else {
        return Ok(1.5);
    };
    let ior = extension.number("ior", 1.5)?;
    if ior == 0.0 || ior >= 1.0 {
        Ok(ior)
    } else {
        Err(extension.malformed(format!("its index of refraction is {ior}, neither 0 nor at least 1")))
    }
}

fn of_info(info: Option<&json::texture::Info>) -> Option<Reference<'_>> {
    let info = info?;
    let extensions = info.extensions.as_ref();
    let transform = extensions.and_then(|e| e.texture_transform.as_ref());
    Some(Reference {
        texture: info.index.value(),
        uv_set: info.tex_coord,
        transform: transform.map(TransformSource::Parsed),
    })
}

fn of_normal(info: Option<&material::NormalTexture>) -> Option<Reference<'_>> {
    let info = info?;
    let transform = info.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
    Some(with_json(&info.index, info.tex_coord, transform))
}

fn of_occlusion(info: Option<&material::OcclusionTexture>) -> Option<Reference<'_>> {
    let info = info?;
    let transform = info.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
    Some(with_json(&info.index, info.tex_coord, transform))
}

/// Returns a texture reference whose transform the schema leaves as JSON.
fn with_json<'a>(texture: &Index<json::Texture>, uv_set: u32, transform: Option<&'a json::Value>) -> Reference<'a> {
    Reference { texture: texture.value(), uv_set, transform: transform.map(TransformSource::Json) }
}
