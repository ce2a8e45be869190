//! Draw lists: visible instances in drawing order.

use super::blocks::{numbers_of, runs_of};
use super::bounds::Aabb;
use super::boxes::BLOCK;
use super::camera::Camera;
use super::frustum::Frustum;
use super::overlap::layers_from_front;
use super::radix::{sort_key, sort_upper_halves};
use super::renderables::{DrawKind, DrawOrder, Renderables};
use super::scene::Scene;

/// Minimum number of instances for sorting by block.
const MIN_SORTED_BY_BLOCK: usize = 4096;

/// Visible instance numbers by kind of drawing. The order depends on scene and camera alone; ties keep the scene's
/// order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawLists {
    /// Opaque instances, by priority, then front to back for early depth rejection.
    pub opaque: Vec<u32>,
    /// Alpha-tested instances, by priority, then front to back.
    pub mask: Vec<u32>,
    /// Transmissive instances that are not blended, front to back. They are drawn after all opaque ones and cast no
    /// shadow.
    pub transmit: Vec<u32>,
    /// Layer of each instance in `transmit`. Instances of layer 0 have no other transmissive instance in front.
    /// Surfaces of one layer are not visible through each other.
    pub transmit_layers: Vec<u8>,
    /// Blended instances, by priority, then back to front. Instances with
    /// [`global_blend_order`](crate::DrawOptions::global_blend_order) precede others of their priority.
    pub blend: Vec<u32>,
    /// Number of instances outside of the view frustum.
    pub culled: usize,
}

impl DrawLists {
    /// Returns the sorted instances that `camera` may see in an image of aspect ratio `width_over_height`. For a scene
    /// that is drawn repeatedly, use [`DrawLists::seen`].
    #[must_use]
    pub fn for_camera(scene: &Scene, camera: &Camera, width_over_height: f64) -> Self {
        Self::seen(&Renderables::new(scene), camera, width_over_height, None)
    }

    /// Returns the visible instances from precomputed [`Renderables`]. Many instances are culled on the threads of
    /// `pool` too, unless all are sorted in blocks.
    ///
    /// Instances are sorted by the distance of their bounds' center along the view direction. Many opaque instances are
    /// sorted in blocks of 64 consecutive ones, if these are close to each other. Intersecting blended surfaces have no
    /// correct order, the usual limit of sorted blending.
    #[must_use]
    pub fn seen(of: &Renderables, camera: &Camera, width_over_height: f64, pool: Option<&rayon::ThreadPool>) -> Self {
        let frustum = Frustum::of_camera(camera, width_over_height);
        let blocks = of.compact_blocks();
        let kind = of.common_kind().filter(|kind| kind.leaves_depth() && of.orders().is_empty());
        let mut seen = Vec::new();
        if let (Some(blocks), Some(kind), MIN_SORTED_BY_BLOCK..) = (blocks, kind, of.kinds().len()) {
            let (mut whole, mut others) = (Vec::new(), Vec::new());
            of.boxes().reaching_blocks(camera.eye, frustum.planes(), &mut whole, &mut others);
            if whole.len() * BLOCK + others.len() >= MIN_SORTED_BY_BLOCK {
                let list = by_block(&whole, &others, blocks, camera);
                return Self::of_kind(kind, list, of);
            }
            seen.extend(whole.iter().flat_map(|block| numbers_of(*block)).chain(others));
            seen.sort_unstable();
        } else {
            of.boxes().reaching(camera.eye, frustum.planes(), pool, &mut seen);
        }
        let mut lists = Self::of_kinds(of, seen);
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
        for nearest_first in [&mut lists.opaque, &mut lists.mask] {
            match blocks.filter(|_| nearest_first.len() >= MIN_SORTED_BY_BLOCK) {
                Some(blocks) => *nearest_first = by_block(&[], nearest_first, blocks, camera),
                None => sort(nearest_first, 1.0),
            }
        }
        sort(&mut lists.transmit, 1.0);
        sort(&mut lists.blend, -1.0);
        lists.by_priority(of, distance);
        let bounds: Vec<_> = lists.transmit.iter().map(|i| of.bounds()[*i as usize]).collect();
        lists.transmit_layers = layers_from_front(&bounds, camera, width_over_height);
        lists
    }

    /// Returns instances of one kind.
    fn of_kind(kind: DrawKind, list: Vec<u32>, of: &Renderables) -> Self {
        let mut own = Self { culled: of.kinds().len() - list.len(), ..Self::default() };
        match kind {
            DrawKind::Opaque => own.opaque = list,
            DrawKind::Mask => own.mask = list,
            DrawKind::Transmit => own.transmit = list,
            DrawKind::Blend => own.blend = list,
        }
        own
    }

