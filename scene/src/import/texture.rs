//! Texture references: image, role, sampler, coordinates.

use std::collections::BTreeMap;

use glam::Vec2;
use gltf_json::extensions::texture::TextureTransform;
use gltf_json::texture::{MagFilter, MinFilter, WrappingMode};
use gltf_json::validation::Checked;

use super::extension::is_supported;
use super::source::{Source, Warnings, beyond};
use crate::error::SceneError;
use crate::texture::{Filter, Image, Sampler, Texture, TextureRole, TextureSlot, UvTransform, Wrap};
use crate::texture::{ImageId, SamplerId, TextureId};

/// A texture reference, unified from the schema's three types.
pub(super) struct Reference<'a> {
    /// Index of the texture in the file, unchecked.
    pub texture: usize,
    pub uv_set: u32,
    /// KHR_texture_transform, if present.
    pub transform: Option<TransformSource<'a>>,
}

/// Transform parsed by the schema, or as JSON if the schema does not cover it.
pub(super) enum TransformSource<'a> {
    Parsed(&'a TextureTransform),
    Json(&'a gltf_json::Value),
}

/// Textures of a scene, collected on first use, each once.
#[derive(Default)]
pub(super) struct Textures {
    /// File indices of images, in the order of their ids.
    pub images: Vec<usize>,
    pub samplers: Vec<Sampler>,
    pub textures: Vec<Texture>,
    /// Images computed from others; [`Textures::number_computed`] assigns their ids.
    pub computed: Vec<Roughness>,
    /// Computed image of each texture, if any.
    shows_computed: BTreeMap<TextureId, usize>,
}

/// A roughness image computed from a glossiness image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Roughness {
    /// Image with glossiness in alpha.
    pub image: ImageId,
    /// Factor of the glossiness, 0 to 1.
    pub glossiness: f32,
}

impl Roughness {
    /// Returns the image: G is 1 − factor · glossiness, B (metallic) is 0.
    pub fn compute(&self, images: &[Image]) -> Image {
        let source = &images[self.image.index()];
        let texel = |rgba: &[u8]| {
            let glossiness = self.glossiness * f32::from(rgba[3]) / 255.0;
            [0, ((1.0 - glossiness) * 255.0).round() as u8, 0, 255]
        };
        let computed = |level: &Vec<u8>| level.chunks_exact(4).flat_map(texel).collect();
        Image {
            name: format!("{}: roughness", source.name),
            levels: source.levels.iter().map(computed).collect(),
            ..*source
        }
    }
}

impl Textures {
    /// Returns the roughness slot for a glossiness slot.
    pub fn roughness_of_glossiness(&mut self, slot: TextureSlot, glossiness: f32) -> TextureSlot {
        let source = self.textures[slot.texture.index()];
        let computed = place_of(&mut self.computed, Roughness { image: source.image, glossiness });
        let shows = |(texture, shown): (&TextureId, &usize)| {
            *shown == computed && self.textures[texture.index()].sampler == source.sampler
        };
        let known = self.shows_computed.iter().find(|pair| shows(*pair)).map(|(texture, _)| *texture);
        let texture = known.unwrap_or_else(|| {
            self.textures.push(Texture { role: TextureRole::Linear, ..source });
            let texture = TextureId::new(self.textures.len() - 1);
            self.shows_computed.insert(texture, computed);
            texture
        });
        TextureSlot { texture, ..slot }
    }

    /// Assigns ids to computed images, after those of the file.
    pub fn number_computed(&mut self) {
        for (texture, computed) in &self.shows_computed {
            self.textures[texture.index()].image = ImageId::new(self.images.len() + computed);
        }
    }

    /// Resolves a reference; `None`, with a warning, if it uses texture coordinates that are not imported.
    pub fn slot(
        &mut self,
        source: &Source<'_>,
        at: &str,
        reference: &Reference<'_>,
        role: TextureRole,
        warnings: &mut Warnings,
    ) -> Result<Option<TextureSlot>, SceneError> {
        let all = &source.root.textures;
        let index = reference.texture;
        let json = all.get(index).ok_or_else(|| source.malformed(at, beyond("texture", index, all)))?;
        let (transform, uv_override) = transform(source, at, reference)?;
        let uv_set = uv_override.unwrap_or(reference.uv_set);
        if uv_set > 1 {
            warnings.push(format!("{at}: a texture uses TEXCOORD_{uv_set} and is ignored"));
            return Ok(None);
        }
        let Some(image) = image_of(source, at, index, json)? else {
            warnings.push(format!("texture {index} has no image that this build reads; it is left out"));
            return Ok(None);
        };
        let sampler = match json.sampler {
            Some(sampler) => read_sampler(source, at, sampler.value())?,
            None => Sampler::default(),
        };
        let texture = Texture {
            image: ImageId::new(place_of(&mut self.images, source.same_image(image))),
            role,
            sampler: SamplerId::new(place_of(&mut self.samplers, sampler)),
        };
        // Until ids are assigned, a texture of a computed image refers to its source image.
        let known = (0..self.textures.len()).find(|place| {
            self.textures[*place] == texture && !self.shows_computed.contains_key(&TextureId::new(*place))
        });
        let place = known.unwrap_or_else(|| {
            self.textures.push(texture);
            self.textures.len() - 1
        });
        Ok(Some(TextureSlot { texture: TextureId::new(place), uv_set, transform }))
    }
}

