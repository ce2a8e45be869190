//! View-independent data of a scene's instances: created once, and updated for instances that move.

use crate::gpu_scene::upload::MeshRange;
use crate::gpu_scene::upload::mesh_range::MeshRanges;
use crate::gpu_scene::upload::pack::object_uniforms;
use framegraph_scene::{Instance, MeshId, Renderables, Scene};
use framegraph_shaders::layout::ObjectUniforms;
use framegraph_wgpu::Workers;
use glam::DMat4;
use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

/// Number of instances whose transforms are uploaded together, about 100 kB.
pub(crate) const CHUNK: usize = 1024;
/// Minimum number of instances for which a second thread is used; their view takes about 50 µs.
const WORTH_A_THREAD: usize = 4096;

/// A scene's instances as views take them.
///
/// A view of a scene that was not prepared prepares it, which takes longer than the rest of the view. So an application keeps this
/// beside a scene that it looks at more than once ([`CameraView::prepared`](crate::CameraView::prepared)).
///
/// ```
/// use framegraph_passes::PreparedScene;
/// use framegraph_scene::{Material, Scene, geometry};
/// use glam::{DMat4, DVec3, Vec3};
///
/// let mut scene = Scene::default();
/// let ball = scene.add_mesh(geometry::sphere(0.5, 32, 16));
/// let red = scene.add_material(Material::dielectric("red", Vec3::new(0.6, 0.02, 0.02), 0.4));
/// scene.add_instance("ball", ball, red, DMat4::IDENTITY);
/// let mut prepared = PreparedScene::new(&scene);
///
/// let by = DVec3::new(0.0, 2.0, 0.0);
/// scene.instances[0].world_from_model.w_axis += by.extend(0.0);
/// scene.instances[0].bounds = scene.meshes[0].bounds.transformed(&scene.instances[0].world_from_model);
/// prepared.update(&scene, &[0]);
/// assert_eq!(prepared.renderables().whole().max.y, 2.5);
/// ```
#[derive(Clone, Debug, Default)]
pub struct PreparedScene {
    renderables: Renderables,
    /// Instances of the first view that hides some, with its visible layers.
    shown: OnceLock<(u8, Renderables)>,
    placements: Placements,
    /// Mesh of each instance, and the buffer ranges of meshes.
    meshes: Vec<MeshId>,
    ranges: MeshRanges,
    /// Additional threads for making views.
    pub workers: Option<Workers>,
}

impl PreparedScene {
    /// Prepares `scene` for views made on a single thread.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self {
            renderables: Renderables::new(scene),
            shown: OnceLock::new(),
            placements: Placements::new(scene),
            meshes: scene.instances.iter().map(|instance| instance.mesh).collect(),
            ranges: MeshRanges::new(&scene.meshes),
            workers: None,
        }
    }

    /// Updates the transforms of the instances `moved`. The number, meshes and materials of instances must not have
    /// changed; otherwise prepare the scene again.
    ///
    /// # Panics
    /// Panics if an instance does not exist.
    pub fn update(&mut self, scene: &Scene, moved: &[usize]) {
        self.renderables.update(scene, moved);
        self.shown = OnceLock::new();
        for &number in moved {
            let chunk = Arc::make_mut(&mut self.placements.0[number / CHUNK]);
            chunk.objects[number % CHUNK] = object_uniforms(&scene.instances[number]);
            chunk.world_from_model[number % CHUNK] = scene.instances[number].world_from_model;
        }
    }

    /// Returns the buffer range of an instance's mesh in a level of detail.
    pub(crate) fn mesh(&self, instance: u32, level: u8) -> MeshRange {
        self.ranges.of(self.meshes[instance as usize], level)
    }

    /// Returns the additional threads.
    pub(crate) fn pool(&self) -> Option<&rayon::ThreadPool> {
        self.workers.as_ref().and_then(Workers::pool)
    }

    /// Returns the results of both functions. `there` runs on another thread if one exists and the scene is large.
    pub(crate) fn both<A, B: Send>(&self, here: impl FnOnce() -> A, there: impl FnOnce() -> B + Send) -> (A, B) {
        match self.pool().filter(|_| self.placements.count() >= WORTH_A_THREAD) {
            Some(pool) => {
                let mut other = None;
                let own = pool.in_place_scope(|scope| {
                    scope.spawn(|_| other = Some(there()));
                    here()
                });
                // The scope ends when both are done.
                (own, other.unwrap_or_else(|| unreachable!("a scope waits for what it spawned")))
            }
            None => (here(), there()),
        }
    }

    /// Returns the data for culling and sorting.
    #[must_use]
    pub fn renderables(&self) -> &Renderables {
        &self.renderables
    }

    /// Returns the data for culling and sorting in a view of these visible layers ([`Renderables::shown`]). The data
    /// of the first view with hidden instances is kept until an instance moves.
    #[must_use]
    pub fn shown(&self, visible_layers: u8) -> Cow<'_, Renderables> {
        match self.shown.get() {
            Some((layers, shown)) if *layers == visible_layers => return Cow::Borrowed(shown),
            _ => {}
        }
        match self.renderables.shown(visible_layers) {
            Cow::Borrowed(all) => Cow::Borrowed(all),
            Cow::Owned(shown) => match self.shown.set((visible_layers, shown)) {
                Err((_, shown)) => Cow::Owned(shown),
                Ok(()) => self.shown(visible_layers),
            },
        }
    }

    /// Returns the view-independent data of instances for shaders.
    #[must_use]
    pub fn placements(&self) -> &Placements {
        &self.placements
    }
}

