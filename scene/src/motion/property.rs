//! Animated properties: of nodes, and with KHR_animation_pointer of materials, lights and cameras.

use glam::{Vec2, Vec3, Vec4};

use crate::camera::{Camera, Projection};
use crate::light::{Light, LightKind};
use crate::material::{AlphaMode, Material, MaterialId};
use crate::texture::TextureSlot;

/// Target property of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A property of a node, by index into [`Motion::nodes`](super::Motion::nodes).
    Node(usize, NodeProperty),
    /// A property of a material.
    Material(MaterialId, MaterialProperty),
    /// A property of a light, by index into [`Rest::lights`](super::Rest::lights).
    Light(usize, LightProperty),
    /// A property of a camera, by index into [`Scene::cameras`](crate::Scene::cameras).
    Camera(usize, CameraProperty),
}

/// A property of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeProperty {
    /// Translation in meters, 3 numbers.
    Translation,
    /// Rotation as a unit quaternion x, y, z, w; 4 numbers.
    Rotation,
    /// Scale per axis, 3 numbers.
    Scale,
    /// Morph target weights of the mesh, one number each.
    Weights,
}

/// A property of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightProperty {
    /// Linear Rec.709 color, 3 numbers.
    Color,
    /// Intensity: lux for a directional light, candela for others.
    Intensity,
    /// Range in meters, for a point or spot light.
    Range,
    /// Angle from a spot light's axis at which it begins to fade, in radians.
    InnerCone,
    /// Angle from a spot light's axis at which it ends, in radians.
    OuterCone,
}

/// A property of a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraProperty {
    /// Vertical field of view in radians.
    FovY,
    /// Half the width of an orthographic view in meters.
    HalfWidth,
    /// Half the height of an orthographic view in meters.
    HalfHeight,
    /// Near-plane distance in meters.
    Near,
    /// Far-plane distance in meters.
    Far,
}

/// A property of a material: a factor, or a component of a texture transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaterialProperty {
    /// A factor, by index into the table of factors.
    Factor(usize),
    /// A component of a texture transform, by index into the table of textures.
    Transform(usize, TransformPart),
}

/// Component of a texture transform (KHR_texture_transform).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransformPart {
    /// Translation, 2 numbers.
    Offset,
    /// Rotation in radians.
    Rotation,
    /// Scale, 2 numbers.
    Scale,
}

/// A factor of a material.
struct Factor {
    /// JSON pointer relative to the material.
    pointer: &'static str,
    /// Numbers per value.
    width: usize,
    /// Writes a value; does nothing if the material lacks the lobe.
    write: fn(&mut Material, &[f32]),
}

const fn factor(pointer: &'static str, width: usize, write: fn(&mut Material, &[f32])) -> Factor {
    Factor { pointer, width, write }
}

/// Converts a number to f32, clamped to finite values, which cubic interpolation may exceed.
fn finite(number: f64) -> f32 {
    number.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
}

/// Clamps a value to 0…1, the range of shading.
fn unit(value: &[f32]) -> f32 {
    value[0].clamp(0.0, 1.0)
}

/// Clamps a color to 0…1.
fn unit_color(value: &[f32]) -> Vec3 {
    Vec3::from_slice(value).clamp(Vec3::ZERO, Vec3::ONE)
}

