//! Joined items: items that fit together exactly are packed as one.
//!
//! Items with equal lifetimes are stacked. Two items with equal sizes can follow each other directly in time. Five
//! items can form a wheel: four around a middle one. Joining never raises the live bytes of a section, so the peak is
//! unchanged and fewer items must be placed. A similar method with waste is described by Buchsbaum, Karloff, Kenyon,
//! Reingold and Thorup 2003, "OPT versus LOAD in dynamic storage allocation".
//!
//! The best packing may not contain the joined items. This is less likely for fits that are improbable by chance. Items
//! are therefore joined in the order of the expected number of partners by chance. The last joins are the first to be
//! [undone](Joined::cut).

use super::problem::{Interval, Problem};
use super::random::Random;

/// Initial limit of the expected number of partners per item by chance; doubled from round to round.
const FIRST_CHANCE: f64 = 0.005;
/// Above this limit, all exact fits are joined.
const LAST_CHANCE: f64 = 4.0;
/// Maximum number of items ending at the same time for the search of wheels, which is cubic in it.
const WHEEL_DEATHS: u32 = 32;

/// An item, or several joined ones.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Lifetime in sections.
    lo: u32,
    hi: u32,
    size: u64,
    align: u64,
    /// End of its parts in `parts`; they begin at the end of those of the previous node.
    parts: u32,
}

/// The joined items and reusable memory.
#[derive(Debug, Default)]
pub(super) struct Joined {
    /// Items to be packed after [`Joined::join`] or [`Joined::cut`]; times are sections.
    pub items: Vec<Interval>,
    /// Offsets of those items.
    pub offsets: Vec<u64>,
    /// The problem's items, then the joined ones in order of creation.
    nodes: Vec<Node>,
    /// Joined nodes, and the offset of each from the lowest.
    parts: Vec<(u32, u64)>,
    /// The nodes that are not part of another, in the order of `items`.
    whole: Vec<u32>,
    taken: Vec<bool>,
    /// Nodes sorted by the properties that partners share.
    keys: Vec<(u32, u64, u32)>,
    deaths_at: Vec<(u32, u32)>,
    sizes: Vec<u64>,
    /// Number of births and deaths in each section, and of items by lifetime.
    births: Vec<u32>,
    deaths: Vec<u32>,
    spans: Vec<u32>,
    node_offsets: Vec<u64>,
    /// Number of fits out of 16 that are skipped in each round, so that the order varies between joins.
    pass_over: u64,
    random: Random,
}

impl Joined {
    /// Resets the random numbers, so that the following joins are reproducible.
    pub fn reset(&mut self) {
        self.random = Random::default();
    }

    /// Joins items of a problem with at most `limit` expected partners by chance. Returns the number of examined
    /// entries.
    pub fn join(&mut self, problem: &Problem, limit: f64) -> u64 {
        self.nodes.clear();
        self.parts.clear();
        let (lo, hi, size, align) = (&problem.lo, &problem.hi, &problem.size, &problem.align);
        let node = |i: usize| Node { lo: lo[i], hi: hi[i], size: size[i], align: align[i], parts: 0 };
        self.nodes.extend((0..problem.len()).map(node));
        self.whole.clear();
        self.whole.extend(0..problem.len() as u32);
        self.pass_over = [0, 1, 2, 4][self.random.below(4) as usize];
        let (mut chance, mut looks) = (FIRST_CHANCE, 0);
        loop {
            let before = self.whole.len();
            looks += 64 * before as u64;
            self.count(problem.sections());
            self.stack(chance);
            self.chain(chance);
            if self.whole.len() == before {
                self.wheel();
            }
            if self.whole.len() == before {
                if chance >= limit {
                    break;
                }
                chance = if chance < LAST_CHANCE { 2.0 * chance } else { limit };
            }
        }
        self.list();
        looks
    }

