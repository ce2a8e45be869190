//! The instanced draws of a view.

use crate::gpu_scene::indirect::{Arguments, DrawList};
use crate::gpu_scene::shadow_views::ViewShadows;
use crate::gpu_scene::upload::MeshRange;
use framegraph_scene::levels::level_of;
use framegraph_scene::{Batch, BatchOrder, DrawLists, Renderables};

/// Draws of a view, as lists of batches. Instances of one mesh and material are one batch if their order has no
/// effect. A single array holds the instance numbers of all lists, so that one upload suffices.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ViewDraws {
    /// Instance numbers; each batch uses a range of them.
    pub numbers: Vec<u32>,
    /// Depth of opaque and masked surfaces. The batch with the nearest instance comes first.
    pub depth: [DrawList; 2],
    /// Opaque and masked surfaces to shade, in the order of [`depth`](Self::depth). Coplanar surfaces depend on this
    /// order, since the last one is visible.
    pub surfaces: [DrawList; 2],
    /// Refractive surfaces, one batch each, nearest first.
    pub transmit: Vec<Batch>,
    /// Blended surfaces, farthest first. Only neighbors in this order share a batch.
    pub blend: DrawList,
    /// Opaque and masked casters of each shadow map.
    pub casters: Vec<[DrawList; 2]>,
    /// Arguments of indirect draws, for long lists.
    pub arguments: Vec<Arguments>,
}

impl ViewDraws {
    /// Returns the draws of visible instances and casters, with a level of detail for each instance.
    pub(crate) fn new(of: &Renderables, visible: &DrawLists, levels: &[u8], shadows: Option<&ViewShadows>) -> Self {
        let DrawLists { opaque, mask, transmit, blend, .. } = visible;
        let maps = || shadows.iter().flat_map(|shadows| &shadows.maps).map(|map| &map.casters);
        let drawn = if of.has_equal_groups() { 1 } else { 2 } * (opaque.len() + mask.len());
        let cast = maps().map(|lists| lists.opaque.len() + lists.mask.len()).sum::<usize>();
        let mut numbers = Vec::with_capacity(drawn + cast + transmit.len() + blend.len());
        let mut batches = |groups: &framegraph_scene::Groups, order, list: &[u32]| {
            DrawList::from(groups.batches(list, levels, order, &mut numbers))
        };
        let (surfaces, depths) = (of.surfaces(), of.depths());
        let depth = [opaque, mask].map(|list| batches(depths, BatchOrder::FirstFirst, list));
        let shaded = match of.has_equal_groups() {
            true => depth.clone(),
            false => [opaque, mask].map(|list| batches(surfaces, BatchOrder::FirstFirst, list)),
        };
        let blended = batches(surfaces, BatchOrder::Kept, blend);
        let of_map =
            |lists: &DrawLists| [&lists.opaque, &lists.mask].map(|list| batches(depths, BatchOrder::ByGroup, list));
        let casters = maps().map(of_map).collect();
        let first = numbers.len() as u32;
        numbers.extend_from_slice(transmit);
        let alone = |(first, instance): (u32, &u32)| Batch {
            instance: *instance,
            first,
            count: 1,
            level: level_of(levels, *instance),
        };
        let transmit = (first..).zip(transmit).map(alone).collect();
        Self { depth, surfaces: shaded, transmit, blend: blended, casters, numbers, arguments: Vec::new() }
    }

    /// Adds arguments for long lists. `mesh` returns the range of an instance in a level.
    pub(crate) fn indirect(mut self, mesh: impl Fn(u32, u8) -> MeshRange) -> Self {
        let Self { depth, surfaces, blend, casters, arguments, .. } = &mut self;
        for list in depth.iter_mut().chain(surfaces).chain([blend]).chain(casters.iter_mut().flatten()) {
            list.argue(&mesh, arguments);
        }
        self
    }

    /// Returns draws with one call per instance, as a reference for instanced and indirect draws.
    #[must_use]
    pub fn one_by_one(self) -> Self {
        let Self { numbers, depth, surfaces, transmit, blend, casters, .. } = self;
        let each = |batches: DrawList| {
            let alone = |batch: &Batch| {
                let own = *batch;
                let numbers = &numbers;
                batch.range().map(move |first| Batch { instance: numbers[first as usize], first, count: 1, ..own })
            };
            DrawList::from(batches.iter().flat_map(alone).collect::<Vec<_>>())
        };
        Self {
            depth: depth.map(each),
            surfaces: surfaces.map(each),
            transmit,
            blend: each(blend),
            casters: casters.into_iter().map(|lists| lists.map(each)).collect(),
            numbers,
            arguments: Vec::new(),
        }
    }

    /// Returns the parts of `batches` whose instances are `wanted`.
    pub(crate) fn only(&self, batches: &[Batch], wanted: impl Fn(u32) -> bool) -> DrawList {
        let mut parts: Vec<Batch> = Vec::new();
        for batch in batches {
            let start = parts.len();
            for first in batch.range().filter(|at| wanted(self.numbers[*at as usize])) {
                match parts[start..].last_mut() {
                    Some(part) if part.range().end == first => part.count += 1,
                    _ => parts.push(Batch { instance: self.numbers[first as usize], first, count: 1, ..*batch }),
                }
            }
        }
        parts.into()
    }

    /// Returns the number of draws.
    #[must_use]
    pub fn count(&self) -> usize {
        let lists = self.depth.iter().chain(&self.surfaces).chain(self.casters.iter().flatten());
        lists.chain([&self.blend]).map(|list| list.len()).sum::<usize>() + self.transmit.len()
    }
}
