//! What of a scene's instances stays from view to view: made once, updated where something moves.

use crate::upload::pack::object_uniforms;
use framegraph_scene::{Renderables, Scene};
use framegraph_shaders::layout::ObjectUniforms;
use std::sync::Arc;

/// Instances whose placement is uploaded together: a hundred kilobytes.
pub(crate) const CHUNK: usize = 1024;

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
    placements: Placements,
    /// On how many threads large scenes are culled; zero counts as one.
    pub threads: usize,
}

impl PreparedScene {
    /// That of `scene`, culled on one thread.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self { renderables: Renderables::new(scene), placements: Placements::new(scene), threads: 1 }
    }

    /// Takes over where the instances `moved` stand. Number, meshes and materials of instances are what they were; a scene of
    /// which they are not is prepared anew.
    ///
    /// # Panics
    /// When there is no such instance.
    pub fn update(&mut self, scene: &Scene, moved: &[usize]) {
        self.renderables.update(scene, moved);
        for &number in moved {
            let chunk = Arc::make_mut(&mut self.placements.0[number / CHUNK]);
            chunk[number % CHUNK] = object_uniforms(&scene.instances[number]);
        }
    }

    /// What culling and sorting read.
    #[must_use]
    pub fn renderables(&self) -> &Renderables {
        &self.renderables
    }

    /// What shaders read of instances, whatever the eye.
    #[must_use]
    pub fn placements(&self) -> &Placements {
        &self.placements
    }
}

/// The part of instances' placement that does not depend on the eye, in pieces that are shared until they change. A buffer that was filled
/// with a piece need not be filled with the same again.
#[derive(Clone, Debug, Default)]
pub struct Placements(Vec<Arc<Vec<ObjectUniforms>>>);

impl Placements {
    fn new(scene: &Scene) -> Self {
        let chunk = |chunk: &[_]| Arc::new(chunk.iter().map(object_uniforms).collect());
        Self(scene.instances.chunks(CHUNK).map(chunk).collect())
    }

    /// How many instances there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.iter().map(|chunk| chunk.len()).sum()
    }

    /// The pieces that are others than those of `before`, each with the number of its first instance.
    pub(crate) fn changed_since<'a>(&'a self, before: &'a Self) -> impl Iterator<Item = (usize, &'a [ObjectUniforms])> {
        let same = |number: usize, own| before.0.get(number).is_some_and(|other| Arc::ptr_eq(own, other));
        let others = self.0.iter().enumerate().filter(move |(number, own)| !same(*number, own));
        others.map(|(number, own)| (number * CHUNK, own.as_slice()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_scene::{Aabb, Instance, MaterialId, MeshId};
    use glam::{DMat4, DVec3};

    /// Only the piece with what moved is another, and a copy made before keeps its own.
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
        assert_ne!(now.0[1][3], before.0[1][3]);
        assert_eq!(now.changed_since(&Placements::default()).count(), 3);
        assert_eq!(now.count(), scene.instances.len());
    }
}
