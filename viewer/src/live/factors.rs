//! A material's factors, which can be changed while it is drawn.

use framegraph_scene::Material;
use glam::{Vec3, Vec4};

/// What of a material is no texture and chooses no shader; in the units of [`Material`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors {
    /// Base color and alpha, 0…1, linear.
    pub base_color: Vec4,
    /// Share of metal, 0…1.
    pub metallic: f32,
    /// Perceptual roughness, 0…1.
    pub roughness: f32,
    /// Emission per channel, 0 or more.
    pub emissive: Vec3,
    /// Index of refraction, 1 or more; 0 stands for infinity.
    pub ior: f32,
    /// Scales x and y of the normal.
    pub normal_scale: f32,
    /// Strength of the occlusion texture, 0…1.
    pub occlusion_strength: f32,
}

impl Factors {
    /// Those of a material.
    pub fn of(material: &Material) -> Self {
        let Material { base_color, metallic, roughness, emissive, ior, normal_scale, occlusion_strength, .. } =
            *material;
        Self { base_color, metallic, roughness, emissive, ior, normal_scale, occlusion_strength }
    }

    /// The material with these.
    #[must_use]
    pub fn on(self, material: &Material) -> Material {
        let Self { base_color, metallic, roughness, emissive, ior, normal_scale, occlusion_strength } = self;
        let own = material.clone();
        Material { base_color, metallic, roughness, emissive, ior, normal_scale, occlusion_strength, ..own }
    }
}
