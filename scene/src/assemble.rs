//! Building a scene in code.

use glam::DMat4;

use super::Scene;
use super::id::{ImageId, MaterialId, MeshId, SamplerId, TextureId};
use super::instance::Instance;
use super::material::Material;
use super::mesh::Mesh;
use super::texture::{Image, Sampler, Texture, TextureRole};

impl Scene {
    /// Appends a mesh.
    pub fn add_mesh(&mut self, mesh: Mesh) -> MeshId {
        self.meshes.push(mesh);
        MeshId::new(self.meshes.len() - 1)
    }

    /// Appends a material.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId::new(self.materials.len() - 1)
    }

    /// Appends an image and a texture that shows it in one role.
    pub fn add_texture(&mut self, image: Image, role: TextureRole, sampler: Sampler) -> TextureId {
        self.images.push(image);
        let sampler = match self.samplers.iter().position(|s| *s == sampler) {
            Some(place) => SamplerId::new(place),
            None => {
                self.samplers.push(sampler);
                SamplerId::new(self.samplers.len() - 1)
            }
        };
        self.textures.push(Texture { image: ImageId::new(self.images.len() - 1), role, sampler });
        TextureId::new(self.textures.len() - 1)
    }

    /// Places a mesh of this scene with a material of this scene.
    ///
    /// # Panics
    ///
    /// When the mesh is of another scene and this one has fewer.
    pub fn place(&mut self, name: &str, mesh: MeshId, material: MaterialId, world_from_model: DMat4) {
        let bounds = &self.meshes[mesh.index()].bounds;
        let instance = Instance::new(name, mesh, material, world_from_model, bounds);
        self.instances.push(instance);
    }
}