/// Extensions that replace the `source` image of a texture, in order of preference.
const IMAGE_EXTENSIONS: [&str; 2] = ["KHR_texture_basisu", "EXT_texture_webp"];

/// Returns the image of a texture: that of a supported extension, otherwise its `source`; `None` without either.
fn image_of(
    source: &Source<'_>,
    at: &str,
    index: usize,
    json: &gltf_json::Texture,
) -> Result<Option<usize>, SceneError> {
    let extension = |name: &&str| json.extensions.as_ref()?.others.get(*name);
    let supported = IMAGE_EXTENSIONS.iter().filter(|name| is_supported(name));
    let image = match supported.filter_map(extension).find_map(|value| value.get("source")) {
        Some(image) => image.as_u64().map_or(usize::MAX, |image| image.try_into().unwrap_or(usize::MAX)),
        // The schema's value for a texture without a source.
        None if json.source.value() == u32::MAX as usize => return Ok(None),
        None => json.source.value(),
    };
    if image >= source.root.images.len() {
        let reason = format!("texture {index} {}", beyond("image", image, &source.root.images));
        return Err(source.malformed(at, reason));
    }
    Ok(Some(image))
}

/// Returns the position of `value` in `all`, appending it if it is new.
fn place_of<T: PartialEq>(all: &mut Vec<T>, value: T) -> usize {
    all.iter().position(|v| *v == value).unwrap_or_else(|| {
        all.push(value);
        all.len() - 1
    })
}

/// Returns the transform, and the texture coordinate set that it overrides.
fn transform(
    source: &Source<'_>,
    at: &str,
    reference: &Reference<'_>,
) -> Result<(UvTransform, Option<u32>), SceneError> {
    let parsed: TextureTransform;
    let json = match reference.transform {
        None => return Ok((UvTransform::default(), None)),
        Some(TransformSource::Parsed(json)) => json,
        Some(TransformSource::Json(value)) => {
            parsed = gltf_json::deserialize::from_value(value.clone())
                .map_err(|e| source.malformed(at, format!("KHR_texture_transform: {e}")))?;
            &parsed
        }
    };
    let transform = UvTransform {
        offset: Vec2::from_array(json.offset.0),
        rotation_rad: json.rotation.0,
        scale: Vec2::from_array(json.scale.0),
    };
    if !transform.matrix().is_finite() {
        return Err(source.malformed(at, "a texture transform is not finite"));
    }
    Ok((transform, json.tex_coord))
}

fn read_sampler(source: &Source<'_>, at: &str, index: usize) -> Result<Sampler, SceneError> {
    let all = &source.root.samplers;
    let json = all.get(index).ok_or_else(|| source.malformed(at, beyond("sampler", index, all)))?;
    let unknown = || source.malformed(at, format!("sampler {index} has an unknown value"));
    let wrap = |mode: &Checked<WrappingMode>| match mode {
        Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
        Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::MirroredRepeat),
        Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::ClampToEdge),
        Checked::Invalid => Err(unknown()),
    };
    let mag = match json.mag_filter {
        None | Some(Checked::Valid(MagFilter::Linear)) => Filter::Linear,
        Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
        Some(Checked::Invalid) => return Err(unknown()),
    };
    let (min, mip) = match json.min_filter {
        None => (Filter::Linear, Some(Filter::Linear)),
        Some(Checked::Invalid) => return Err(unknown()),
        Some(Checked::Valid(filter)) => match filter {
            MinFilter::Nearest => (Filter::Nearest, None),
            MinFilter::Linear => (Filter::Linear, None),
            MinFilter::NearestMipmapNearest => (Filter::Nearest, Some(Filter::Nearest)),
            MinFilter::LinearMipmapNearest => (Filter::Linear, Some(Filter::Nearest)),
            MinFilter::NearestMipmapLinear => (Filter::Nearest, Some(Filter::Linear)),
            MinFilter::LinearMipmapLinear => (Filter::Linear, Some(Filter::Linear)),
        },
    };
    Ok(Sampler { wrap_u: wrap(&json.wrap_s)?, wrap_v: wrap(&json.wrap_t)?, mag, min, mip })
}
