//! Validation of scenes: the guarantees of loaders, checked.

use crate::mesh::MeshError;
use crate::mips::level_count;
use crate::scene::Scene;
use crate::texture::{Image, TextureSlot};

/// First problem found in a scene. Numbers are positions in its arrays.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidScene {
    /// A mesh is invalid.
    #[error("mesh {mesh}: {error}")]
    Mesh {
        /// Number of the mesh.
        mesh: usize,
        /// Violated guarantee.
        error: MeshError,
    },
    /// A material refers to a texture or a set of texture coordinates that does not exist.
    #[error("material {material}: {slot:?}")]
    Slot {
        /// Number of the material.
        material: usize,
        /// Slot with the invalid reference.
        slot: TextureSlot,
    },
    /// A texture refers to an image or a sampler that does not exist.
    #[error("texture {texture} names an image or sampler that is not in the scene")]
    Texture {
        /// Number of the texture.
        texture: usize,
    },
    /// An image has no texels, a level with the wrong number of bytes, or an incomplete mip chain.
    #[error("image {image} has {bytes} bytes in {levels} levels for its {texels} texels")]
    Image {
        /// Number of the image.
        image: usize,
        /// Number of texels of the first level.
        texels: u64,
        /// Number of levels.
        levels: usize,
        /// Total bytes of all levels.
        bytes: u64,
    },
    /// An instance refers to a mesh or a material that does not exist, or its transform is not finite.
    #[error("instance {instance} names a mesh or material that is not in the scene, or its transform is not finite")]
    Instance {
        /// Number of the instance.
        instance: usize,
    },
    /// A value of a light is not finite.
    #[error("light {light} has a number that is not finite")]
    Light {
        /// Number of the light.
        light: usize,
    },
    /// The position of a camera is not finite.
    #[error("camera {camera} has an eye that is not finite")]
    Camera {
        /// Number of the camera.
        camera: usize,
    },
}

impl std::fmt::Debug for InvalidScene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl Scene {
    /// Checks that ids are valid, meshes are consistent and numbers are finite. Loaders return scenes for which this is
    /// `Ok`.
    ///
    /// # Errors
    ///
    /// Returns the first problem found.
    pub fn check(&self) -> Result<(), InvalidScene> {
        for (i, mesh) in self.meshes.iter().enumerate() {
            mesh.check().map_err(|error| InvalidScene::Mesh { mesh: i, error })?;
        }
        for (material, of) in self.materials.iter().enumerate() {
            let bad = |slot: &TextureSlot| slot.texture.index() >= self.textures.len() || slot.uv_set > 1;
            if let Some(slot) = of.slots().into_iter().flatten().find(bad) {
                return Err(InvalidScene::Slot { material, slot });
            }
        }
        for (i, texture) in self.textures.iter().enumerate() {
            if texture.image.index() >= self.images.len() || texture.sampler.index() >= self.samplers.len() {
                return Err(InvalidScene::Texture { texture: i });
            }
        }
        for (i, image) in self.images.iter().enumerate() {
            if !holds_its_levels(image) {
                let texels = u64::from(image.width) * u64::from(image.height);
                let (levels, bytes) = (image.levels.len(), image.size_bytes());
                return Err(InvalidScene::Image { image: i, texels, levels, bytes });
            }
        }
        for (i, instance) in self.instances.iter().enumerate() {
            if instance.mesh.index() >= self.meshes.len()
                || instance.material.index() >= self.materials.len()
                || !instance.world_from_model.is_finite()
            {
                return Err(InvalidScene::Instance { instance: i });
            }
        }
        for (i, light) in self.lights.iter().enumerate() {
            if !(light.color.is_finite() && light.position.is_finite() && light.direction.is_finite()) {
                return Err(InvalidScene::Light { light: i });
            }
        }
        match self.cameras.iter().position(|c| !c.eye.is_finite()) {
            Some(camera) => Err(InvalidScene::Camera { camera }),
            None => Ok(()),
        }
    }
}

/// Returns true if every level has the bytes of its size, and the mip chain is complete or to be generated.
fn holds_its_levels(image: &Image) -> bool {
    let side = image.format.block_side_texels();
    let has_whole_blocks = [image.width, image.height].iter().all(|texels| *texels > 0 && texels.is_multiple_of(side));
    let all = level_count(image.width, image.height) as usize;
    let count = image.levels.len();
    let fits =
        |(level, bytes): (u32, &Vec<u8>)| bytes.len() as u64 == image.format.level_bytes(image.level_size(level));
    has_whole_blocks && (count == all || count == 1 && side == 1) && (0..).zip(&image.levels).all(fits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::ImageFormat;

    #[test]
    fn images_hold_one_level_or_all() {
        let of = |format, width, height, levels: &[usize]| {
            let levels = levels.iter().map(|bytes| vec![0; *bytes]).collect();
            let image = Image { name: String::new(), width, height, format, levels };
            Scene { images: vec![image], ..Scene::default() }.check().is_ok()
        };
        use ImageFormat::{Bc7, Rgba8};
        assert!(of(Rgba8, 4, 2, &[32]) && of(Rgba8, 4, 2, &[32, 8, 4]) && of(Rgba8, 1, 1, &[4]));
        assert!(of(Bc7, 8, 4, &[32, 16, 16, 16]));
        assert!(
            !of(Rgba8, 4, 2, &[]) && !of(Rgba8, 4, 2, &[32, 8]) && !of(Rgba8, 4, 2, &[31]) && !of(Rgba8, 0, 4, &[0])
        );
        assert!(!of(Bc7, 8, 4, &[32]) && !of(Bc7, 8, 4, &[32, 16, 16, 4]) && !of(Bc7, 6, 4, &[32, 16, 16]));
        let refused = Scene { images: vec![Image::from_rgba8("a", 2, 2, vec![0; 15])], ..Scene::default() }.check();
        let message = refused.expect_err("a byte is missing").to_string();
        assert_eq!(message, "image 0 has 15 bytes in 1 levels for its 4 texels");
    }
}