    /// Number of nodes, including the problem's items.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Undoes the last joins until this number of nodes is left. `offsets` are those of [`Joined::place`].
    pub fn cut(&mut self, nodes: usize) {
        self.taken.clear();
        self.taken.resize(nodes, false);
        let parts = if nodes == 0 { 0 } else { self.nodes[nodes - 1].parts as usize };
        self.parts[..parts].iter().for_each(|&(part, _)| self.taken[part as usize] = true);
        self.whole.clear();
        self.whole.extend((0..nodes as u32).filter(|&k| !self.taken[k as usize]));
        self.list();
        self.offsets.clear();
        self.offsets.extend(self.whole.iter().map(|&k| self.node_offsets[k as usize]));
    }

    /// Stores the offsets of `items`, and so of their parts. The problem's items come first in the result.
    pub fn place(&mut self, offsets: &[u64]) -> &[u64] {
        self.node_offsets.resize(self.nodes.len(), 0);
        for (&node, &offset) in self.whole.iter().zip(offsets) {
            self.node_offsets[node as usize] = offset;
        }
        let end = self.whole.iter().max().map_or(0, |&last| last as usize + 1);
        for node in (1..end).rev() {
            for part in self.nodes[node - 1].parts..self.nodes[node].parts {
                let (part, above) = self.parts[part as usize];
                self.node_offsets[part as usize] = self.node_offsets[node] + above;
            }
        }
        &self.node_offsets
    }

    fn list(&mut self) {
        self.items.clear();
        self.items.extend(self.whole.iter().map(|&node| {
            let Node { lo, hi, size, align, .. } = self.nodes[node as usize];
            Interval { lower: lo, upper: hi, size, align }
        }));
    }

    fn count(&mut self, sections: usize) {
        for list in [&mut self.births, &mut self.deaths, &mut self.spans] {
            list.clear();
            list.resize(sections + 1, 0);
        }
        self.sizes.clear();
        for node in self.whole.iter().map(|&node| &self.nodes[node as usize]) {
            self.births[node.lo as usize] += 1;
            self.deaths[node.hi as usize] += 1;
            self.spans[(node.hi - node.lo) as usize] += 1;
            self.sizes.push(node.size);
        }
        self.sizes.sort_unstable();
        self.taken.clear();
        self.taken.resize(self.nodes.len(), false);
    }

    /// Sorts all whole nodes by birth, then by a second key.
    fn sort(&mut self, second: fn(&Node) -> u64) {
        let nodes = &self.nodes;
        let key = |&k: &u32| (nodes[k as usize].lo, second(&nodes[k as usize]), k);
        self.keys.clear();
        self.keys.extend(self.whole.iter().map(key));
        self.keys.sort_unstable();
    }

    /// Joins items with equal lifetimes.
    fn stack(&mut self, chance: f64) {
        self.sort(|node| u64::from(node.hi));
        let mut at = 1;
        while at < self.keys.len() {
            let ((lo, hi, first), (lo2, hi2, second)) = (self.keys[at - 1], self.keys[at]);
            let [a, b] = [first, second].map(|k| self.nodes[k as usize]);
            let mates = self.births[lo as usize].min(self.deaths[hi as usize]);
            at += 1;
            if (lo, hi) == (lo2, hi2)
                && even(&a, &b)
                && self.unlikely(mates, self.spans[(a.hi - a.lo) as usize], chance)
            {
                self.put(Node { size: a.size + b.size, ..a }, &[(first, 0), (second, a.size)]);
                at += 1;
            }
        }
        self.whole.retain(|&k| !self.taken[k as usize]);
    }

    /// Joins an item with one of equal size whose lifetime starts when its own ends.
    fn chain(&mut self, chance: f64) {
        self.sort(|node| node.size);
        for at in 0..self.keys.len() {
            let first = self.keys[at].2;
            let a = self.nodes[first as usize];
            let mates = self.births[a.hi as usize].min(self.deaths[a.hi as usize]);
            let below = |size: u64| self.sizes.partition_point(|&other| other < size);
            let same = (below(a.size + 1) - below(a.size)) as u32;
            if self.taken[first as usize] || !self.unlikely(mates, same, chance) {
                continue;
            }
            if let Some(second) = self.born(a.hi, a.size, |b| even(&a, b)) {
                let hi = self.nodes[second as usize].hi;
                self.put(Node { hi, ..a }, &[(first, 0), (second, 0)]);
            }
        }
        self.whole.retain(|&k| !self.taken[k as usize]);
    }

