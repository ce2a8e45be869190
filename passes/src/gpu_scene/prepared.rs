//! View-independent data of a scene's instances: created once, and updated for instances that move.

use crate::gpu_scene::placements::Placements;
use crate::gpu_scene::upload::MeshRange;
use crate::gpu_scene::upload::mesh_range::MeshRanges;
use framegraph_scene::{MeshId, Renderables, Scene};
use framegraph_wgpu::Workers;
use glam::DVec3;
use std::borrow::Cow;
use std::sync::OnceLock;

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
    /// Points in world space, in m, that translations of objects are relative to.
    reference_points: Vec<DVec3>,
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
        let mut reference_points = Vec::new();
        Self {
            renderables: Renderables::new(scene),
            shown: OnceLock::new(),
            placements: Placements::new(scene, &mut reference_points),
            reference_points,
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
            self.placements.place(number, &scene.instances[number], &mut self.reference_points);
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

    /// Returns the points in world space, in m, that translations of objects are relative to.
    pub(crate) fn reference_points(&self) -> &[DVec3] {
        &self.reference_points
    }

    /// Returns the view-independent data of instances for shaders.
    #[must_use]
    pub fn placements(&self) -> &Placements {
        &self.placements
    }
}
