//! Scene as plain arrays.

use std::path::PathBuf;

use glam::{DMat4, Vec3};

use crate::bounds::Aabb;
use crate::camera::{Camera, orbit};
use crate::instance::Instance;
use crate::light::Light;
use crate::material::{Lobes, Material, MaterialId};
use crate::mesh::{Mesh, MeshId};
use crate::motion::Motion;
use crate::texture::{Image, ImageId, Sampler, SamplerId, Texture, TextureId, TextureRole};

/// Scene: meshes, materials, textures, instances, lights and cameras.
///
/// Ids are positions in these arrays and are always valid. Scenes are loaded by file or name ([`Scene::open`]), or
/// built in code:
///
/// ```
/// use framegraph_scene::{Material, Scene, geometry};
/// use glam::{DMat4, DVec3, Vec3};
///
/// let mut scene = Scene::default();
/// let ball = scene.add_mesh(geometry::sphere(0.5, 32, 16));
/// let red = scene.add_material(Material::dielectric("red", Vec3::new(0.6, 0.02, 0.02), 0.4));
/// scene.add_instance("ball", ball, red, DMat4::from_translation(DVec3::new(0.0, 0.5, 0.0)));
/// assert_eq!(scene.check(), Ok(()));
/// assert_eq!(scene.bounds().max.y, 1.0);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Stem of the file name, or the built-in name.
    pub name: String,
    /// Meshes, shared by instances.
    pub meshes: Vec<Mesh>,
    /// Materials, shared by instances.
    pub materials: Vec<Material>,
    /// Decoded images, shared by textures.
    pub images: Vec<Image>,
    /// Texture sampling states, shared by textures.
    pub samplers: Vec<Sampler>,
    /// Images with their roles and samplers, used by materials.
    pub textures: Vec<Texture>,
    /// Instances: meshes placed with a material.
    pub instances: Vec<Instance>,
    /// Node hierarchy and animations, if any; see [`Scene::pose`].
    pub motion: Motion,
    /// Lights of the scene itself. The surroundings with their sun are a separate
    /// [`Environment`](crate::environment::Environment).
    pub lights: Vec<Light>,
    /// Cameras, in the order of the file.
    pub cameras: Vec<Camera>,
    /// Diffuse albedo of level ground that continues beyond the scene, linear Rec.709 in 0…1. A sky shows it below the
    /// horizon for a seamless transition. `None` if unspecified.
    pub ground_albedo: Option<Vec3>,
    /// Names of the file's material variants (KHR_materials_variants);
    /// [`LoadOptions::variant`](crate::LoadOptions::variant) selects one.
    pub variants: Vec<String>,
    /// Files from which the scene was read, including buffers and images; empty for a built-in scene.
    pub files: Vec<PathBuf>,
    /// Warnings about ignored or repaired parts of the file, one line each.
    pub warnings: Vec<String>,
}

impl Scene {
    /// Returns the bounding box of all instances; empty without instances.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.instances.iter().fold(Aabb::EMPTY, |all, instance| all.union(instance.bounds))
    }

    /// Returns the bounding box for framing the scene. If ground continues beyond the scene
    /// ([`ground_albedo`](Self::ground_albedo)), level instances are excluded.
    #[must_use]
    pub fn bounds_above_ground(&self) -> Aabb {
        let stands = |bounds: &Aabb| self.ground_albedo.is_none() || bounds.half_extent().y > 0.0;
        let above = self.instances.iter().map(|instance| instance.bounds).filter(stands);
        above.reduce(|all, own| all.union(own)).unwrap_or_else(|| self.bounds())
    }

    /// Returns the first camera of the scene, or [`orbit`] if there is none.
    #[must_use]
    pub fn default_camera(&self, width_over_height: f64) -> Camera {
        match self.cameras.first() {
            Some(camera) => camera.clone(),
            None => orbit(&self.bounds_above_ground(), width_over_height),
        }
    }

    /// Returns the number of drawn triangles; every instance counts.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.instances.iter().map(|instance| self.meshes[instance.mesh.index()].triangle_count()).sum()
    }

    /// Returns the lobes of all materials that instances use.
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        let lobes = self.instances.iter().map(|instance| self.materials[instance.material.index()].lobes());
        lobes.fold(Lobes::NONE, Lobes::union)
    }

    /// Returns true if the material of an instance tests or writes the stencil buffer.
    #[must_use]
    pub fn uses_stencil(&self) -> bool {
        self.instances.iter().any(|instance| self.materials[instance.material.index()].stencil.is_some())
    }

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

    /// Appends an instance: a mesh of this scene with a material of this scene.
    ///
    /// # Panics
    ///
    /// If the mesh does not exist in this scene.
    pub fn add_instance(&mut self, name: &str, mesh: MeshId, material: MaterialId, world_from_model: DMat4) {
        let bounds = &self.meshes[mesh.index()].bounds;
        let instance = Instance::new(name, mesh, material, world_from_model, bounds);
        self.instances.push(instance);
    }
}
