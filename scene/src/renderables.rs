//! Per-instance data for drawing a scene repeatedly, in arrays by instance number.

use std::borrow::Cow;

use glam::{DVec3, DVec4};

use super::batch::Groups;
use super::blocks::{numbers_of, runs_of};
use super::bounds::Aabb;
use super::boxes::{BLOCK, BoxArrays};
use super::draw_options::DrawOptions;
use super::instance::Instance;
use super::levels::InstanceLevels;
use super::material::{AlphaMode, Lobe, Lobes};
use super::mesh::Topology;
use super::scene::Scene;

/// Kind of drawing of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawKind {
    /// Opaque.
    Opaque,
    /// Alpha-tested.
    Mask,
    /// Transmissive, not blended.
    Transmit,
    /// Blended.
    Blend,
}

impl DrawKind {
    /// Returns true for kinds that write depth; their triangles are also drawn into shadow maps.
    #[must_use]
    pub const fn leaves_depth(self) -> bool {
        matches!(self, Self::Opaque | Self::Mask)
    }
}

/// Maximum mean surface of blocks for sorting by block, relative to that of the scene. Random order has about one.
const MAX_BLOCK_SURFACE: f64 = 0.25;

/// Instances of a scene in the form used by culling, sorting and drawing; see the [module](self).
///
/// A static scene needs this once. If instances move, [`Renderables::update`] applies the changes; other changes
/// require a new one.
#[derive(Clone, Debug, Default)]
pub struct Renderables {
    bounds: Vec<Aabb>,
    whole: Aabb,
    /// Bounding box of each [`BLOCK`] of instances.
    blocks: Vec<Aabb>,
    /// Bounding box of the casters with thickness in each block.
    solid_blocks: Vec<Aabb>,
    /// True if blocks are much smaller than the scene.
    has_compact_blocks: bool,
    boxes: BoxArrays,
    kinds: Vec<DrawKind>,
    /// Kind of all instances, if they have one in common.
    common_kind: Option<DrawKind>,
    casts: Vec<bool>,
    all_cast: bool,
    layers: Vec<u8>,
    /// Layers and light channels that all instances have in common.
    common_layers: u8,
    common_channels: u8,
    /// Draw order of each instance; empty if all are ordered by distance alone.
    orders: Vec<DrawOrder>,
    mirrored: Vec<bool>,
    flat: Vec<(u32, usize)>,
    solid_casters: Aabb,
    surfaces: Groups,
    depths: Groups,
    has_equal_groups: bool,
    levels: InstanceLevels,
}

/// Draw order of an instance among those of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DrawOrder {
    /// Priority, 0 to 7.
    pub priority: u8,
    /// True for blended instances that are ordered by distance.
    pub by_distance: bool,
    /// Order among blended instances.
    pub blend_order: u16,
}

impl DrawOrder {
    fn of(options: &DrawOptions) -> Self {
        Self {
            priority: options.priority(),
            by_distance: !options.global_blend_order,
            blend_order: options.blend_order,
        }
    }
}

/// State shared by instances of one batch, the most expensive change first: shaders, culling, received light, textures,
/// geometry; last the priority.
type SurfaceKey = (Topology, Lobes, bool, bool, u16, Option<usize>, usize, u8);

