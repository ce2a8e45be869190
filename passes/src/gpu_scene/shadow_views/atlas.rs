//! Where local maps lie: squares in the layers that they share.
//!
//! A layer is a tree of quarters: a square is the layer itself, a quarter of it, a quarter of that, and so on. Squares are
//! placed from the largest to the smallest, each at the next free place of its size, quarter by quarter, so that nothing is
//! left free between them: as many layers are begun as their areas fill.

/// The smallest map, in texels.
const LEAST_TEXELS: u32 = 64;

/// A square of a layer, in texels from the layer's top left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Which layer.
    pub layer: u16,
    /// Its top left corner.
    pub corner: [u32; 2],
    /// Its side.
    pub texels: u32,
}

impl Place {
    /// All of a layer.
    pub(crate) const fn whole(layer: u16, texels: u32) -> Self {
        Self { layer, corner: [0; 2], texels }
    }

    /// The last level of a layer, of `levels`, whose texels lie in this square or outside of it, and not across its edges.
    pub(crate) fn last_level(&self, levels: u8, layer_texels: u32) -> u8 {
        let last = levels.max(1) - 1;
        let [x, y] = self.corner;
        let aligned = (x | y | self.texels).trailing_zeros();
        if self.texels == layer_texels { last } else { last.min(aligned as u8) }
    }
}

/// How often the side of a layer is halved for a map of this importance, 0…1: once with each halving of that, and as often
/// as leaves the smallest map.
pub(crate) fn halvings(importance: f64, layer_texels: u32) -> u32 {
    let wanted = (-importance.max(1e-6).log2()).floor() as u32;
    wanted.min(most_halvings(layer_texels))
}

/// How often the side of a layer is halved for the smallest map.
pub(crate) const fn most_halvings(layer_texels: u32) -> u32 {
    let smallest = layer_texels / LEAST_TEXELS;
    if smallest == 0 { 0 } else { smallest.ilog2() }
}

/// Squares of a layer's side, halved so many times each, in their order: none is larger than the one before.
pub(crate) fn pack(halvings: &[u32], layer_texels: u32) -> Vec<Place> {
    let deepest = halvings.last().copied().unwrap_or(0);
    // In squares of the smallest size.
    let mut filled = 0_u64;
    let place = |halved: &u32| {
        let at = filled;
        filled += 1 << (2 * (deepest - halved));
        let layer = (at >> (2 * deepest)) as u16;
        // From the whole layer down to the square: which quarter, by two bits.
        let quarter = |step: u32| (at >> (2 * (deepest - step))) as u32 & 3;
        let along = |bit: u32| (1..=*halved).map(|step| (quarter(step) >> bit & 1) * (layer_texels >> step)).sum();
        Place { layer, corner: [along(0), along(1)], texels: layer_texels >> halved }
    };
    halvings.iter().map(place).collect()
}

/// Layers that such squares take.
pub(crate) fn layers(halvings: impl IntoIterator<Item = u32>) -> u64 {
    // In squares of a side halved sixteen times, which is more than there are.
    let filled: u64 = halvings.into_iter().map(|halved| 1 << (2 * (16 - halved.min(16)))).sum();
    filled.div_ceil(1 << 32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In layers of any size, squares lie in their layers, share no texel and take as few layers as their areas allow.
    #[test]
    fn squares_lie_apart_in_the_fewest_layers() {
        let lists: [&[u32]; 6] =
            [&[], &[0], &[0, 0, 1, 1, 2, 3], &[1, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 4], &[4; 64], &[2, 2, 2, 2, 2, 4, 4]];
        for texels in [1024, 1100, 2047, 2048] {
            for list in lists {
                let places = pack(list, texels);
                let inside = |p: &Place| p.corner.iter().all(|c| c + p.texels <= texels);
                assert!(places.iter().all(inside), "{texels} {list:?}: {places:?}");
                for (i, a) in places.iter().enumerate() {
                    for b in &places[..i] {
                        let beside =
                            |k: usize| a.corner[k] + a.texels <= b.corner[k] || b.corner[k] + b.texels <= a.corner[k];
                        assert!(a.layer != b.layer || beside(0) || beside(1), "{texels} {list:?}: {a:?} {b:?}");
                    }
                }
                let area: f64 = list.iter().map(|h| 0.25_f64.powi(*h as i32)).sum();
                let used = places.iter().map(|p| u64::from(p.layer) + 1).max().unwrap_or(0);
                assert_eq!(used, area.ceil() as u64, "{list:?}");
                assert_eq!(used, layers(list.iter().copied()));
            }
        }
    }

    #[test]
    fn importance_halves_the_side_down_to_the_smallest_map() {
        let sides = |texels: u32| [1.0, 0.6, 0.5, 0.2, 1e-9].map(|importance| texels >> halvings(importance, texels));
        assert_eq!(sides(1024), [1024, 1024, 512, 256, 64]);
        assert_eq!(sides(1000), [1000, 1000, 500, 250, 125]);
        assert_eq!(sides(48), [48; 5]);
    }

    /// A level whose texels reach over the edge of a square is not read.
    #[test]
    fn levels_end_where_texels_reach_over_edges() {
        assert_eq!(Place::whole(0, 1000).last_level(5, 1000), 4);
        assert_eq!(Place { corner: [64, 192], ..Place::whole(1, 64) }.last_level(8, 1024), 6);
        assert_eq!(Place { corner: [0, 250], ..Place::whole(0, 250) }.last_level(8, 1000), 1);
    }
}
