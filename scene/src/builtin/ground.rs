//! Ground planes of the built-in scenes.

use glam::{DMat4, Vec2, Vec3};

use super::pattern;
use crate::geometry::plane;
use crate::material::Material;
use crate::scene::Scene;
use crate::texture::{Sampler, TextureRole, TextureSlot, UvTransform};

/// Width of the ground. At its edge the squares are too small to distinguish, and the sky continues with their mean
/// color.
const WIDTH_M: f32 = 96.0;

/// Adds checkered ground. The pattern repeats every `tile_m` and has two by two squares of two linear Rec.709 colors.
pub(super) fn checkered(scene: &mut Scene, colors: [Vec3; 2], roughness: f32, tile_m: f32) {
    let [dark, light] = colors;
    let checker = pattern::checker("checker", 64, dark, light);
    let texture = scene.add_texture(checker, TextureRole::Color, Sampler::default());
    let mesh = scene.add_mesh(plane(Vec2::splat(WIDTH_M), 8, Vec2::splat(WIDTH_M / tile_m)));
    let material = scene.add_material(Material {
        base_color_texture: Some(TextureSlot { texture, uv_set: 0, transform: UvTransform::default() }),
        ..Material::dielectric("ground", Vec3::ONE, roughness)
    });
    scene.add_instance("ground", mesh, material, DMat4::IDENTITY);
    scene.ground_albedo = Some(0.5 * (dark + light));
}
