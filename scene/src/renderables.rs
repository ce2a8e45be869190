//! What drawing a scene asks of its instances, view after view: arrays by instance number, made once.

use glam::{DMat4, DVec3};

use super::batch::Groups;
use super::bounds::Aabb;
use super::boxes::BoxArrays;
use super::instance::Instance;
use super::levels::InstanceLevels;
use super::material::{AlphaMode, Lobe, Lobes};
use super::mesh::Topology;
use super::scene::Scene;

/// How a surface is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawKind {
    /// Opaque.
    Opaque,
    /// Alpha-tested.
    Mask,
    /// Transmissive and not blended.
    Transmit,
    /// Blended.
    Blend,
}

impl DrawKind {
    /// True for surfaces that leave depth; triangles do so in shadow maps too.
    #[must_use]
    pub const fn leaves_depth(self) -> bool {
        matches!(self, Self::Opaque | Self::Mask)
    }
}

/// Instances in a row around which there is a box.
const BLOCK: usize = 64;

/// The instances of a scene as culling, sorting and drawing read them; see the [module](self).
///
/// A scene that stays as it is needs this once. Of one that moves, [`Renderables::update`] takes what moved; other changes
/// need it anew.
#[derive(Clone, Debug, Default)]
pub struct Renderables {
    bounds: Vec<Aabb>,
    whole: Aabb,
    /// Around each [`BLOCK`] instances.
    blocks: Vec<Aabb>,
    boxes: BoxArrays,
    origins: Vec<DVec3>,
    stamps: Vec<u64>,
    kinds: Vec<DrawKind>,
    casts: Vec<bool>,
    mirrored: Vec<bool>,
    flat: Vec<(u32, usize)>,
    solid_casters: Aabb,
    surfaces: Groups,
    depths: Groups,
    levels: InstanceLevels,
}

/// What instances that are drawn together share, in the order in which changing it is dear: shaders, culling, textures,
/// geometry.
type SurfaceKey = (Topology, Lobes, bool, bool, Option<usize>, usize);

