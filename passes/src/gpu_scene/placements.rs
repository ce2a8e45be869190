//! View-independent transforms of instances.
//!
//! The translation of an instance is relative to a reference point. Views upload reference points relative to the eye,
//! so a large static scene uploads a few points for each frame instead of every origin.

use crate::gpu_scene::upload::pack::object_uniforms;
use framegraph_scene::{Instance, Scene};
use framegraph_shaders::layout::ObjectUniforms;
use glam::{DMat4, DVec3};
use std::sync::Arc;

/// Number of instances whose transforms are uploaded together, about 100 kB.
pub(crate) const CHUNK: usize = 1024;
/// Maximum distance of an instance from a shared reference point in m; f32 rounds it by at most 4 µm.
const REACH_M: f64 = 64.0;

/// Consecutive instances.
#[derive(Clone, Debug)]
struct Piece {
    /// Data for shaders; empty after [`Placements::release`].
    objects: Arc<Vec<ObjectUniforms>>,
    world_from_model: Arc<Vec<DMat4>>,
    /// Identity of the contents.
    version: Arc<()>,
    /// Index of the reference point of all instances, or of the first one if each instance has its own.
    first_reference: u32,
    /// True if all instances share a reference point.
    is_compact: bool,
}

impl Piece {
    /// Places `instances`, and appends their reference points. They share one if they are close to each other.
    fn new(instances: &[Instance], references: &mut Vec<DVec3>) -> Self {
        let origins = || instances.iter().map(|instance| instance.world_from_model.w_axis.truncate());
        let low = origins().fold(DVec3::INFINITY, DVec3::min);
        let middle = 0.5 * (low + origins().fold(DVec3::NEG_INFINITY, DVec3::max));
        let mut own = Self {
            objects: Arc::new(instances.iter().map(object_uniforms).collect()),
            world_from_model: Arc::new(instances.iter().map(|instance| instance.world_from_model).collect()),
            version: Arc::default(),
            first_reference: 0,
            is_compact: origins().all(|origin| is_close(origin, middle)),
        };
        own.set_references(middle, references);
        own
    }

    /// Returns true if both have the same contents.
    fn is_version_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.version, &other.version)
    }

    /// Appends reference points: `middle`, or the origin of each instance.
    fn set_references(&mut self, middle: DVec3, references: &mut Vec<DVec3>) {
        self.first_reference = references.len() as u32;
        if self.is_compact {
            references.push(middle);
        } else {
            references.extend(self.world_from_model.iter().map(|placed| placed.w_axis.truncate()));
        }
        (0..self.objects.len()).for_each(|at| self.refer(at, references));
    }

    /// Sets the translation and the reference point of an instance.
    fn refer(&mut self, at: usize, references: &mut [DVec3]) {
        let own = if self.is_compact { 0 } else { at as u32 };
        let (origin, object) = (self.world_from_model[at].w_axis.truncate(), &mut Arc::make_mut(&mut self.objects)[at]);
        object.reference_point = self.first_reference + own;
        let reference = &mut references[object.reference_point as usize];
        if !self.is_compact {
            *reference = origin;
        }
        object.world_from_model.w_axis = (origin - *reference).as_vec3().extend(1.0);
    }
}

/// Returns true if f32 holds the difference of the points well, and false for coordinates that are not finite.
fn is_close(origin: DVec3, reference: DVec3) -> bool {
    (origin - reference).abs().cmple(DVec3::splat(REACH_M)).all()
}

/// View-independent transforms of instances, in pieces that are shared until they change. A buffer filled with an
/// unchanged piece needs no upload.
#[derive(Clone, Debug, Default)]
pub struct Placements(Vec<Piece>);

impl Placements {
    /// Places the instances of `scene`, and appends their reference points. A scene of a single piece has one for each
    /// instance, by its number.
    pub(crate) fn new(scene: &Scene, references: &mut Vec<DVec3>) -> Self {
        let mut own: Vec<Piece> = scene.instances.chunks(CHUNK).map(|piece| Piece::new(piece, references)).collect();
        if let [only] = own.as_mut_slice() {
            references.clear();
            only.is_compact = false;
            only.set_references(DVec3::ZERO, references);
        }
        Self(own)
    }

    /// Places an instance that moved. If it leaves its neighbors, each of them gets its own reference point.
    ///
    /// # Panics
    /// Panics if the instance does not exist.
    pub(crate) fn place(&mut self, number: usize, instance: &Instance, references: &mut Vec<DVec3>) {
        let (piece, at) = (&mut self.0[number / CHUNK], number % CHUNK);
        if Arc::get_mut(&mut piece.version).is_none() {
            piece.version = Arc::default();
        }
        Arc::make_mut(&mut piece.objects)[at] = object_uniforms(instance);
        Arc::make_mut(&mut piece.world_from_model)[at] = instance.world_from_model;
        let origin = instance.world_from_model.w_axis.truncate();
        if piece.is_compact && !is_close(origin, references[piece.first_reference as usize]) {
            piece.is_compact = false;
            piece.set_references(origin, references);
        } else {
            piece.refer(at, references);
        }
    }

    /// Returns the number of instances.
    #[must_use]
    pub fn count(&self) -> usize {
        // All pieces but the last are full.
        self.0.last().map_or(0, |last| (self.0.len() - 1) * CHUNK + last.world_from_model.len())
    }

    /// Drops the data for shaders, which is then not copied when instances move.
    pub(crate) fn release(&mut self) {
        let none = Arc::default();
        self.0.iter_mut().for_each(|piece| piece.objects = Arc::clone(&none));
    }

