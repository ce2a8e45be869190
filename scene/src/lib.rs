//! The scene as plain data: meshes, materials, textures, instances, lights, cameras, environment.
//!
//! ```text
//! glTF, GLB ──> import ──┐
//! built-in name ─────────┼──> Scene (plain arrays, ids are positions)
//! .hdr, .exr, sky ───────┘         └──> bounds, draw lists, frustum, orbit: pure functions
//! ```
//!
//! Nothing here knows a GPU. Meters, right-handed, y up, linear Rec.709, lux, candela and nits throughout. What a file says is checked once, at import; a `Scene` that
//! was returned holds finite numbers and valid ids only.

mod assemble;
pub mod bounds;
pub mod builtin;
pub mod camera;
pub mod color;
pub mod draw_list;
pub mod environment;
pub mod error;
pub mod frustum;
pub mod geometry;
pub mod id;
pub mod import;
pub mod instance;
pub mod light;
pub mod material;
pub mod mesh;
pub mod mips;
pub mod parallel;
pub mod picture;
pub mod progress;
#[cfg(test)]
mod test_files;
pub mod texture;

use std::path::Path;

pub use bounds::Aabb;
pub use builtin::builtin;
pub use camera::{Camera, CameraChoice, Projection};
pub use draw_list::DrawLists;
pub use environment::Environment;
pub use error::SceneError;
pub use frustum::Frustum;
pub use id::{ImageId, MaterialId, MeshId, SamplerId, TextureId};
pub use instance::Instance;
pub use light::{Light, LightKind};
pub use material::{
    AlphaMode, Anisotropy, ClearCoat, EmissiveUnit, Lobe, Lobes, Material, Sheen, Specular, Transmission, Volume,
};
pub use mesh::Mesh;
pub use progress::{Progress, ProgressFn, Stage};
pub use texture::{Image, Sampler, Texture, TextureRole, TextureSlot, UvTransform};

/// Everything that can be drawn, and what lights it.
///
/// Ids are positions in these arrays; every id in a scene is valid in that scene.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The file's stem or the built-in name.
    pub name: String,
    /// Triangle meshes, shared by instances.
    pub meshes: Vec<Mesh>,
    /// Surfaces.
    pub materials: Vec<Material>,
    /// Decoded pictures.
    pub images: Vec<Image>,
    /// Ways of sampling.
    pub samplers: Vec<Sampler>,
    /// Pictures as materials use them.
    pub textures: Vec<Texture>,
    /// What is drawn where.
    pub instances: Vec<Instance>,
    /// Lights of the scene itself; the environment brings its own sun.
    pub lights: Vec<Light>,
    /// Cameras, in the order of the file.
    pub cameras: Vec<Camera>,
    /// What lights the scene from all around. Loaders leave it empty: glTF has none, and the
    /// built-in scenes go with any.
    pub environment: Option<Environment>,
    /// What was ignored or repaired while loading, a line each.
    pub warnings: Vec<String>,
}

impl Scene {
    /// Loads what a user names: a built-in scene, or a glTF or GLB file.
    ///
    /// A built-in name wins over a file of the same name; `./spheres` is the file.
    ///
    /// # Errors
    ///
    /// One line that names the file and the reason; for a name that is neither, the built-in names.
    pub fn open(name: &str, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        if builtin::NAMES.contains(&name) {
            return builtin(name);
        }
        let path = Path::new(name);
        // A bare word that is no file is a misspelt name rather than a missing file.
        let bare = !name.contains(['/', '\\', '.']);
        if bare && !path.exists() {
            return builtin(name);
        }
        import::load(path, progress)
    }

    /// The box around all instances; empty for a scene without any.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.instances.iter().fold(Aabb::EMPTY, |all, instance| all.union(instance.bounds))
    }

    /// The first camera of the scene, or [`camera::orbit`] when it has none.
    #[must_use]
    pub fn default_camera(&self, width_over_height: f64) -> Camera {
        match self.cameras.first() {
            Some(camera) => camera.clone(),
            None => camera::orbit(&self.bounds(), width_over_height),
        }
    }

    /// The number of triangles drawn, instances counted each.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.instances.iter().map(|instance| self.meshes[instance.mesh.index()].triangle_count()).sum()
    }

    /// The lobes that the materials of what is drawn call for.
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        let lobes = self.instances.iter().map(|instance| self.materials[instance.material.index()].lobes());
        lobes.fold(Lobes::NONE, Lobes::union)
    }

    /// Checks that ids are valid, meshes keep their promises and numbers are finite.
    ///
    /// # Errors
    ///
    /// A sentence about the first thing wrong. Loaders return scenes for which this is `Ok`.
    pub fn check(&self) -> Result<(), String> {
        for (i, mesh) in self.meshes.iter().enumerate() {
            mesh.check().map_err(|reason| format!("mesh {i} {:?}: {reason}", mesh.name))?;
        }
        for (i, material) in self.materials.iter().enumerate() {
            for slot in material.slots().into_iter().flatten() {
                if slot.texture.index() >= self.textures.len() || slot.uv_set > 1 {
                    return Err(format!("material {i}: texture slot {slot:?}"));
                }
            }
        }
        for (i, texture) in self.textures.iter().enumerate() {
            if texture.image.index() >= self.images.len() || texture.sampler.index() >= self.samplers.len() {
                return Err(format!("texture {i}: {texture:?}"));
            }
        }
        for (i, image) in self.images.iter().enumerate() {
            let texels = u64::from(image.width) * u64::from(image.height);
            if texels == 0 || image.rgba8.len() as u64 != texels * 4 {
                return Err(format!("image {i} {:?} has the wrong size", image.name));
            }
        }
        for (i, instance) in self.instances.iter().enumerate() {
            if instance.mesh.index() >= self.meshes.len()
                || instance.material.index() >= self.materials.len()
                || !instance.world_from_model.is_finite()
            {
                return Err(format!("instance {i} {:?}", instance.name));
            }
        }
        for (i, light) in self.lights.iter().enumerate() {
            if !(light.color.is_finite() && light.position.is_finite() && light.direction.is_finite()) {
                return Err(format!("light {i} {:?}", light.name));
            }
        }
        match self.cameras.iter().position(|c| !c.eye.is_finite()) {
            Some(i) => Err(format!("camera {i}")),
            None => Ok(()),
        }
    }
}
