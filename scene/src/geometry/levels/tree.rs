//! Tree of triangle boxes for nearest-triangle queries.

use glam::Vec3;

/// Maximum number of triangles in a leaf.
const LEAF: usize = 4;

/// Box around consecutive triangles of [`Tree::order`], and the node at which its second half begins.
struct Node {
    low: Vec3,
    high: Vec3,
    triangles: std::ops::Range<u32>,
    /// Node of the second half; 0 for a leaf.
    second: u32,
}

/// Bounding volume hierarchy; each box is split across its longest side.
pub(super) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Tree {
    /// Builds the tree over triangles with these corners.
    pub fn new(corners: &[[Vec3; 3]]) -> Self {
        let mut own = Self { nodes: Vec::new(), order: (0..corners.len() as u32).collect() };
        let mut order = std::mem::take(&mut own.order);
        if !order.is_empty() {
            own.cut(&mut order, 0, corners);
        }
        own.order = order;
        own
    }

    fn cut(&mut self, order: &mut [u32], first: u32, corners: &[[Vec3; 3]]) {
        let all = order.iter().flat_map(|triangle| corners[*triangle as usize]);
        let (low, high) = all.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let at = self.nodes.len();
        self.nodes.push(Node { low, high, triangles: first..first + order.len() as u32, second: 0 });
        if order.len() <= LEAF {
            return;
        }
        let axis = (high - low).max_position();
        let middle = order.len() / 2;
        let key = |triangle: &u32| corners[*triangle as usize].iter().map(|corner| corner[axis]).sum::<f32>();
        order.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let (left, right) = order.split_at_mut(middle);
        self.cut(left, first, corners);
        self.nodes[at].second = self.nodes.len() as u32;
        self.cut(right, first + middle as u32, corners);
    }

    /// Returns the minimum of `of` over all triangles, where `of` is at least the triangle's distance from `place`.
    /// Exits early: a result up to `limits[0]` or from `limits[1]` is only a bound. `open` is scratch memory.
    pub fn least(
        &self,
        place: Vec3,
        [enough, most]: [f32; 2],
        open: &mut Vec<u32>,
        mut of: impl FnMut(u32, f32) -> f32,
    ) -> f32 {
        let away = |node: &Node| place.distance(place.clamp(node.low, node.high));
        let mut best = most;
        open.clear();
        open.extend((!self.nodes.is_empty()).then_some(0));
        while let Some(at) = open.pop().filter(|_| best > enough) {
            let node = &self.nodes[at as usize];
            if away(node) >= best {
                continue;
            }
            if node.second == 0 {
                let here = &self.order[node.triangles.start as usize..node.triangles.end as usize];
                best = here.iter().fold(best, |best, triangle| best.min(of(*triangle, best)));
                continue;
            }
            let halves = [at + 1, node.second];
            let [first, second] = halves.map(|half| away(&self.nodes[half as usize]));
            // Visits the nearer half first.
            open.extend(if first < second { [halves[1], halves[0]] } else { halves });
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with a linear search.
    #[test]
    fn the_least_is_found() {
        let number = |i: u32| ((i.wrapping_mul(2_654_435_761) >> 8) % 1000) as f32 / 1000.0;
        let corner = |i: u32| Vec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
        let corners: Vec<[Vec3; 3]> =
            (0..200).map(|i| [corner(i), corner(i) + 0.05 * corner(7 * i), corner(i)]).collect();
        let tree = Tree::new(&corners);
        let far = |triangle: u32, place: Vec3| corners[triangle as usize][0].distance(place);
        let mut open = Vec::new();
        for place in (300..340).map(corner) {
            let mut asked = 0;
            let found = tree.least(place, [0.0, f32::INFINITY], &mut open, |triangle, _| {
                asked += 1;
                far(triangle, place)
            });
            let expected = (0..200).map(|triangle| far(triangle, place)).fold(f32::INFINITY, f32::min);
            assert_eq!(found, expected);
            assert!(asked < 150, "{asked} of 200");
            let mut within = |limits| tree.least(place, limits, &mut open, |triangle, _| far(triangle, place));
            assert_eq!(within([0.0, 0.5 * expected]), 0.5 * expected);
            let enough = within([1.5 * expected, 9.0]);
            assert!(enough >= expected && enough <= 1.5 * expected, "{enough} for {expected}");
        }
        assert_eq!(Tree::new(&[]).least(Vec3::ZERO, [0.0, 7.0], &mut open, |_, _| 0.0), 7.0);
    }
}
