//! Material factors that can be edited live.

use framegraph_scene::Material;
use glam::{Vec3, Vec4};

/// Factors of a material, without textures and properties that select a shader; units as in [`Material`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors {
    /// Base color and alpha, 0…1, linear.
    pub base_color: Vec4,
    /// Metallic factor, 0…1.
    pub metallic: f32,
    /// Perceptual roughness, 0…1.
    pub roughness: f32,
    /// Emission per channel, 0 or more.
    pub emissive: Vec3,
    /// Index of refraction, 1 or more; 0 stands for infinity.
    pub ior: f32,
    /// Scale of the x and y components of the normal.
    pub normal_scale: f32,
    /// Strength of the occlusion texture, 0…1.
    pub occlusion_strength: f32,
}

impl Factors {
    /// Returns the factors of a material.
    pub fn of(material: &Material) -> Self {
        let Material { base_color, metallic, roughness, emissive, ior, normal_scale, occlusion_strength, .. } =
            *material;
        Self { base_color, metallic, roughness, emissive, ior, normal_scale, occlusion_strength }
    }

    /// Returns a material with these factors.
    #[must_use]
    pub fn on(self, material: &Material) -> Material {
        let Self { base_color, metallic, roughness, emissive, ior, normal_scale, occlusion_strength } = self;
        let own = material.clone();
        Material { base_color, metallic, roughness, emissive, ior, normal_scale, occlusion_strength, ..own }
    }
}
