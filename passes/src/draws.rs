//! The instanced draws of a view.

use crate::shadow::ViewShadows;
use framegraph_scene::{Batch, BatchOrder, DrawLists, Renderables};

/// What is drawn of a view, each list as the draws that make it up: all instances of one mesh and material are one draw where
/// order does not show. One array holds the numbers of all lists, so that they are uploaded at once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ViewDraws {
    /// Numbers of instances; a draw takes a range of them.
    pub numbers: Vec<u32>,
    /// Depth of opaque surfaces and of masked ones: what has the nearest instance first.
    pub depth: [Vec<Batch>; 2],
    /// Opaque surfaces and masked ones over that depth, in the same order: of surfaces that lie in one another the last is seen, so
    /// order shows.
    pub surfaces: [Vec<Batch>; 2],
    /// What transmits, a draw each, nearest first.
    pub transmit: Vec<Batch>,
    /// What blends, farthest first; only neighbors in that order are one draw.
    pub blend: Vec<Batch>,
    /// Opaque and masked casters of each shadow map.
    pub casters: Vec<[Vec<Batch>; 2]>,
}

impl ViewDraws {
    /// Those of what is visible and what casts.
    pub(crate) fn new(of: &Renderables, visible: &DrawLists, shadows: Option<&ViewShadows>) -> Self {
        let DrawLists { opaque, mask, transmit, blend, .. } = visible;
        let mut numbers = Vec::with_capacity(2 * (opaque.len() + mask.len()) + transmit.len() + blend.len());
        let mut batches =
            |groups: &framegraph_scene::Groups, order, list: &[u32]| groups.batches(list, order, &mut numbers);
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
        let transmit = (first..).zip(transmit).map(|(first, instance)| Batch { instance: *instance, first, count: 1 });
        Self { depth, surfaces: shaded, transmit: transmit.collect(), blend: blended, casters, numbers }
    }

    /// The same with a draw for each instance: the picture that instanced draws are compared with.
    #[must_use]
    pub fn one_by_one(self) -> Self {
        let Self { numbers, depth, surfaces, transmit, blend, casters } = self;
        let each = |batches: Vec<Batch>| -> Vec<Batch> {
            let alone = |first: u32| Batch { instance: numbers[first as usize], first, count: 1 };
            batches.iter().flat_map(Batch::range).map(alone).collect()
        };
        Self {
            depth: depth.map(each),
            surfaces: surfaces.map(each),
            transmit: each(transmit),
            blend: each(blend),
            casters: casters.into_iter().map(|lists| lists.map(each)).collect(),
            numbers,
        }
    }

    /// Of some of these draws those parts whose instances are wanted.
    pub(crate) fn only(&self, batches: &[Batch], wanted: impl Fn(u32) -> bool) -> Vec<Batch> {
        let mut parts: Vec<Batch> = Vec::new();
        for batch in batches {
            let start = parts.len();
            for first in batch.range().filter(|at| wanted(self.numbers[*at as usize])) {
                match parts[start..].last_mut() {
                    Some(part) if part.range().end == first => part.count += 1,
                    _ => parts.push(Batch { instance: self.numbers[first as usize], first, count: 1 }),
                }
            }
        }
        parts
    }

    /// How many draws these are.
    #[must_use]
    pub fn count(&self) -> usize {
        let lists = self.depth.iter().chain(&self.surfaces).chain(self.casters.iter().flatten());
        lists.chain([&self.transmit, &self.blend]).map(Vec::len).sum()
    }
}