impl Renderables {
    /// Collects the data of `scene`.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let instances = &scene.instances;
        let keys: Vec<SurfaceKey> = instances.iter().map(|instance| surface_key(scene, instance)).collect();
        let kinds: Vec<DrawKind> = instances.iter().map(|instance| kind_of(scene, instance)).collect();
        // The depth of opaque surfaces depends on the material only by its stencil state.
        let depth_key = |(key, kind): (&SurfaceKey, &DrawKind)| {
            let (topology, _, double_sided, mirrored, _, material, mesh, priority) = *key;
            let counts = |material: &usize| *kind != DrawKind::Opaque || scene.materials[*material].stencil.is_some();
            (topology, double_sided, mirrored, material.filter(counts), mesh, priority)
        };
        let depth_keys: Vec<_> = keys.iter().zip(&kinds).map(depth_key).collect();
        let bounds: Vec<Aabb> = instances.iter().map(|instance| instance.bounds).collect();
        let mut own = Self {
            boxes: BoxArrays::new(&bounds),
            casts: keys
                .iter()
                .zip(&kinds)
                .zip(instances)
                .map(|((key, kind), instance)| {
                    key.0 == Topology::Triangles && kind.leaves_depth() && instance.draw.casts_shadows
                })
                .collect(),
            layers: instances.iter().map(|instance| instance.draw.layers).collect(),
            common_layers: instances.iter().fold(u8::MAX, |common, instance| common & instance.draw.layers),
            common_channels: instances.iter().fold(u8::MAX, |common, instance| common & instance.draw.light_channels),
            orders: orders(instances),
            mirrored: keys.iter().map(|key| key.3).collect(),
            surfaces: Groups::new(&keys),
            depths: Groups::new(&depth_keys),
            levels: InstanceLevels::new(scene),
            bounds,
            common_kind: kinds.first().copied().filter(|first| kinds.iter().all(|kind| kind == first)),
            kinds,
            ..Self::default()
        };
        own.has_equal_groups = own.surfaces == own.depths;
        own.all_cast = own.casts.iter().all(|casts| *casts);
        own.sum_up();
        own
    }

    /// Updates position and bounds of the instances `moved`. Their number, meshes, materials and draw options must be
    /// unchanged.
    ///
    /// # Panics
    /// If an instance does not exist.
    pub fn update(&mut self, scene: &Scene, moved: &[usize]) {
        if moved.iter().any(|number| scene.instances[*number].is_mirrored() != self.mirrored[*number]) {
            // The batch of the instance changes.
            *self = Self::new(scene);
            return;
        }
        for &number in moved {
            let instance = &scene.instances[number];
            self.bounds[number] = instance.bounds;
            self.levels.update(scene, number);
        }
        self.boxes.replace(moved.iter().map(|number| (*number, &scene.instances[*number].bounds)));
        let mut touched: Vec<usize> = moved.iter().map(|number| number / BLOCK).collect();
        touched.sort_unstable();
        touched.dedup();
        self.flat.retain(|(number, _)| touched.binary_search(&(*number as usize / BLOCK)).is_err());
        touched.into_iter().for_each(|block| self.sum_up_block(block));
        self.flat.sort_unstable();
        self.sum_up_blocks();
    }

    /// Returns the instances as seen by a view with these visible layers: hidden ones have empty bounds and cast no
    /// shadow. Copies the arrays if an instance is hidden.
    #[must_use]
    pub fn shown(&self, visible_layers: u8) -> Cow<'_, Self> {
        let hides = |layers: &u8| layers & visible_layers == 0;
        if self.common_layers & visible_layers != 0 || !self.layers.iter().any(hides) {
            return Cow::Borrowed(self);
        }
        let mut own = self.clone();
        for (number, _) in self.layers.iter().enumerate().filter(|(_, layers)| hides(layers)) {
            (own.bounds[number], own.casts[number]) = (Aabb::EMPTY, false);
        }
        own.all_cast = false;
        own.boxes = BoxArrays::new(&own.bounds);
        own.sum_up();
        Cow::Owned(own)
    }

    /// Computes the properties of all boxes together.
    fn sum_up(&mut self) {
        let count = self.bounds.len().div_ceil(BLOCK);
        (self.blocks, self.solid_blocks) = (vec![Aabb::EMPTY; count], vec![Aabb::EMPTY; count]);
        self.flat.clear();
        (0..count).for_each(|block| self.sum_up_block(block));
        self.sum_up_blocks();
    }

    /// Computes the properties of a block of boxes, and appends its flat casters.
    fn sum_up_block(&mut self, block: usize) {
        let range = block * BLOCK..self.bounds.len().min((block + 1) * BLOCK);
        self.blocks[block] = around(&self.bounds[range.clone()]);
        let mut solid = Aabb::EMPTY;
        for number in range.filter(|number| self.casts[*number]) {
            let half = self.bounds[number].half_extent();
            let largest = half.max_element();
            match (0..3).find(|axis| half[*axis] <= 1e-6 * largest) {
                Some(axis) => self.flat.push((number as u32, axis)),
                None => solid = solid.union(self.bounds[number]),
            }
        }
        self.solid_blocks[block] = solid;
    }

    /// Computes the properties of all blocks together.
    fn sum_up_blocks(&mut self) {
        self.whole = around(&self.blocks);
        self.solid_casters = around(&self.solid_blocks);
        let mean_surface = self.blocks.iter().map(surface).sum::<f64>() / self.blocks.len().max(1) as f64;
        self.has_compact_blocks = mean_surface < MAX_BLOCK_SURFACE * surface(&self.whole);
    }

    /// Returns the bounding box of each instance, in world space.
    #[must_use]
    pub fn bounds(&self) -> &[Aabb] {
        &self.bounds
    }

    /// Returns the bounding boxes as arrays of coordinates.
    #[must_use]
    pub fn boxes(&self) -> &BoxArrays {
        &self.boxes
    }

    /// Returns the bounding box of all instances.
    #[must_use]
    pub fn whole(&self) -> Aabb {
        self.whole
    }

    /// Returns blocks of consecutive instances: the first instance number, the boxes, and their common bounding box.
    pub fn rows(&self) -> impl Iterator<Item = (u32, &[Aabb], &Aabb)> {
        let firsts = (0..).step_by(BLOCK);
        firsts.zip(self.bounds.chunks(BLOCK).zip(&self.blocks)).map(|(first, (row, around))| (first, row, around))
    }

    /// Returns the boxes of the instances that intersect all half spaces ([`BoxArrays::reaching`], with the eye at
    /// zero). More than `max_boxes` are replaced by their common bounding box.
    #[must_use]
    pub fn boxes_reaching(&self, planes: &[DVec4], max_boxes: usize) -> Vec<Aabb> {
        let (mut whole, mut others) = (Vec::new(), Vec::new());
        self.boxes.reaching_blocks(DVec3::ZERO, planes, &mut whole, &mut others);
        let of_others = others.iter().map(|number| self.bounds[*number as usize]);
        if whole.len() * BLOCK + others.len() > max_boxes {
            let of_blocks = whole.iter().map(|block| self.blocks[*block as usize]);
            return vec![of_blocks.chain(of_others).fold(Aabb::EMPTY, Aabb::union)];
        }
        let mut numbers: Vec<u32> = whole.iter().flat_map(|block| numbers_of(*block)).chain(others).collect();
        numbers.sort_unstable();
        numbers.iter().map(|number| self.bounds[*number as usize]).collect()
    }

    /// Returns the bounding box of these instances, whose numbers are ascending.
    ///
    /// # Panics
    /// If an instance does not exist.
    #[must_use]
    pub fn around(&self, numbers: &[u32]) -> Aabb {
        runs_of(numbers).fold(Aabb::EMPTY, |all, run| match run.len() {
            BLOCK => all.union(self.blocks[run[0] as usize / BLOCK]),
            _ => run.iter().fold(all, |all, number| all.union(self.bounds[*number as usize])),
        })
    }

    /// Returns the bounding boxes of blocks if instances may be sorted by block: the blocks are much smaller than the
    /// scene.
    pub(crate) fn compact_blocks(&self) -> Option<&[Aabb]> {
        self.has_compact_blocks.then_some(&self.blocks)
    }

    /// Returns the kind of all instances, if they have one in common.
    pub(crate) fn common_kind(&self) -> Option<DrawKind> {
        self.common_kind
    }

    /// Returns true if all instances are [cast](Self::casts).
    #[must_use]
    pub fn all_cast(&self) -> bool {
        self.all_cast
    }

    /// Returns true if [`surfaces`](Self::surfaces) and [`depths`](Self::depths) are equal.
    #[must_use]
    pub fn has_equal_groups(&self) -> bool {
        self.has_equal_groups
    }

    /// Returns the kind of drawing of each instance.
    #[must_use]
    pub fn kinds(&self) -> &[DrawKind] {
        &self.kinds
    }

    /// Returns, for each instance, true if it is drawn into shadow maps. These are opaque and masked triangles that
    /// [cast shadows](DrawOptions::casts_shadows), but not lines and points.
    #[must_use]
    pub fn casts(&self) -> &[bool] {
        &self.casts
    }

    /// Returns the light channels that all instances have in common.
    #[must_use]
    pub fn common_light_channels(&self) -> u8 {
        self.common_channels
    }

    /// Returns the draw order of each instance; empty if all are ordered by distance alone.
    pub(crate) fn orders(&self) -> &[DrawOrder] {
        &self.orders
    }

    /// Returns the shadow casters without thickness, each with the axis of zero extent.
    #[must_use]
    pub fn flat(&self) -> &[(u32, usize)] {
        &self.flat
    }

    /// Returns the bounding box of all shadow casters with thickness.
    #[must_use]
    pub fn solid_casters(&self) -> Aabb {
        self.solid_casters
    }

    /// Returns the groups of instances with the same shader, culling, material and mesh.
    #[must_use]
    pub fn surfaces(&self) -> &Groups {
        &self.surfaces
    }

    /// Returns the groups for depth-only drawing, where the material of opaque instances does not matter.
    #[must_use]
    pub fn depths(&self) -> &Groups {
        &self.depths
    }

    /// Returns the levels of detail that each instance may use.
    #[must_use]
    pub fn levels(&self) -> &InstanceLevels {
        &self.levels
    }
}