/// Factors that a pointer may target (glTF 2.0 Asset Object Model).
const FACTORS: &[Factor] = &[
    factor("pbrMetallicRoughness/baseColorFactor", 4, |m, v| {
        m.base_color = Vec4::from_slice(v).clamp(Vec4::ZERO, Vec4::ONE);
    }),
    factor("pbrMetallicRoughness/metallicFactor", 1, |m, v| m.metallic = unit(v)),
    factor("pbrMetallicRoughness/roughnessFactor", 1, |m, v| m.roughness = unit(v)),
    factor("alphaCutoff", 1, |m, v| {
        if let AlphaMode::Mask { cutoff } = &mut m.alpha {
            *cutoff = v[0].max(0.0);
        }
    }),
    factor(EMISSIVE, 3, |m, v| m.emissive = Vec3::from_slice(v).max(Vec3::ZERO)),
    // Multiplies the animated factor.
    factor(STRENGTH, 1, |m, v| m.emissive = (m.emissive * v[0].max(0.0)).min(Vec3::MAX)),
    factor("normalTexture/scale", 1, |m, v| m.normal_scale = v[0]),
    factor("occlusionTexture/strength", 1, |m, v| m.occlusion_strength = unit(v)),
    factor("extensions/KHR_materials_ior/ior", 1, |m, v| {
        m.ior = if v[0] == 0.0 { 0.0 } else { v[0].max(1.0) };
    }),
    factor("extensions/KHR_materials_anisotropy/anisotropyStrength", 1, |m, v| {
        m.anisotropy.iter_mut().for_each(|lobe| lobe.strength = unit(v));
    }),
    factor("extensions/KHR_materials_anisotropy/anisotropyRotation", 1, |m, v| {
        m.anisotropy.iter_mut().for_each(|lobe| lobe.rotation_rad = v[0]);
    }),
    factor("extensions/KHR_materials_dispersion/dispersion", 1, |m, v| {
        m.dispersion.iter_mut().for_each(|dispersion| *dispersion = v[0].max(0.0));
    }),
    factor("extensions/KHR_materials_iridescence/iridescenceFactor", 1, |m, v| {
        m.iridescence.iter_mut().for_each(|lobe| lobe.factor = unit(v));
    }),
    factor("extensions/KHR_materials_iridescence/iridescenceIor", 1, |m, v| {
        m.iridescence.iter_mut().for_each(|lobe| lobe.ior = v[0].max(1.0));
    }),
    factor("extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", 1, |m, v| {
        m.iridescence.iter_mut().for_each(|lobe| lobe.min_thickness_nm = v[0].max(0.0));
    }),
    factor("extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", 1, |m, v| {
        m.iridescence.iter_mut().for_each(|lobe| lobe.max_thickness_nm = v[0].max(0.0));
    }),
    factor("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", 1, |m, v| {
        m.diffuse_transmission.iter_mut().for_each(|lobe| lobe.factor = unit(v));
    }),
    factor("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor", 3, |m, v| {
        m.diffuse_transmission.iter_mut().for_each(|lobe| lobe.color = unit_color(v));
    }),
    factor("extensions/KHR_materials_clearcoat/clearcoatFactor", 1, |m, v| {
        m.clear_coat.iter_mut().for_each(|lobe| lobe.factor = unit(v));
    }),
    factor("extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", 1, |m, v| {
        m.clear_coat.iter_mut().for_each(|lobe| lobe.roughness = unit(v));
    }),
    factor("extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", 1, |m, v| {
        m.clear_coat.iter_mut().for_each(|lobe| lobe.normal_scale = v[0]);
    }),
    factor("extensions/KHR_materials_sheen/sheenColorFactor", 3, |m, v| {
        m.sheen.iter_mut().for_each(|lobe| lobe.color = unit_color(v));
    }),
    factor("extensions/KHR_materials_sheen/sheenRoughnessFactor", 1, |m, v| {
        m.sheen.iter_mut().for_each(|lobe| lobe.roughness = unit(v));
    }),
    factor("extensions/KHR_materials_specular/specularFactor", 1, |m, v| {
        m.specular.iter_mut().for_each(|lobe| lobe.factor = unit(v));
    }),
    factor("extensions/KHR_materials_specular/specularColorFactor", 3, |m, v| {
        m.specular.iter_mut().for_each(|lobe| lobe.color = Vec3::from_slice(v).max(Vec3::ZERO));
    }),
    factor("extensions/KHR_materials_transmission/transmissionFactor", 1, |m, v| {
        m.transmission.iter_mut().for_each(|lobe| lobe.factor = unit(v));
    }),
    factor("extensions/KHR_materials_volume/thicknessFactor", 1, |m, v| {
        volume(m).for_each(|volume| volume.thickness = v[0].max(f32::MIN_POSITIVE));
    }),
    factor("extensions/KHR_materials_volume/attenuationDistance", 1, |m, v| {
        volume(m).for_each(|volume| volume.attenuation_distance_m = v[0].max(f32::MIN_POSITIVE));
    }),
    factor("extensions/KHR_materials_volume/attenuationColor", 3, |m, v| {
        volume(m).for_each(|volume| volume.attenuation_color = unit_color(v));
    }),
];

/// Pointer of the emissive factor, which the importer multiplies by KHR_materials_emissive_strength.
pub(crate) const EMISSIVE: &str = "emissiveFactor";

/// Pointer of the strength of emission (KHR_materials_emissive_strength).
pub(crate) const STRENGTH: &str = "extensions/KHR_materials_emissive_strength/emissiveStrength";