    /// Sorts distance-sorted instances by priority and blend order, where instances set them.
    fn by_priority(&mut self, of: &Renderables, distance: impl Fn(u32) -> f32) {
        let orders = of.orders();
        if orders.is_empty() {
            return;
        }
        let order = |i: u32| orders[i as usize];
        for list in [&mut self.opaque, &mut self.mask] {
            list.sort_by_key(|i| order(*i).priority);
        }
        self.blend.sort_by_cached_key(|i| {
            let DrawOrder { priority, by_distance, blend_order } = order(*i);
            let nearness = if by_distance { sort_key(-distance(*i), 0) } else { 0 };
            (priority, by_distance, nearness, blend_order, *i)
        });
    }

    /// Splits `list` by kind of drawing and keeps its order; instances outside of the list count as culled.
    #[must_use]
    pub fn of_kinds(of: &Renderables, list: Vec<u32>) -> Self {
        if let Some(kind) = of.common_kind() {
            return Self::of_kind(kind, list, of);
        }
        let culled = of.kinds().len() - list.len();
        let kind = |i: &u32| of.kinds()[*i as usize];
        let mut counts = [0; 4];
        list.iter().for_each(|i| counts[kind(i) as usize] += 1);
        if let Some(first) = list.first().map(kind).filter(|first| counts[*first as usize] == list.len()) {
            return Self::of_kind(first, list, of);
        }
        let drawn = |wanted: DrawKind| match counts[wanted as usize] {
            0 => Vec::new(),
            count => {
                let mut own = Vec::with_capacity(count);
                own.extend(list.iter().filter(|i| kind(i) == wanted));
                own
            }
        };
        let [opaque, mask, transmit, blend] =
            [DrawKind::Opaque, DrawKind::Mask, DrawKind::Transmit, DrawKind::Blend].map(drawn);
        Self { opaque, mask, transmit, blend, culled, ..Self::default() }
    }
}

/// Sorts the instances of whole blocks and of `others` by block, nearest first. Within a block, they are in ascending
/// order. Both lists are ascending.
fn by_block(whole: &[u32], others: &[u32], blocks: &[Aabb], camera: &Camera) -> Vec<u32> {
    let forward = camera.forward();
    let key = |block: u32| sort_key((blocks[block as usize].center() - camera.eye).dot(forward) as f32, block);
    let mut runs = runs_of(others).map(|run| (run[0] / BLOCK as u32, run)).peekable();
    let (mut keys, mut partial) = (Vec::with_capacity(whole.len()), Vec::new());
    let mut all = whole.iter().peekable();
    loop {
        match (all.peek(), runs.peek()) {
            (Some(block), Some((other, _))) if **block < *other => keys.extend(all.next().map(|block| key(*block))),
            (_, Some(_)) => {
                let run = runs.next();
                keys.extend(run.map(|(block, _)| key(block)));
                partial.extend(run);
            }
            (Some(_), None) => keys.extend(all.next().map(|block| key(*block))),
            (None, None) => break,
        }
    }
    sort_upper_halves(&mut keys, &mut Vec::new());
    let mut sorted = Vec::with_capacity(whole.len() * BLOCK + others.len());
    for block in keys.iter().map(|key| *key as u32) {
        match partial.binary_search_by_key(&block, |(block, _)| *block) {
            Ok(at) => sorted.extend_from_slice(partial[at].1),
            Err(_) => sorted.extend(numbers_of(block)),
        }
    }
    sorted
}

#[cfg(test)]
mod tests {
    use glam::{DMat4, DVec3};

    use super::*;
    use crate::bounds::Aabb;
    use crate::camera::Projection;
    use crate::material::{AlphaMode, Material};
    use crate::{DrawOptions, Instance, MaterialId, MeshId};

