//! Levels of detail of a scene: generation, and selection for each drawn instance.

use crate::error::SceneError;
use crate::geometry::{ReadStreams, levels_of_detail};
use crate::parallel::in_parallel;
use crate::progress::{Progress, ProgressFn, Stage, report};
use crate::scene::Scene;
use glam::DMat3;
use std::ops::ControlFlow;
use std::path::PathBuf;

impl Scene {
    /// Generates [levels](crate::mesh::Mesh::levels) for every drawn mesh without levels, on all cores; this takes
    /// seconds for hundreds of thousands of triangles. Deformable meshes ([bodies](crate::motion::Body)) get none. Call
    /// this before uploading and preparing the scene.
    ///
    /// # Errors
    /// Fails if `progress` requests to stop.
    pub fn make_levels(&mut self, progress: &mut ProgressFn<'_>) -> Result<(), SceneError> {
        let mut read = vec![None; self.meshes.len()];
        for instance in &self.instances {
            let material = &self.materials[instance.material.index()];
            let own: &mut ReadStreams = read[instance.mesh.index()].get_or_insert_default();
            own.tangents |= material.tangent_uv_set().is_some();
            for slot in material.slots().into_iter().flatten() {
                let image = &self.images[self.textures[slot.texture.index()].image.index()];
                let texels = slot.transform.scale.abs().max_element() * image.width.max(image.height).max(1) as f32;
                let of_set = &mut own.uv_texels[slot.uv_set.min(1) as usize];
                *of_set = of_set.max(texels);
            }
        }
        for body in &self.motion.bodies {
            read[body.mesh.index()] = None;
        }
        let wanted = |(number, read): (usize, Option<ReadStreams>)| {
            read.filter(|_| self.meshes[number].levels.is_empty()).map(|read| (number, read))
        };
        let wanted: Vec<(usize, ReadStreams)> = read.into_iter().enumerate().filter_map(wanted).collect();
        let file = PathBuf::from(&self.name);
        let (mut made, mut told) = (Vec::new(), Ok(()));
        let meshes = &self.meshes;
        let work = |(number, read): &(usize, ReadStreams), ()| levels_of_detail(&meshes[*number], *read);
        in_parallel(
            &wanted,
            |_| (),
            work,
            |at, levels| {
                let number = wanted[at].0;
                made.push((number, levels));
                let (done, total, item) = (made.len(), wanted.len(), meshes[number].name.as_str());
                // Meshes in progress are finished after a stop.
                if told.is_ok() {
                    told = report(progress, &file, Progress { stage: Stage::Levels, done, total, item });
                }
                if told.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            },
        );
        told?;
        made.into_iter().for_each(|(number, levels)| self.meshes[number].levels = levels);
        Ok(())
    }
}

/// Returns the level of an instance; 0 if `levels` is empty, which means that all instances use full meshes.
#[must_use]
pub fn level_of(levels: &[u8], instance: u32) -> u8 {
    levels.get(instance as usize).copied().unwrap_or(0)
}

/// Level errors and scales of the instances of a scene, for level selection.
#[derive(Clone, Debug, Default)]
pub struct InstanceLevels {
    /// Error of each level of each mesh, in meters of model space; empty if no mesh has levels.
    errors_m: Vec<Vec<f32>>,
    /// Mesh and maximum scale of each instance.
    of: Vec<(u32, f64)>,
}

impl InstanceLevels {
    /// Collects the levels of `scene`.
    pub(crate) fn new(scene: &Scene) -> Self {
        if scene.meshes.iter().all(|mesh| mesh.levels.is_empty()) {
            return Self::default();
        }
        let errors = |mesh: &crate::Mesh| mesh.levels.iter().map(|level| level.error_m).collect();
        let mut own = Self { errors_m: scene.meshes.iter().map(errors).collect(), of: Vec::new() };
        // A deformed body invalidates the errors of its levels.
        scene.motion.bodies.iter().for_each(|body| own.errors_m[body.mesh.index()].clear());
        own.of = scene.instances.iter().map(Self::one).collect();
        own
    }

    /// Updates the scale of an instance that moved.
    pub(crate) fn update(&mut self, scene: &Scene, number: usize) {
        if let Some(own) = self.of.get_mut(number) {
            *own = Self::one(&scene.instances[number]);
        }
    }

    fn one(instance: &crate::Instance) -> (u32, f64) {
        let linear = DMat3::from_mat4(instance.world_from_model);
        let axes = [linear.x_axis, linear.y_axis, linear.z_axis];
        // Upper bound of the largest eigenvalue of MᵀM (Gershgorin), exact for orthogonal axes.
        let rows = axes.map(|axis| axes.iter().map(|other| axis.dot(*other).abs()).sum::<f64>());
        (instance.mesh.index() as u32, rows.into_iter().fold(0.0, f64::max).sqrt())
    }