impl Renderables {
    /// Those of `scene`.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let instances = &scene.instances;
        let keys: Vec<SurfaceKey> = instances.iter().map(|instance| surface_key(scene, instance)).collect();
        let kinds: Vec<DrawKind> = instances.iter().map(|instance| kind_of(scene, instance)).collect();
        // Depth of opaque surfaces asks for no material.
        let depth_key = |((topology, _, double_sided, mirrored, material, mesh), kind): (&SurfaceKey, &DrawKind)| {
            (*topology, *double_sided, *mirrored, material.filter(|_| *kind != DrawKind::Opaque), *mesh)
        };
        let depth_keys: Vec<_> = keys.iter().zip(&kinds).map(depth_key).collect();
        let bounds: Vec<Aabb> = instances.iter().map(|instance| instance.bounds).collect();
        let mut own = Self {
            boxes: BoxArrays::new(&bounds),
            origins: instances.iter().map(|instance| instance.world_from_model.w_axis.truncate()).collect(),
            stamps: instances.iter().map(|instance| stamp(&instance.world_from_model)).collect(),
            casts: keys
                .iter()
                .zip(&kinds)
                .map(|(key, kind)| key.0 == Topology::Triangles && kind.leaves_depth())
                .collect(),
            mirrored: keys.iter().map(|key| key.3).collect(),
            surfaces: Groups::new(&keys),
            depths: Groups::new(&depth_keys),
            levels: InstanceLevels::new(scene),
            bounds,
            kinds,
            ..Self::default()
        };
        own.sum_up();
        own
    }

    /// Takes over where the instances `moved` stand and what surrounds them. Number, meshes and materials of instances are
    /// what they were.
    ///
    /// # Panics
    /// When there is no such instance.
    pub fn update(&mut self, scene: &Scene, moved: &[usize]) {
        if moved.iter().any(|number| scene.instances[*number].is_mirrored() != self.mirrored[*number]) {
            // It is drawn with others than before.
            *self = Self::new(scene);
            return;
        }
        for &number in moved {
            let instance = &scene.instances[number];
            self.bounds[number] = instance.bounds;
            self.origins[number] = instance.world_from_model.w_axis.truncate();
            self.stamps[number] = stamp(&instance.world_from_model);
            self.levels.update(scene, number);
        }
        self.boxes.replace(moved.iter().map(|number| (*number, &scene.instances[*number].bounds)));
        self.sum_up();
    }

    /// What is known of all boxes together.
    fn sum_up(&mut self) {
        self.blocks.clear();
        self.blocks.extend(self.bounds.chunks(BLOCK).map(around));
        self.whole = around(&self.blocks);
        self.flat.clear();
        self.solid_casters = Aabb::EMPTY;
        for (number, bounds) in (0..).zip(&self.bounds).filter(|(number, _)| self.casts[*number as usize]) {
            let half = bounds.half_extent();
            match (0..3).find(|axis| half[*axis] <= 1e-6 * half.max_element()) {
                Some(axis) => self.flat.push((number, axis)),
                None => self.solid_casters = self.solid_casters.union(*bounds),
            }
        }
    }

    /// The box around each instance, world space.
    #[must_use]
    pub fn bounds(&self) -> &[Aabb] {
        &self.bounds
    }

    /// The same as arrays of coordinates.
    #[must_use]
    pub fn boxes(&self) -> &BoxArrays {
        &self.boxes
    }

    /// The box around all.
    #[must_use]
    pub fn whole(&self) -> Aabb {
        self.whole
    }

    /// Instances in a row, by the number of the first and their boxes, and the box around each row.
    pub fn rows(&self) -> impl Iterator<Item = (u32, &[Aabb], &Aabb)> {
        let firsts = (0..).step_by(BLOCK);
        firsts.zip(self.bounds.chunks(BLOCK).zip(&self.blocks)).map(|(first, (row, around))| (first, row, around))
    }

    /// The box around these instances, whose numbers rise.
    ///
    /// # Panics
    /// When there is no such instance.
    #[must_use]
    pub fn around(&self, mut numbers: &[u32]) -> Aabb {
        let mut all = Aabb::EMPTY;
        while let [first, rest @ ..] = numbers {
            let at = *first as usize;
            let whole = at.is_multiple_of(BLOCK) && numbers.get(BLOCK - 1) == Some(&(first + BLOCK as u32 - 1));
            (all, numbers) = match whole {
                true => (all.union(self.blocks[at / BLOCK]), &numbers[BLOCK..]),
                false => (all.union(self.bounds[at]), rest),
            };
        }
        all
    }

    /// Where the zero point of each instance's mesh is, in m, world space.
    #[must_use]
    pub fn origins(&self) -> &[DVec3] {
        &self.origins
    }

    /// How each is drawn.
    #[must_use]
    pub fn kinds(&self) -> &[DrawKind] {
        &self.kinds
    }

    /// By instance, true if it is drawn into shadow maps: opaque and masked triangles are, lines and points are not.
    #[must_use]
    pub fn casts(&self) -> &[bool] {
        &self.casts
    }

    /// A number for the placement of each: equal ones have equal numbers, and of different ones one pair in 2⁶⁴ has.
    #[must_use]
    pub fn stamps(&self) -> &[u64] {
        &self.stamps
    }

    /// Shadow casters without thickness, each with the axis along which it has none.
    #[must_use]
    pub fn flat(&self) -> &[(u32, usize)] {
        &self.flat
    }

    /// The box around all shadow casters that have a thickness.
    #[must_use]
    pub fn solid_casters(&self) -> Aabb {
        self.solid_casters
    }

    /// Which are drawn with the same shader, culling, material and mesh.
    #[must_use]
    pub fn surfaces(&self) -> &Groups {
        &self.surfaces
    }

    /// The same for drawing depth alone, to which the material of opaque ones is nothing.
    #[must_use]
    pub fn depths(&self) -> &Groups {
        &self.depths
    }

    /// Of which level of detail each may be drawn.
    #[must_use]
    pub fn levels(&self) -> &InstanceLevels {
        &self.levels
    }
}

fn around(boxes: &[Aabb]) -> Aabb {
    boxes.iter().fold(Aabb::EMPTY, |all, own| all.union(*own))
}

fn surface_key(scene: &Scene, instance: &Instance) -> SurfaceKey {
    let material = &scene.materials[instance.material.index()];
    let (mesh, mirrored) = (instance.mesh.index(), instance.is_mirrored());
    let topology = scene.meshes.get(mesh).map_or_else(Topology::default, |mesh| mesh.topology);
    (topology, material.lobes(), material.double_sided, mirrored, Some(instance.material.index()), mesh)
}

fn kind_of(scene: &Scene, instance: &Instance) -> DrawKind {
    let material = &scene.materials[instance.material.index()];
    match material.alpha {
        AlphaMode::Blend => DrawKind::Blend,
        _ if material.lobes().contains(Lobe::Transmission) => DrawKind::Transmit,
        AlphaMode::Opaque => DrawKind::Opaque,
        AlphaMode::Mask { .. } => DrawKind::Mask,
    }
}