/// Returns the volumes of a material, which both kinds of transmission have.
fn volume(material: &mut Material) -> impl Iterator<Item = &mut crate::material::Volume> {
    let diffuse = material.diffuse_transmission.iter_mut().filter_map(|lobe| lobe.volume.as_mut());
    material.transmission.iter_mut().filter_map(|lobe| lobe.volume.as_mut()).chain(diffuse)
}

/// A texture of a material.
struct TextureAt {
    /// JSON pointer relative to the material.
    pointer: &'static str,
    /// Returns the slot.
    slot: fn(&mut Material) -> Option<&mut TextureSlot>,
}

const fn texture(pointer: &'static str, slot: fn(&mut Material) -> Option<&mut TextureSlot>) -> TextureAt {
    TextureAt { pointer, slot }
}

/// Textures whose transform a pointer may target.
const TEXTURES: &[TextureAt] = &[
    texture("pbrMetallicRoughness/baseColorTexture", |m| m.base_color_texture.as_mut()),
    texture("pbrMetallicRoughness/metallicRoughnessTexture", |m| m.metallic_roughness_texture.as_mut()),
    texture("normalTexture", |m| m.normal_texture.as_mut()),
    texture("occlusionTexture", |m| m.occlusion_texture.as_mut()),
    texture("emissiveTexture", |m| m.emissive_texture.as_mut()),
    texture("extensions/KHR_materials_anisotropy/anisotropyTexture", |m| m.anisotropy.as_mut()?.texture.as_mut()),
    texture("extensions/KHR_materials_clearcoat/clearcoatTexture", |m| m.clear_coat.as_mut()?.texture.as_mut()),
    texture("extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture", |m| {
        m.clear_coat.as_mut()?.roughness_texture.as_mut()
    }),
    texture("extensions/KHR_materials_clearcoat/clearcoatNormalTexture", |m| {
        m.clear_coat.as_mut()?.normal_texture.as_mut()
    }),
    texture("extensions/KHR_materials_sheen/sheenColorTexture", |m| m.sheen.as_mut()?.color_texture.as_mut()),
    texture("extensions/KHR_materials_sheen/sheenRoughnessTexture", |m| m.sheen.as_mut()?.roughness_texture.as_mut()),
    texture("extensions/KHR_materials_specular/specularTexture", |m| m.specular.as_mut()?.texture.as_mut()),
    texture("extensions/KHR_materials_specular/specularColorTexture", |m| m.specular.as_mut()?.color_texture.as_mut()),
    texture("extensions/KHR_materials_transmission/transmissionTexture", |m| m.transmission.as_mut()?.texture.as_mut()),
    texture("extensions/KHR_materials_volume/thicknessTexture", |m| {
        m.transmission.as_mut()?.volume.as_mut()?.thickness_texture.as_mut()
    }),
    texture("extensions/KHR_materials_volume/thicknessTexture", |m| {
        m.diffuse_transmission.as_mut()?.volume.as_mut()?.thickness_texture.as_mut()
    }),
    texture("extensions/KHR_materials_iridescence/iridescenceTexture", |m| m.iridescence.as_mut()?.texture.as_mut()),
    texture("extensions/KHR_materials_iridescence/iridescenceThicknessTexture", |m| {
        m.iridescence.as_mut()?.thickness_texture.as_mut()
    }),
    texture("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionTexture", |m| {
        m.diffuse_transmission.as_mut()?.texture.as_mut()
    }),
    texture("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorTexture", |m| {
        m.diffuse_transmission.as_mut()?.color_texture.as_mut()
    }),
];

impl MaterialProperty {
    /// Returns the property for a JSON pointer relative to a material.
    #[must_use]
    pub fn at(pointer: &str) -> Option<Self> {
        if let Some(place) = FACTORS.iter().position(|factor| factor.pointer == pointer) {
            return Some(Self::Factor(place));
        }
        let (texture, part) = pointer.split_once("/extensions/KHR_texture_transform/")?;
        let place = TEXTURES.iter().position(|own| own.pointer == texture)?;
        let part = match part {
            "offset" => TransformPart::Offset,
            "rotation" => TransformPart::Rotation,
            "scale" => TransformPart::Scale,
            _ => return None,
        };
        Some(Self::Transform(place, part))
    }

    /// Returns true if the property modifies a value written by another property of the material, and must be applied
    /// after it.
    #[cfg(feature = "gltf")]
    pub(crate) fn is_relative(self) -> bool {
        matches!(self, Self::Factor(place) if FACTORS[place].pointer == STRENGTH)
    }

