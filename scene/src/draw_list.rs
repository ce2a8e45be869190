//! What is drawn, in which order.

use super::camera::Camera;
use super::frustum::Frustum;
use super::material::{AlphaMode, Lobe};
use super::overlap::layers_from_front;
use super::scene::Scene;

/// Instance numbers of a scene by how they must be drawn. Order is a function of scene and camera:
/// ties keep the scene's order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawLists {
    /// Opaque, nearest first, so that depth rejects what is behind.
    pub opaque: Vec<usize>,
    /// Alpha-tested, nearest first.
    pub mask: Vec<usize>,
    /// Transmissive and not blended, nearest first: drawn after all opaque ones, and casting no shadow.
    pub transmit: Vec<usize>,
    /// Of each of these, how many layers of them lie over one another before it: those of layer 0 have nothing before them.
    /// Glass of one layer is not seen through glass of the same layer.
    pub transmit_layers: Vec<u8>,
    /// Blended, farthest first, so that each covers what is behind it.
    pub blend: Vec<usize>,
    /// How many instances are outside of the view frustum.
    pub culled: usize,
}

impl DrawLists {
    /// The instances that `camera` may see in a picture of `width_over_height`, sorted.
    ///
    /// The distance is that of the bounds' center along the view direction. Blended surfaces that
    /// intersect have no right order; that is the usual limit of sorted blending.
    #[must_use]
    pub fn for_camera(scene: &Scene, camera: &Camera, width_over_height: f64) -> Self {
        let frustum = Frustum::of_camera(camera, width_over_height);
        let mut lists = Self::of_scene_if(scene, |i| frustum.may_see(&scene.instances[i].bounds));
        let forward = camera.forward();
        let distance = |i: &usize| (scene.instances[*i].bounds.center() - camera.eye).dot(forward);
        // Stable sorts with a total order: NaN cannot make the result depend on the algorithm.
        let near = |a: &usize, b: &usize| distance(a).total_cmp(&distance(b));
        lists.opaque.sort_by(near);
        lists.mask.sort_by(near);
        lists.transmit.sort_by(near);
        lists.blend.sort_by(|a, b| near(b, a));
        let bounds: Vec<_> = lists.transmit.iter().map(|i| scene.instances[*i].bounds).collect();
        lists.transmit_layers = layers_from_front(&bounds, camera, width_over_height);
        lists
    }

    /// The instances that `keep` keeps, by their numbers, in the scene's order; others count as culled.
    #[must_use]
    pub fn of_scene_if(scene: &Scene, keep: impl Fn(usize) -> bool) -> Self {
        let mut lists = Self::default();
        for (i, instance) in scene.instances.iter().enumerate() {
            if !keep(i) {
                lists.culled += 1;
                continue;
            }
            let material = &scene.materials[instance.material.index()];
            let transmits = material.lobes().contains(Lobe::Transmission);
            match material.alpha {
                AlphaMode::Blend => lists.blend.push(i),
                _ if transmits => lists.transmit.push(i),
                AlphaMode::Opaque => lists.opaque.push(i),
                AlphaMode::Mask { .. } => lists.mask.push(i),
            }
        }
        lists
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat4, DVec3};

    use super::*;
    use crate::bounds::Aabb;
    use crate::camera::Projection;
    use crate::material::Material;
    use crate::{Instance, MaterialId, MeshId};

    #[test]
    fn lists_split_by_alpha_and_sort_by_distance() {
        let mut scene = Scene::default();
        for alpha in [AlphaMode::Opaque, AlphaMode::Mask { cutoff: 0.5 }, AlphaMode::Blend] {
            scene.materials.push(Material { alpha, ..Material::default() });
        }
        let transmission = Some(crate::Transmission { factor: 1.0, ..Default::default() });
        scene.materials.push(Material { transmission, ..Material::default() });
        let cube = Aabb { min: DVec3::splat(-0.1), max: DVec3::splat(0.1) };
        // z of each instance, and its material; the camera at z = 10 looks along −z.
        let z_and_material =
            [(0.0, 0), (5.0, 0), (5.0, 0), (2.0, 1), (-3.0, 2), (1.0, 2), (1.0, 2), (20.0, 0), (3.0, 3), (4.0, 3)];
        for (z, material) in z_and_material {
            scene.instances.push(Instance::new(
                "",
                MeshId::new(0),
                MaterialId::new(material),
                DMat4::from_translation(DVec3::new(0.0, 0.0, z)),
                &cube,
            ));
        }
        let projection = Projection::perspective(1.0, 0.1);
        let eye = DVec3::new(0.0, 0.0, 10.0);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection).expect("a camera");
        let lists = DrawLists::for_camera(&scene, &camera, 1.0);
        assert_eq!(lists.opaque, [1, 2, 0]);
        assert_eq!(lists.mask, [3]);
        assert_eq!(lists.blend, [4, 5, 6]);
        assert_eq!((lists.transmit, lists.transmit_layers), (vec![9, 8], vec![0, 1]));
        assert_eq!(lists.culled, 1);
        assert_eq!(DrawLists::of_scene_if(&scene, |i| i != 1).opaque, [0, 2, 7]);
    }
}
