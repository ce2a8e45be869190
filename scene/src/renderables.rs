//! What drawing a scene asks of its instances, view after view: arrays by instance number, made once.

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
    layers: Vec<u8>,
    /// Layers that all instances are in, and light channels that all have.
    common_layers: u8,
    common_channels: u8,
    /// By instance when it is drawn; empty where all are drawn by distance alone.
    orders: Vec<DrawOrder>,
    mirrored: Vec<bool>,
    flat: Vec<(u32, usize)>,
    solid_casters: Aabb,
    surfaces: Groups,
    depths: Groups,
    levels: InstanceLevels,
}

/// When an instance is drawn among those of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DrawOrder {
    /// The instance's priority, 0 to 7.
    pub priority: u8,
    /// True for blended instances that are drawn by distance.
    pub by_distance: bool,
    /// The instance's order among blended ones.
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

/// What instances that are drawn together share, in the order in which changing it is dear: shaders, culling, what light
/// they receive, textures, geometry; and the priority.
type SurfaceKey = (Topology, Lobes, bool, bool, u16, Option<usize>, usize, u8);

impl Renderables {
    /// Those of `scene`.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let instances = &scene.instances;
        let keys: Vec<SurfaceKey> = instances.iter().map(|instance| surface_key(scene, instance)).collect();
        let kinds: Vec<DrawKind> = instances.iter().map(|instance| kind_of(scene, instance)).collect();
        // Depth of opaque surfaces asks for no material but for its stencil.
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

    /// Takes over where the instances `moved` stand and what surrounds them. Number, meshes, materials and draw
    /// options of instances are what they were.
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

    /// Returns the instances as a view shows them whose visible layers are these: others have no bounds and cast no shadow.
    /// It copies the arrays where an instance is in none of the layers.
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

    /// By instance, true if it is drawn into shadow maps: opaque and masked triangles that
    /// [cast](DrawOptions::casts_shadows) are, lines and points are not.
    #[must_use]
    pub fn casts(&self) -> &[bool] {
        &self.casts
    }

    /// Light channels that all instances have.
    #[must_use]
    pub fn common_light_channels(&self) -> u8 {
        self.common_channels
    }

    /// By instance when it is drawn; empty where all are drawn by distance alone.
    pub(crate) fn orders(&self) -> &[DrawOrder] {
        &self.orders
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

/// When instances are drawn; nothing where all are drawn by distance alone.
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

/// Sixty-four bits of a matrix's: multiplied and turned number by number, as Fx and wyhash do.
fn stamp(matrix: &DMat4) -> u64 {
    let mix = |state: u64, value: f64| {
        let product = u128::from(state ^ value.to_bits()) * 0x9e37_79b9_7f4a_7c15;
        (product >> 64) as u64 ^ product as u64
    };
    matrix.to_cols_array().into_iter().fold(0x2545_f491_4f6c_dd1d, mix)
}

#[cfg(test)]
mod tests;