/// Sixty-four bits of a matrix's: multiplied and turned number by number, as Fx and wyhash do.
fn stamp(matrix: &DMat4) -> u64 {
    let mix = |state: u64, value: f64| {
        let product = u128::from(state ^ value.to_bits()) * 0x9e37_79b9_7f4a_7c15;
        (product >> 64) as u64 ^ product as u64
    };
    matrix.to_cols_array().into_iter().fold(0x2545_f491_4f6c_dd1d, mix)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use crate::{MaterialId, MeshId};

    fn placed(mesh: usize, material: usize, world_from_model: DMat4) -> Instance {
        let cube = Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE };
        Instance::new("", MeshId::new(mesh), MaterialId::new(material), world_from_model, &cube)
    }

    fn scene() -> Scene {
        let mut scene = Scene { materials: vec![Material::default(); 2], ..Scene::default() };
        scene.materials.push(Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, ..Material::default() });
        let at = |x: f64| DMat4::from_translation(DVec3::X * x);
        let mirrored = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let flat = DMat4::from_scale(DVec3::new(5.0, 0.0, 5.0));
        let of = [(0, 0, at(0.0)), (0, 1, at(3.0)), (0, 0, at(6.0)), (1, 0, at(9.0)), (0, 0, mirrored), (0, 2, flat)];
        scene.instances.extend(of.map(|(mesh, material, at)| placed(mesh, material, at)));
        scene
    }

    /// Together is drawn what has mesh, material and side in common; for depth the material of opaque ones does not count.
    #[test]
    fn groups_have_in_common_what_draws_set() {
        let own = Renderables::new(&scene());
        let same = |groups: &Groups, a: usize, b: usize| groups.of[a] == groups.of[b];
        for (a, b, surface, depth) in
            [(0, 2, true, true), (0, 1, false, true), (0, 3, false, false), (0, 4, false, false), (0, 5, false, false)]
        {
            assert_eq!((same(own.surfaces(), a, b), same(own.depths(), a, b)), (surface, depth), "{a} {b}");
        }
        assert_eq!(own.kinds()[4..], [DrawKind::Opaque, DrawKind::Mask]);
        assert_eq!((own.flat(), own.solid_casters().max.x), (&[(5, 1)][..], 10.0));
    }

    /// Lines and points leave depth and cast nothing, and are drawn apart from triangles.
    #[test]
    fn lines_and_points_do_not_cast() {
        let topologies = [Topology::Triangles, Topology::Lines, Topology::Points];
        let mesh = |topology| crate::Mesh { topology, ..crate::Mesh::default() };
        let mut scene = Scene { materials: vec![Material::default()], ..Scene::default() };
        scene.meshes.extend(topologies.map(mesh));
        let at = |mesh: usize| placed(mesh, 0, DMat4::from_translation(DVec3::X * (10.0 * mesh as f64)));
        scene.instances.extend([2, 1, 0].map(at));
        let own = Renderables::new(&scene);
        assert_eq!((own.casts(), own.kinds()), (&[false, false, true][..], &[DrawKind::Opaque; 3][..]));
        assert_eq!((own.solid_casters().max.x, own.whole().max.x), (1.0, 21.0));
        // Groups are in the order of topologies, so that each is drawn in a row.
        assert_eq!((own.surfaces().of.as_slice(), own.depths().of.as_slice()), (&[2, 1, 0][..], &[2, 1, 0][..]));
    }

    /// Whether rows are taken whole, in part or not at all.
    #[test]
    fn the_box_around_some_is_that_of_each() {
        let at = |i: usize| DMat4::from_translation(DVec3::new((i * 37 % 200) as f64, (i * 91 % 300) as f64, i as f64));
        let instances = (0..3 * BLOCK + 7).map(|i| placed(0, 0, at(i))).collect();
        let mut scene = Scene { materials: vec![Material::default()], instances, ..Scene::default() };
        let mut own = Renderables::new(&scene);
        for _ in 0..2 {
            let lists = [0..0, 0..3 * BLOCK + 7, 5..2 * BLOCK, BLOCK..2 * BLOCK, BLOCK + 1..2 * BLOCK];
            let lists = lists.map(|range| range.map(|i| i as u32).collect::<Vec<_>>());
            for list in lists.into_iter().chain([(0..150).filter(|i| i % 3 > 0).collect()]) {
                let each: Vec<Aabb> = list.iter().map(|i| own.bounds()[*i as usize]).collect();
                assert_eq!(own.around(&list), around(&each), "{list:?}");
            }
            assert!(own.rows().all(|(first, row, own)| *own == around(row) && first.is_multiple_of(BLOCK as u32)));
            assert_eq!(own.rows().map(|(_, row, _)| row.len()).collect::<Vec<_>>(), [BLOCK, BLOCK, BLOCK, 7]);
            scene.instances[BLOCK + 9] = placed(0, 0, at(5000));
            own.update(&scene, &[BLOCK + 9]);
        }
    }

    /// What moved is where it would be had all been made anew, and nothing else changes its stamp.
    #[test]
    fn an_update_is_as_making_anew() {
        let mut scene = scene();
        let mut own = Renderables::new(&scene);
        let before = own.clone();
        for to in [DMat4::from_translation(DVec3::Y * 40.0), DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0))] {
            scene.instances[1] = placed(0, 1, to);
            own.update(&scene, &[1]);
            let anew = Renderables::new(&scene);
            assert_eq!((own.bounds(), own.origins(), own.flat()), (anew.bounds(), anew.origins(), anew.flat()));
            assert_eq!((own.stamps(), own.surfaces(), own.depths()), (anew.stamps(), anew.surfaces(), anew.depths()));
            let changed = (0..6).filter(|i| own.stamps()[*i] != before.stamps()[*i]).collect::<Vec<_>>();
            assert_eq!(changed, [1]);
        }
        assert_eq!(own.whole(), scene.bounds());
    }
}