    /// Returns the number of components of a value.
    #[must_use]
    pub fn width(self) -> usize {
        match self {
            Self::Factor(place) => FACTORS[place].width,
            Self::Transform(_, TransformPart::Rotation) => 1,
            Self::Transform(..) => 2,
        }
    }

    /// Writes a value of [`width`](Self::width) numbers, clamped to the property's range. Does nothing if the material
    /// lacks the lobe or texture.
    pub(super) fn write(self, material: &mut Material, value: &[f64]) {
        let value: Vec<f32> = value.iter().map(|number| finite(*number)).collect();
        match self {
            Self::Factor(place) => (FACTORS[place].write)(material, &value),
            Self::Transform(place, part) => {
                // Both kinds of transmission have the volume's texture.
                for texture in TEXTURES.iter().filter(|texture| texture.pointer == TEXTURES[place].pointer) {
                    (texture.slot)(material).into_iter().for_each(|slot| part.write(slot, &value));
                }
            }
        }
    }
}

impl TransformPart {
    fn write(self, slot: &mut TextureSlot, value: &[f32]) {
        match self {
            Self::Offset => slot.transform.offset = Vec2::from_slice(value),
            Self::Rotation => slot.transform.rotation_rad = value[0],
            Self::Scale => slot.transform.scale = Vec2::from_slice(value),
        }
    }
}

impl LightProperty {
    /// Returns the number of components of a value.
    #[must_use]
    pub fn width(self) -> usize {
        if self == Self::Color { 3 } else { 1 }
    }

    /// Writes a value, clamped to the property's range. Does nothing for a kind of light without the property.
    pub(super) fn write(self, light: &mut Light, value: &[f64]) {
        let first = finite(value[0]);
        match (self, &mut light.kind) {
            (Self::Color, _) => light.color = Vec3::from_array([0, 1, 2].map(|i| finite(value[i]).max(0.0))),
            (Self::Intensity, LightKind::Directional { illuminance_lux: strength, .. })
            | (
                Self::Intensity,
                LightKind::Point { intensity_candela: strength, .. }
                | LightKind::Spot { intensity_candela: strength, .. },
            ) => *strength = first.max(0.0),
            (Self::Range, LightKind::Point { range_m, .. } | LightKind::Spot { range_m, .. }) => {
                *range_m = Some(first.max(f32::MIN_POSITIVE));
            }
            (Self::InnerCone, LightKind::Spot { inner_cone_rad, outer_cone_rad, .. }) => {
                *inner_cone_rad = first.clamp(0.0, *outer_cone_rad * 0.999);
            }
            (Self::OuterCone, LightKind::Spot { inner_cone_rad, outer_cone_rad, .. }) => {
                *outer_cone_rad = first.clamp(1e-3, std::f32::consts::FRAC_PI_2);
                *inner_cone_rad = inner_cone_rad.min(*outer_cone_rad * 0.999);
            }
            (Self::Range | Self::InnerCone | Self::OuterCone, _) => {}
        }
    }
}

impl CameraProperty {
    /// Writes a value. Cameras with another projection are unchanged. Values are ignored if the field of view would
    /// leave 0 to π, or if the near plane would not be before the far plane.
    pub(super) fn write(self, camera: &mut Camera, value: &[f64]) {
        let value = value[0];
        match (self, &mut camera.projection) {
            (Self::FovY, Projection::Perspective { fov_y_rad, .. }) if value > 0.0 && value < std::f64::consts::PI => {
                *fov_y_rad = value;
            }
            (Self::Near, Projection::Perspective { near_m, far_m, .. })
                if value > 0.0 && far_m.is_none_or(|far_m| value < far_m) =>
            {
                *near_m = value;
            }
            (Self::Far, Projection::Perspective { near_m, far_m, .. }) if value > *near_m => *far_m = Some(value),
            (Self::HalfWidth, Projection::Orthographic { half_width_m, .. }) if value != 0.0 => {
                *half_width_m = Some(value.abs());
            }
            (Self::HalfHeight, Projection::Orthographic { half_height_m, .. }) if value != 0.0 => {
                *half_height_m = value.abs();
            }
            (Self::Near, Projection::Orthographic { near_m, far_m, .. }) if value >= 0.0 && value < *far_m => {
                *near_m = value;
            }
            (Self::Far, Projection::Orthographic { near_m, far_m, .. }) if value > *near_m => *far_m = value,
            _ => {}
        }
    }
}