    /// Matches Filament's `RenderPass::Command` keys: priority, then global blend order, then distance, then blend
    /// order for equal distances.
    #[test]
    fn priorities_and_blend_orders_come_before_distance() {
        let mut scene = Scene::default();
        scene.materials.push(Material::default());
        scene.materials.push(Material { alpha: AlphaMode::Blend, ..Material::default() });
        let cube = Aabb { min: DVec3::splat(-0.1), max: DVec3::splat(0.1) };
        let mut place = |z: f64, material: usize, draw: DrawOptions| {
            let (mesh, material) = (MeshId::new(0), MaterialId::new(material));
            let placed = DMat4::from_translation(DVec3::new(0.0, 0.0, z));
            scene.instances.push(Instance { draw, ..Instance::new("", mesh, material, placed, &cube) });
        };
        let default = DrawOptions::default();
        let of = |priority| DrawOptions { priority, ..default };
        let ordered = |blend_order| DrawOptions { blend_order, ..default };
        let global = |blend_order| DrawOptions { blend_order, global_blend_order: true, ..default };
        // Opaque: 0 to 3. The camera at z = 10 looks along −z.
        [(5.0, of(7)), (0.0, of(0)), (1.0, of(0)), (4.0, default)].into_iter().for_each(|(z, draw)| place(z, 0, draw));
        // Blended: 4 and up.
        place(0.0, 1, default);
        place(1.0, 1, ordered(3));
        place(1.0, 1, ordered(2));
        place(5.0, 1, global(9));
        place(6.0, 1, global(8));
        place(6.0, 1, of(0));
        place(-9.0, 1, DrawOptions { priority: 200, ..default });
        let projection = Projection::perspective(1.0, 0.1);
        let camera = Camera::look_at(DVec3::Z * 10.0, DVec3::ZERO, DVec3::Y, projection).expect("a camera");
        let lists = DrawLists::for_camera(&scene, &camera, 1.0);
        assert_eq!(lists.opaque, [2, 1, 3, 0]);
        assert_eq!(lists.blend, [9, 8, 7, 4, 6, 5, 10]);
        scene.instances.iter_mut().for_each(|instance| instance.draw = default);
        let lists = DrawLists::for_camera(&scene, &camera, 1.0);
        assert_eq!((lists.opaque, lists.blend), (vec![0, 3, 2, 1], vec![10, 4, 5, 6, 7, 8, 9]));
    }

    /// Many instances are sorted by the centers of blocks, then by number. The oracle sorts one by one.
    #[test]
    fn many_instances_are_sorted_by_block() {
        let mut scene = Scene::default();
        scene.materials.push(Material::default());
        scene.materials.push(Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, ..Material::default() });
        let cube = Aabb { min: DVec3::splat(-0.1), max: DVec3::splat(0.1) };
        for (count, materials) in [(12_000_u32, 1), (20_003, 2)] {
            scene.instances.clear();
            for i in 0..count as usize {
                let at = DVec3::new((i % 30) as f64, (i / 30 % 30) as f64, (i / 900) as f64);
                let (mesh, material) = (MeshId::new(0), MaterialId::new(i % 3 % materials));
                scene.instances.push(Instance::new("", mesh, material, DMat4::from_translation(at), &cube));
            }
            let of = Renderables::new(&scene);
            assert!(of.compact_blocks().is_some());
            for turn in 0..5 {
                let eye = DVec3::new(-3.0 + f64::from(turn) * 9.0, 40.0, 13.0);
                let projection = Projection::perspective(0.5 + 0.2 * f64::from(turn), 0.1);
                let camera = Camera::look_at(eye, DVec3::splat(9.0), DVec3::Y, projection).expect("a camera");
                let lists = DrawLists::seen(&of, &camera, 1.5, None);
                let distance = |i: u32| {
                    let block = i as usize / 64 * 64;
                    let boxes = &of.bounds()[block..of.bounds().len().min(block + 64)];
                    let whole = boxes.iter().fold(Aabb::EMPTY, |all, own| all.union(*own));
                    (whole.center() - camera.eye).dot(camera.forward()) as f32
                };
                let mut seen = Vec::new();
                of.boxes().reaching(eye, Frustum::of_camera(&camera, 1.5).planes(), None, &mut seen);
                for (list, kind) in [(&lists.opaque, DrawKind::Opaque), (&lists.mask, DrawKind::Mask)] {
                    let mut expected: Vec<u32> =
                        seen.iter().copied().filter(|i| of.kinds()[*i as usize] == kind).collect();
                    if expected.len() >= MIN_SORTED_BY_BLOCK {
                        expected.sort_by(|a, b| distance(*a).total_cmp(&distance(*b)).then(a.cmp(b)));
                        assert_eq!(*list, expected);
                    }
                    assert_eq!(list.len(), expected.len());
                }
                assert!(lists.opaque.len() > MIN_SORTED_BY_BLOCK, "{}", lists.opaque.len());
            }
        }
        let stride = 7919;
        scene.instances = (0..20_003).map(|i| scene.instances[i * stride % 20_003].clone()).collect();
        assert!(Renderables::new(&scene).compact_blocks().is_none(), "a shuffled scene");
    }

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
        let all = DrawLists::of_kinds(&Renderables::new(&scene), vec![0, 2, 3, 7]);
        assert_eq!((all.opaque, all.mask, all.culled), (vec![0, 2, 7], vec![3], 6));
    }
}