/// Consecutive instances.
#[derive(Clone, Debug, Default)]
struct Piece {
    objects: Vec<ObjectUniforms>,
    world_from_model: Vec<DMat4>,
}

/// View-independent transforms of instances, in pieces that are shared until they change. A buffer filled with an
/// unchanged piece needs no upload.
#[derive(Clone, Debug, Default)]
pub struct Placements(Vec<Arc<Piece>>);

impl Placements {
    fn new(scene: &Scene) -> Self {
        let chunk = |chunk: &[Instance]| {
            let world_from_model = chunk.iter().map(|instance| instance.world_from_model).collect();
            Arc::new(Piece { objects: chunk.iter().map(object_uniforms).collect(), world_from_model })
        };
        Self(scene.instances.chunks(CHUNK).map(chunk).collect())
    }

    /// Returns the number of instances.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.iter().map(|chunk| chunk.objects.len()).sum()
    }

    /// Returns the shader data of an instance.
    pub(crate) fn object(&self, instance: usize) -> &ObjectUniforms {
        &self.0[instance / CHUNK].objects[instance % CHUNK]
    }

    /// Returns the model-to-world matrix of an instance.
    pub(crate) fn of(&self, instance: usize) -> Option<&DMat4> {
        self.0.get(instance / CHUNK)?.world_from_model.get(instance % CHUNK)
    }

    /// Returns the pieces that differ from `before`, each with the index of its first instance.
    pub(crate) fn changed_since<'a>(&'a self, before: &'a Self) -> impl Iterator<Item = (usize, &'a [ObjectUniforms])> {
        let same = |number: usize, own| before.0.get(number).is_some_and(|other| Arc::ptr_eq(own, other));
        let others = self.0.iter().enumerate().filter(move |(number, own)| !same(*number, own));
        others.map(|(number, own)| (number * CHUNK, own.objects.as_slice()))
    }

    /// Returns the instances that moved since `before`: index, current and previous model-to-world matrix.
    pub(crate) fn moved_since<'a>(&'a self, before: &'a Self) -> impl Iterator<Item = (usize, &'a DMat4, &'a DMat4)> {
        let pieces = self.0.iter().zip(&before.0).enumerate().filter(|(_, (own, other))| !Arc::ptr_eq(own, other));
        let pairs = pieces.flat_map(|(piece, (own, other))| {
            let pairs = own.world_from_model.iter().zip(&other.world_from_model).enumerate();
            pairs.map(move |(at, (here, there))| (piece * CHUNK + at, here, there))
        });
        pairs.filter(|(_, here, there)| here != there)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_scene::{Aabb, Instance, MaterialId, MeshId};
    use glam::{DMat4, DVec3};

    /// An update replaces only the piece of the moved instance, and an earlier copy keeps its own.
    #[test]
    fn pieces_are_shared_until_they_change() {
        let mut scene = Scene { materials: vec![framegraph_scene::Material::default()], ..Scene::default() };
        let placed = |at: DMat4| Instance::new("", MeshId::new(0), MaterialId::new(0), at, &Aabb::EMPTY);
        scene.instances = vec![placed(DMat4::IDENTITY); 2 * CHUNK + 5];
        let mut prepared = PreparedScene::new(&scene);
        let before = prepared.placements().clone();
        scene.instances[CHUNK + 3] = placed(DMat4::from_scale(DVec3::splat(2.0)));
        prepared.update(&scene, &[CHUNK + 3]);
        let now = prepared.placements();
        let changed: Vec<_> = now.changed_since(&before).map(|(first, piece)| (first, piece.len())).collect();
        assert_eq!(changed, [(CHUNK, CHUNK)]);
        assert_ne!(now.0[1].objects[3], before.0[1].objects[3]);
        assert_eq!(now.changed_since(&Placements::default()).count(), 3);
        assert_eq!(now.count(), scene.instances.len());
    }
}
