//! What is drawn, in which order.

use super::camera::Camera;
use super::frustum::Frustum;
use super::overlap::layers_from_front;
use super::radix::{sort_key, sort_upper_halves};
use super::renderables::{DrawKind, Renderables};
use super::scene::Scene;

/// Instance numbers of a scene by how they must be drawn. Order is a function of scene and camera:
/// ties keep the scene's order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawLists {
    /// Opaque, nearest first, so that depth rejects what is behind.
    pub opaque: Vec<u32>,
    /// Alpha-tested, nearest first.
    pub mask: Vec<u32>,
    /// Transmissive and not blended, nearest first: drawn after all opaque ones, and casting no shadow.
    pub transmit: Vec<u32>,
    /// Of each of these, how many layers of them lie over one another before it: those of layer 0 have nothing before them.
    /// Glass of one layer is not seen through glass of the same layer.
    pub transmit_layers: Vec<u8>,
    /// Blended, farthest first, so that each covers what is behind it.
    pub blend: Vec<u32>,
    /// How many instances are outside of the view frustum.
    pub culled: usize,
}

impl DrawLists {
    /// The instances that `camera` may see in a picture of `width_over_height`, sorted, of a scene that is looked at once;
    /// [`DrawLists::seen`] otherwise.
    #[must_use]
    pub fn for_camera(scene: &Scene, camera: &Camera, width_over_height: f64) -> Self {
        Self::seen(&Renderables::new(scene), camera, width_over_height, None)
    }

    /// The same of what was made of a scene before; many instances are culled on the threads of `pool` too.
    ///
    /// The distance is that of the bounds' center along the view direction. Blended surfaces that
    /// intersect have no right order; that is the usual limit of sorted blending.
    #[must_use]
    pub fn seen(of: &Renderables, camera: &Camera, width_over_height: f64, pool: Option<&rayon::ThreadPool>) -> Self {
        let frustum = Frustum::of_camera(camera, width_over_height);
        let mut seen = Vec::new();
        of.boxes().reaching(camera.eye, frustum.planes(), pool, &mut seen);
        let mut lists = Self::of_kinds(of, &seen);
        let forward = camera.forward();
        let distance = |i: u32| ((of.bounds()[i as usize].center() - camera.eye).dot(forward)) as f32;
        let (mut keys, mut spare) = (Vec::new(), Vec::new());
        let mut sort = |list: &mut Vec<u32>, sign: f32| {
            keys.clear();
            keys.extend(list.iter().map(|i| sort_key(sign * distance(*i), *i)));
            sort_upper_halves(&mut keys, &mut spare);
            list.clear();
            list.extend(keys.iter().map(|key| *key as u32));
        };
        for nearest_first in [&mut lists.opaque, &mut lists.mask, &mut lists.transmit] {
            sort(nearest_first, 1.0);
        }
        sort(&mut lists.blend, -1.0);
        let bounds: Vec<_> = lists.transmit.iter().map(|i| of.bounds()[*i as usize]).collect();
        lists.transmit_layers = layers_from_front(&bounds, camera, width_over_height);
        lists
    }

    /// The instances of `list` by how they are drawn, in its order; all others count as culled.
    #[must_use]
    pub fn of_kinds(of: &Renderables, list: &[u32]) -> Self {
        let kind = |i: &u32| of.kinds()[*i as usize];
        let mut counts = [0; 4];
        list.iter().for_each(|i| counts[kind(i) as usize] += 1);
        let drawn = |wanted: DrawKind| match counts[wanted as usize] {
            0 => Vec::new(),
            all if all == list.len() => list.to_vec(),
            count => {
                let mut own = Vec::with_capacity(count);
                own.extend(list.iter().filter(|i| kind(i) == wanted));
                own
            }
        };
        let [opaque, mask, transmit, blend] =
            [DrawKind::Opaque, DrawKind::Mask, DrawKind::Transmit, DrawKind::Blend].map(drawn);
        Self { opaque, mask, transmit, blend, culled: of.kinds().len() - list.len(), ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat4, DVec3};

    use super::*;
    use crate::bounds::Aabb;
    use crate::camera::Projection;
    use crate::material::{AlphaMode, Material};
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
        let all = DrawLists::of_kinds(&Renderables::new(&scene), &[0, 2, 3, 7]);
        assert_eq!((all.opaque, all.mask, all.culled), (vec![0, 2, 7], vec![3], 6));
    }
}