    /// Returns true if no mesh has levels.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.of.is_empty()
    }

    /// Returns the coarsest level of each instance, to be [limited](Self::limit); empty if no mesh has levels.
    #[must_use]
    pub fn unlimited(&self) -> Vec<u8> {
        vec![u8::MAX; self.of.len()]
    }

    /// Limits the levels of the instances in `list` to those with an error of at most `most_m` of the instance, in
    /// meters of world space. Level 0 is the mesh itself.
    pub fn limit<'a>(&self, levels: &mut [u8], list: impl IntoIterator<Item = &'a u32>, most_m: impl Fn(u32) -> f64) {
        if self.is_empty() {
            return;
        }
        for number in list {
            let (Some(&(mesh, scale)), Some(level)) = (self.of.get(*number as usize), levels.get_mut(*number as usize))
            else {
                continue;
            };
            let errors = &self.errors_m[mesh as usize];
            if errors.is_empty() {
                *level = 0;
                continue;
            }
            let most = most_m(*number) / scale.max(f64::MIN_POSITIVE);
            *level = (*level).min(errors.partition_point(|error| f64::from(*error) <= most) as u8);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{cuboid, sphere};
    use crate::material::Material;
    use crate::progress::silent;
    use glam::{DMat4, DVec3, Vec3};

    fn scene() -> Scene {
        let mut scene = Scene::default();
        let (ball, cube) = (scene.add_mesh(sphere(1.0, 48, 24)), scene.add_mesh(cuboid(Vec3::ONE)));
        let white = scene.add_material(Material::dielectric("white", Vec3::ONE, 0.5));
        let mut shear = DMat4::IDENTITY;
        shear.y_axis.x = 3.0;
        let places =
            [DMat4::IDENTITY, DMat4::from_scale(DVec3::new(1.0, 4.0, -0.5)), DMat4::from_rotation_y(0.7), shear];
        places.into_iter().for_each(|place| scene.add_instance("ball", ball, white, place));
        scene.add_instance("cube", cube, white, DMat4::IDENTITY);
        scene
    }

    #[test]
    fn levels_are_made_once_and_of_what_is_still() {
        let mut scene = scene();
        assert!(scene.meshes.iter().all(|mesh| mesh.levels.is_empty()));
        let mut told = Vec::new();
        let tell = |p: Progress<'_>| {
            told.push((p.stage, p.done, p.total));
            ControlFlow::Continue(())
        };
        scene.make_levels(&mut { tell }).expect("levels");
        assert_eq!(told, [(Stage::Levels, 1, 2), (Stage::Levels, 2, 2)]);
        assert!(scene.meshes[0].levels.len() > 2 && scene.meshes[1].levels.is_empty());
        let before = scene.meshes.clone();
        scene.make_levels(&mut silent).expect("levels");
        assert_eq!(scene.meshes, before);
        assert_eq!(scene.check(), Ok(()));
        scene.meshes[0].levels.clear();
        let mut asked = 0;
        let mut stop = |_: Progress<'_>| {
            asked += 1;
            if asked == 1 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let stop = scene.make_levels(&mut stop).expect_err("it was stopped");
        assert!(stop.to_string().contains("making levels of detail"), "{stop}");
        assert!(scene.meshes[0].levels.is_empty());
    }

    /// The coarsest level within the error; larger instances have finer levels.
    #[test]
    fn levels_are_limited_by_the_size_of_instances() {
        let mut scene = scene();
        assert!(InstanceLevels::new(&scene).is_empty() && InstanceLevels::new(&scene).unlimited().is_empty());
        scene.make_levels(&mut silent).expect("levels");
        let own = InstanceLevels::new(&scene);
        let errors: Vec<f64> = scene.meshes[0].levels.iter().map(|level| level.error_m.into()).collect();
        let limited = |most_m: f64| {
            let mut levels = own.unlimited();
            own.limit(&mut levels, &[0, 1, 2, 3, 4], |_| most_m);
            levels
        };
        // A shear by 3 stretches lengths by at most 3.31.
        for (number, scale) in [(0, 1.0), (1, 4.0), (2, 1.0), (3, 3.31)] {
            for (level, error) in errors.iter().enumerate() {
                assert!(usize::from(limited(error * scale * 1.0001)[number]) > level || number == 3);
                assert!(usize::from(limited(error * scale * 0.9999)[number]) <= level, "{number} {level}");
            }
        }
        assert_eq!(limited(0.0), [0; 5]);
        assert_eq!(limited(1e9)[4], 0, "a cube has no levels");
        let mut levels = own.unlimited();
        own.limit(&mut levels, &[0], |_| 1e9);
        own.limit(&mut levels, &[0, 1], |_| 0.0);
        assert_eq!(levels, [0, 0, u8::MAX, u8::MAX, u8::MAX]);
    }
}
