//! What loaders promise of a scene, checked.

use crate::mesh::MeshError;
use crate::scene::Scene;
use crate::texture::TextureSlot;

/// What is wrong with a scene. Numbers are positions in its arrays.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidScene {
    /// A mesh breaks its promises.
    #[error("mesh {mesh}: {error}")]
    Mesh {
        /// Number of the mesh.
        mesh: usize,
        /// The promise that is broken.
        error: MeshError,
    },
    /// A material names a texture or a set of coordinates that there is not.
    #[error("material {material}: {slot:?}")]
    Slot {
        /// Number of the material.
        material: usize,
        /// The slot, with what it names.
        slot: TextureSlot,
    },
    /// A texture names an image or a sampler that there is not.
    #[error("texture {texture} names an image or sampler that is not in the scene")]
    Texture {
        /// Number of the texture.
        texture: usize,
    },
    /// An image has no texels, or not four bytes for each.
    #[error("image {image} has {bytes} bytes for its {texels} texels")]
    Image {
        /// Number of the image.
        image: usize,
        /// How many texels it has.
        texels: u64,
        /// How many bytes it has.
        bytes: usize,
    },
    /// An instance names a mesh or a material that there is not, or its transform is not finite.
    #[error("instance {instance} names a mesh or material that is not in the scene, or its transform is not finite")]
    Instance {
        /// Number of the instance.
        instance: usize,
    },
    /// A number of a light is not finite.
    #[error("light {light} has a number that is not finite")]
    Light {
        /// Number of the light.
        light: usize,
    },
    /// The eye of a camera is not finite.
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
    /// Checks that ids are valid, meshes keep their promises and numbers are finite.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong. Loaders return scenes for which this is `Ok`.
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
            let (texels, bytes) = (u64::from(image.width) * u64::from(image.height), image.rgba8.len());
            if texels == 0 || bytes as u64 != texels * 4 {
                return Err(InvalidScene::Image { image: i, texels, bytes });
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
