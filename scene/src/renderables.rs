//! Per-instance data for drawing a scene repeatedly, in arrays by instance number.

use std::borrow::Cow;

use glam::{DMat4, DVec3};

use super::batch::Groups;
use super::bounds::Aabb;
use super::boxes::BoxArrays;
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

/// Number of consecutive instances per bounding box.
const BLOCK: usize = 64;

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
    boxes: BoxArrays,
    origins: Vec<DVec3>,
    stamps: Vec<u64>,
    kinds: Vec<DrawKind>,
    casts: Vec<bool>,
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
            origins: instances.iter().map(|instance| instance.world_from_model.w_axis.truncate()).collect(),
            stamps: instances.iter().map(|instance| stamp(&instance.world_from_model)).collect(),
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
            kinds,
            ..Self::default()
        };
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
            self.origins[number] = instance.world_from_model.w_axis.truncate();
            self.stamps[number] = stamp(&instance.world_from_model);
            self.levels.update(scene, number);
        }
        self.boxes.replace(moved.iter().map(|number| (*number, &scene.instances[*number].bounds)));
        self.sum_up();
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
        own.boxes = BoxArrays::new(&own.bounds);
        own.sum_up();
        Cow::Owned(own)
    }

    /// Computes the properties of all boxes together.
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

    /// Returns the bounding box of these instances, whose numbers are ascending.
    ///
    /// # Panics
    /// If an instance does not exist.
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

    /// Returns the origin of each instance's mesh in meters, in world space.
    #[must_use]
    pub fn origins(&self) -> &[DVec3] {
        &self.origins
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

    /// Returns a hash of each instance's transform: equal transforms have equal hashes, and different ones collide with
    /// probability 2⁻⁶⁴.
    #[must_use]
    pub fn stamps(&self) -> &[u64] {
        &self.stamps
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

/// Returns a 64-bit hash of a matrix: numbers are multiplied and rotated, as in Fx and wyhash.
fn stamp(matrix: &DMat4) -> u64 {
    let mix = |state: u64, value: f64| {
        let product = u128::from(state ^ value.to_bits()) * 0x9e37_79b9_7f4a_7c15;
        (product >> 64) as u64 ^ product as u64
    };
    matrix.to_cols_array().into_iter().fold(0x2545_f491_4f6c_dd1d, mix)
}

#[cfg(test)]
mod tests;
