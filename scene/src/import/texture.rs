//! Texture references: image, role, sampler, coordinates.

use glam::Vec2;
use gltf_json::extensions::texture::TextureTransform;
use gltf_json::texture::{MagFilter, MinFilter, WrappingMode};
use gltf_json::validation::Checked;

use super::extension::is_supported;
use super::source::{Source, Warnings, beyond};
use crate::error::SceneError;
use crate::texture::{Filter, Sampler, Texture, TextureRole, TextureSlot, UvTransform, Wrap};
use crate::texture::{ImageId, SamplerId, TextureId};

/// The three ways in which the schema writes a texture reference, as one.
pub(super) struct Reference<'a> {
    /// Index of the texture in the file, unchecked.
    pub texture: usize,
    pub uv_set: u32,
    /// KHR_texture_transform, if given.
    pub transform: Option<TransformSource<'a>>,
}

/// The transform parsed by the schema, or left as JSON where the schema does not know it.
pub(super) enum TransformSource<'a> {
    Parsed(&'a TextureTransform),
    Json(&'a gltf_json::Value),
}

/// The textures of a scene as they are found, each once.
#[derive(Default)]
pub(super) struct Textures {
    /// Indices of images in the file, in the order of their ids.
    pub images: Vec<usize>,
    pub samplers: Vec<Sampler>,
    pub textures: Vec<Texture>,
}

impl Textures {
    /// Resolves a reference; `None` with a warning when it uses coordinates that are not imported.
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
        Ok(Some(TextureSlot { texture: TextureId::new(place_of(&mut self.textures, texture)), uv_set, transform }))
    }
}

/// Extensions that give a texture another image than its `source`, the preferred one first.
const IMAGE_EXTENSIONS: [&str; 2] = ["KHR_texture_basisu", "EXT_texture_webp"];

/// Returns the image of a texture: that of an extension which this build reads, or else its `source`; `None` for a texture
/// without either.
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
        // The schema writes this for a texture without a source.
        None if json.source.value() == u32::MAX as usize => return Ok(None),
        None => json.source.value(),
    };
    if image >= source.root.images.len() {
        let reason = format!("texture {index} {}", beyond("image", image, &source.root.images));
        return Err(source.malformed(at, reason));
    }
    Ok(Some(image))
}

/// Where `value` is in `all`, appended if it is new.
fn place_of<T: PartialEq>(all: &mut Vec<T>, value: T) -> usize {
    all.iter().position(|v| *v == value).unwrap_or_else(|| {
        all.push(value);
        all.len() - 1
    })
}

/// The transform, and the coordinate set it overrides.
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