/// Returns a measure of the surface of a box, zero for an empty one.
fn surface(bounds: &Aabb) -> f64 {
    let half = bounds.half_extent();
    half.x * half.y + half.y * half.z + half.z * half.x
}

fn around(boxes: &[Aabb]) -> Aabb {
    boxes.iter().fold(Aabb::EMPTY, |all, own| all.union(*own))
}

fn surface_key(scene: &Scene, instance: &Instance) -> SurfaceKey {
    let material = &scene.materials[instance.material.index()];
    let (mesh, mirrored) = (instance.mesh.index(), instance.is_mirrored());
    let topology = scene.meshes.get(mesh).map_or_else(Topology::default, |mesh| mesh.topology);
    (
        topology,
        material.lobes(),
        material.double_sided,
        mirrored,
        instance.draw.light_bits(),
        Some(instance.material.index()),
        mesh,
        instance.draw.priority(),
    )
}

/// Returns the draw order of instances; empty if all are ordered by distance alone.
fn orders(instances: &[Instance]) -> Vec<DrawOrder> {
    let default = DrawOrder::of(&DrawOptions::default());
    match instances.iter().any(|instance| DrawOrder::of(&instance.draw) != default) {
        true => instances.iter().map(|instance| DrawOrder::of(&instance.draw)).collect(),
        false => Vec::new(),
    }
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

#[cfg(test)]
mod tests;
