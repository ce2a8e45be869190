//! The instanced draws of a view.

use crate::gpu_scene::indirect::{Arguments, DrawList};
use crate::gpu_scene::shadow_views::ViewShadows;
use crate::gpu_scene::upload::MeshRange;
use framegraph_scene::levels::level_of;
use framegraph_scene::{Batch, BatchOrder, DrawLists, Renderables};

/// What is drawn of a view, each list as the draws that make it up: all instances of one mesh and material are one draw where
/// order does not show. One array holds the numbers of all lists, so that they are uploaded at once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ViewDraws {
    /// Numbers of instances; a draw takes a range of them.
    pub numbers: Vec<u32>,
    /// Depth of opaque surfaces and of masked ones: what has the nearest instance first.
    pub depth: [DrawList; 2],
    /// Opaque surfaces and masked ones over that depth, in the same order: of surfaces that lie in one another the last is seen, so
    /// order shows.
    pub surfaces: [DrawList; 2],
    /// What transmits, a draw each, nearest first.
    pub transmit: Vec<Batch>,
    /// What blends, farthest first; only neighbors in that order are one draw.
    pub blend: DrawList,
    /// Opaque and masked casters of each shadow map.
    pub casters: Vec<[DrawList; 2]>,
    /// Arguments of the batches of long lists, for draws that take them from a buffer.
    pub arguments: Vec<Arguments>,
}

impl ViewDraws {
    /// Those of what is visible and of what casts, in these levels of detail by the numbers of instances.
    pub(crate) fn new(of: &Renderables, visible: &DrawLists, levels: &[u8], shadows: Option<&ViewShadows>) -> Self {
        let DrawLists { opaque, mask, transmit, blend, .. } = visible;
        let mut numbers = Vec::with_capacity(2 * (opaque.len() + mask.len()) + transmit.len() + blend.len());
        let mut batches = |groups: &framegraph_scene::Groups, order, list: &[u32]| {
            DrawList::from(groups.batches(list, levels, order, &mut numbers))
        };
        let (surfaces, depths) = (of.surfaces(), of.depths());
        let depth = [opaque, mask].map(|list| batches(depths, BatchOrder::FirstFirst, list));
        let shaded = [opaque, mask].map(|list| batches(surfaces, BatchOrder::FirstFirst, list));
        let blended = batches(surfaces, BatchOrder::Kept, blend);
        let maps = shadows.iter().flat_map(|shadows| &shadows.maps);
        let of_map =
            |lists: &DrawLists| [&lists.opaque, &lists.mask].map(|list| batches(depths, BatchOrder::ByGroup, list));
        let casters = maps.map(|map| &map.casters).map(of_map).collect();
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

    /// The same with arguments for long lists. `mesh` is that of an instance in a level.
    pub(crate) fn indirect(mut self, mesh: impl Fn(u32, u8) -> MeshRange) -> Self {
        let Self { depth, surfaces, blend, casters, arguments, .. } = &mut self;
        for list in depth.iter_mut().chain(surfaces).chain([blend]).chain(casters.iter_mut().flatten()) {
            list.argue(&mesh, arguments);
        }
        self
    }

    /// The same with a call for each instance: the picture that instanced and indirect draws are compared with.
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

    /// Of some of these draws those parts whose instances are wanted.
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

    /// How many draws these are.
    #[must_use]
    pub fn count(&self) -> usize {
        let lists = self.depth.iter().chain(&self.surfaces).chain(self.casters.iter().flatten());
        lists.chain([&self.blend]).map(|list| list.len()).sum::<usize>() + self.transmit.len()
    }
}