    /// Joins five items: `left` lies on `low`. When `left` ends, `middle` and `high` replace it. When `low` and
    /// `middle` end, `right` replaces them, and ends together with `high`.
    fn wheel(&mut self) {
        self.sort(|node| node.size);
        self.deaths_at.clear();
        self.deaths_at.extend(self.whole.iter().map(|&k| (self.nodes[k as usize].hi, k)));
        self.deaths_at.sort_unstable();
        for at in 0..self.deaths_at.len() {
            let (u, middle) = self.deaths_at[at];
            let m = self.nodes[middle as usize];
            if self.deaths[u as usize].max(self.births[m.lo as usize]) > WHEEL_DEATHS {
                continue;
            }
            let from = self.deaths_at.partition_point(|death| death.0 < u);
            let to = from + self.deaths[u as usize] as usize;
            let lows = (from..to.min(self.deaths_at.len())).map(|k| self.deaths_at[k].1);
            let found = lows.filter(|&low| self.nodes[low as usize].lo < m.lo).find_map(|low| {
                let y = self.nodes[low as usize];
                let first = self.keys.partition_point(|key| key.0 < m.lo);
                self.keys[first..].iter().take_while(|key| key.0 == m.lo).find_map(|&(_, size, high)| {
                    let s = self.nodes[high as usize];
                    let fits = s.hi > u && even(&m, &s) && even(&m, &y) && high != middle;
                    let left = fits.then(|| self.born(y.lo, size + m.size, |x| x.hi == m.lo && even(&m, x)))??;
                    let right = self.born(u, y.size + m.size, |r| r.hi == s.hi && even(&m, r))?;
                    Some([low, left, middle, high, right])
                })
            });
            let Some([low, left, middle, high, right]) = found else { continue };
            if [low, left, middle, high, right].iter().any(|&k| self.taken[k as usize]) {
                continue;
            }
            let y = self.nodes[low as usize];
            let [x, s] = [left, high].map(|k| self.nodes[k as usize]);
            let above = y.size + m.size;
            let parts = [(low, 0), (left, y.size), (middle, y.size), (high, above), (right, 0)];
            self.put(Node { hi: s.hi, size: y.size + x.size, ..y }, &parts);
        }
        self.whole.retain(|&k| !self.taken[k as usize]);
    }

    /// Finds a whole node with this birth, size and condition. The keys are sorted by size.
    fn born(&self, lo: u32, size: u64, fits: impl Fn(&Node) -> bool) -> Option<u32> {
        let from = self.keys.partition_point(|key| (key.0, key.1) < (lo, size));
        let same = self.keys[from..].iter().take_while(|key| (key.0, key.1) == (lo, size)).map(|key| key.2);
        same.into_iter().find(|&k| !self.taken[k as usize] && fits(&self.nodes[k as usize]))
    }

    /// Returns `true` if few partners are expected by chance: the fraction of items with a matching time that also
    /// match in size.
    fn unlikely(&mut self, mates: u32, same: u32, chance: f64) -> bool {
        f64::from(mates) * f64::from(same) <= chance * self.sizes.len() as f64
            && self.random.below(16) >= self.pass_over
    }

    /// Marks the parts of a new node as taken and appends the node.
    fn put(&mut self, node: Node, parts: &[(u32, u64)]) {
        self.parts.extend_from_slice(parts);
        parts.iter().for_each(|part| self.taken[part.0 as usize] = true);
        self.whole.push(self.nodes.len() as u32);
        self.nodes.push(Node { parts: self.parts.len() as u32, ..node });
        self.taken.push(false);
    }
}

/// Returns `true` if two nodes can be joined: if the first is aligned, so is the one on top of it.
fn even(a: &Node, b: &Node) -> bool {
    a.align == b.align && a.size & (a.align - 1) == 0
}