    /// Returns true if the data for shaders was dropped.
    pub(crate) fn is_released(&self) -> bool {
        self.0.first().is_some_and(|piece| piece.objects.len() < piece.world_from_model.len())
    }

    /// Returns the shader data of an instance, which must not be released.
    pub(crate) fn object(&self, instance: usize) -> &ObjectUniforms {
        &self.0[instance / CHUNK].objects[instance % CHUNK]
    }

    /// Returns the model-to-world matrix of an instance.
    pub(crate) fn of(&self, instance: usize) -> Option<&DMat4> {
        self.0.get(instance / CHUNK)?.world_from_model.get(instance % CHUNK)
    }

    /// Returns true if an instance has the same place in `other`.
    pub(crate) fn is_same(&self, other: &Self, instance: usize) -> bool {
        let piece = |own: &Self| own.0.get(instance / CHUNK).map(|piece| Arc::as_ptr(&piece.version));
        piece(self) == piece(other) || self.of(instance) == other.of(instance)
    }

    /// Returns the pieces that differ from `before`, each with the index of its first instance.
    pub(crate) fn changed_since<'a>(&'a self, before: &'a Self) -> impl Iterator<Item = (usize, &'a [ObjectUniforms])> {
        let same = |number: usize, own: &Piece| before.0.get(number).is_some_and(|other| own.is_version_of(other));
        let others = self.0.iter().enumerate().filter(move |(number, own)| !same(*number, own));
        others.map(|(number, own)| (number * CHUNK, own.objects.as_slice()))
    }

    /// Returns the instances that moved since `before`: index, current and previous model-to-world matrix.
    pub(crate) fn moved_since<'a>(&'a self, before: &'a Self) -> impl Iterator<Item = (usize, &'a DMat4, &'a DMat4)> {
        let pieces = self.0.iter().zip(&before.0).enumerate().filter(|(_, (own, other))| !own.is_version_of(other));
        let pairs = pieces.flat_map(|(piece, (own, other))| {
            let pairs = own.world_from_model.iter().zip(&*other.world_from_model).enumerate();
            pairs.map(move |(at, (here, there))| (piece * CHUNK + at, here, there))
        });
        pairs.filter(|(_, here, there)| here != there)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu_scene::prepared::PreparedScene;
    use framegraph_scene::{Aabb, MaterialId, MeshId};

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

    /// A place that is unknown has no effect on the other instances of its piece.
    #[test]
    fn unknown_places_stay_alone() {
        let mut scene = Scene { materials: vec![framegraph_scene::Material::default()], ..Scene::default() };
        let placed = |x: f64| DMat4::from_translation(DVec3::new(x, 1.0, 2.0));
        let instance = |x| Instance::new("", MeshId::new(0), MaterialId::new(0), placed(x), &Aabb::EMPTY);
        for unknown in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            scene.instances = (0..2 * CHUNK).map(|i| instance(if i == CHUNK - 1 { unknown } else { 3.0 })).collect();
            let prepared = PreparedScene::new(&scene);
            let object = prepared.placements().object(5);
            let reference = prepared.reference_points()[object.reference_point as usize];
            assert_eq!(reference.x + f64::from(object.world_from_model.w_axis.x), 3.0, "{unknown}");
        }
    }

    /// Reference point and translation add up to the origin, for instances close together, far apart, and after moves.
    #[test]
    fn origins_are_reference_points_with_translations() {
        let mut scene = Scene { materials: vec![framegraph_scene::Material::default()], ..Scene::default() };
        let far = DVec3::new(4e6, -3e6, 1e6);
        let at =
            |i: usize| far + DVec3::new((i % 97) as f64, 0.1 * (i % 7) as f64, if i < CHUNK { 0.0 } else { i as f64 });
        let placed = |at: DVec3| DMat4::from_translation(at);
        let instance = |i| Instance::new("", MeshId::new(0), MaterialId::new(0), placed(at(i)), &Aabb::EMPTY);
        scene.instances = (0..2 * CHUNK + 5).map(instance).collect();
        let mut prepared = PreparedScene::new(&scene);
        let check = |scene: &Scene, prepared: &PreparedScene, points: usize| {
            let references = prepared.reference_points();
            assert_eq!(references.len(), points);
            for (i, instance) in scene.instances.iter().enumerate() {
                let object = prepared.placements().object(i);
                let offset = object.world_from_model.w_axis.truncate().as_dvec3();
                let found = references[object.reference_point as usize] + offset;
                let error_m = (found - instance.world_from_model.w_axis.truncate()).abs().max_element();
                assert!(error_m <= 4e-6, "instance {i}: {error_m} m");
            }
        };
        // The first piece is close together, the second is not, and the last is short.
        check(&scene, &prepared, 1 + CHUNK + 1);
        for (number, by, points) in [(3, 1.0, 0), (CHUNK + 7, 1e3, 0), (4, 1e5, CHUNK), (4, -7.0, 0)] {
            scene.instances[number].world_from_model.w_axis.x += by;
            prepared.update(&scene, &[number]);
            check(&scene, &prepared, prepared.reference_points().len());
            assert!(points == 0 || prepared.reference_points().len() == 1 + CHUNK + 1 + points);
        }
        scene.instances.truncate(9);
        let few = PreparedScene::new(&scene);
        check(&scene, &few, 9);
        assert!((0..9).all(|i| few.placements().object(i).world_from_model.w_axis == glam::Vec4::W));
    }
}
