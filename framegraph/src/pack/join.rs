//! Joined items: two that fit together exactly are packed as one.
//!
//! Items with equal lifetimes are stacked; of items with equal sizes, one may take over from the other where it dies.
//! Neither raises the live bytes of any section, so the peak stays what it was, while each pair takes one item off the
//! problem. (Buchsbaum, Karloff, Kenyon, Reingold and Thorup 2003, "OPT versus LOAD in dynamic storage allocation", box
//! items in this way, with waste.) The best packing may hold a pair apart. That is unlikely where so good a fit is
//! unlikely to come by chance, so pairs are joined in that order: by how many partners chance alone would give an item.

use super::problem::{Interval, Problem};

/// What chance gives at first, in partners an item; doubled until nothing is left to join within the limit.
const FIRST_CHANCE: f64 = 0.005;

/// An item, or two joined.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Lifetime in sections.
    lo: u32,
    hi: u32,
    size: u64,
    align: u64,
    /// The nodes joined, and how far above the first the second lies.
    parts: Option<(u32, u32, u64)>,
}

/// The joined items and reusable memory.
#[derive(Debug, Default)]
pub(super) struct Joined {
    /// What is left to pack; times are sections.
    pub items: Vec<Interval>,
    nodes: Vec<Node>,
    /// The nodes that are no part of another: `items` in the same order.
    whole: Vec<u32>,
    taken: Vec<bool>,
    /// Nodes sorted by what partners have in common.
    keys: Vec<(u32, u64, u32)>,
    sizes: Vec<u64>,
    /// Births and deaths in each section, and how many items live for so many.
    births: Vec<u32>,
    deaths: Vec<u32>,
    spans: Vec<u32>,
    offsets: Vec<u64>,
}

impl Joined {
    /// Joins the items of a problem: pairs of which chance would give an item at most `limit`. Returns the entries looked at.
    pub fn join(&mut self, problem: &Problem, limit: f64) -> u64 {
        let node = |i: usize| Node {
            lo: problem.lo[i],
            hi: problem.hi[i],
            size: problem.size[i],
            align: problem.align[i],
            parts: None,
        };
        self.nodes.clear();
        self.nodes.extend((0..problem.len()).map(node));
        self.whole.clear();
        self.whole.extend(0..problem.len() as u32);
        let (mut chance, mut looks) = (FIRST_CHANCE.min(limit), 0);
        loop {
            let before = self.whole.len();
            self.count(problem.sections());
            self.stack(chance);
            self.chain(chance);
            looks += 64 * before as u64;
            if self.whole.len() == before && chance >= limit {
                break;
            }
            chance = if self.whole.len() < before { chance } else { (2.0 * chance).min(limit) };
        }
        self.items.clear();
        self.items.extend(self.whole.iter().map(|&node| {
            let Node { lo, hi, size, align, .. } = self.nodes[node as usize];
            Interval { lower: lo, upper: hi, size, align }
        }));
        looks
    }

    /// Offsets of the problem's items from those of the joined ones.
    pub fn expand(&mut self, joined: &[u64], offsets: &mut [u64]) {
        self.offsets.clear();
        self.offsets.resize(self.nodes.len(), 0);
        for (&node, &offset) in self.whole.iter().zip(joined) {
            self.offsets[node as usize] = offset;
        }
        for node in (0..self.nodes.len()).rev() {
            if let Some((first, second, above)) = self.nodes[node].parts {
                self.offsets[first as usize] = self.offsets[node];
                self.offsets[second as usize] = self.offsets[node] + above;
            }
        }
        offsets.copy_from_slice(&self.offsets[..offsets.len()]);
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

    /// Joins items with equal lifetimes.
    fn stack(&mut self, chance: f64) {
        self.keys.clear();
        let nodes = &self.nodes;
        self.keys.extend(self.whole.iter().map(|&k| (nodes[k as usize].lo, u64::from(nodes[k as usize].hi), k)));
        self.keys.sort_unstable();
        let mut at = 1;
        while at < self.keys.len() {
            let ((lo, hi, first), (lo2, hi2, second)) = (self.keys[at - 1], self.keys[at]);
            let [a, b] = [first, second].map(|k| self.nodes[k as usize]);
            let mates = self.births[lo as usize].min(self.deaths[hi as usize]);
            at += 1;
            if (lo, hi) == (lo2, hi2) && even(&a, &b) && self.likely(mates, self.spans[(a.hi - a.lo) as usize], chance)
            {
                self.put(Node { size: a.size + b.size, parts: Some((first, second, a.size)), ..a });
                at += 1;
            }
        }
        self.whole.retain(|&k| !self.taken[k as usize]);
    }

    /// Joins an item with one of equal size that is born where it dies.
    fn chain(&mut self, chance: f64) {
        self.keys.clear();
        let nodes = &self.nodes;
        self.keys.extend(self.whole.iter().map(|&k| (nodes[k as usize].lo, nodes[k as usize].size, k)));
        self.keys.sort_unstable();
        for at in 0..self.keys.len() {
            let first = self.keys[at].2;
            let a = self.nodes[first as usize];
            let mates = self.births[a.hi as usize].min(self.deaths[a.hi as usize]);
            let below = |size: u64| self.sizes.partition_point(|&other| other < size);
            let same = (below(a.size + 1) - below(a.size)) as u32;
            if self.taken[first as usize] || !self.likely(mates, same, chance) {
                continue;
            }
            let from = self.keys.partition_point(|key| (key.0, key.1) < (a.hi, a.size));
            let partners = self.keys[from..].iter().take_while(|key| (key.0, key.1) == (a.hi, a.size));
            let free = |k: &u32| !self.taken[*k as usize] && even(&a, &self.nodes[*k as usize]);
            if let Some(second) = partners.map(|key| key.2).find(free) {
                let hi = self.nodes[second as usize].hi;
                self.put(Node { hi, parts: Some((first, second, 0)), ..a });
            }
        }
        self.whole.retain(|&k| !self.taken[k as usize]);
    }

    /// Whether chance gives an item few partners: of its mates in time, the part that has what it needs.
    fn likely(&self, mates: u32, same: u32, chance: f64) -> bool {
        f64::from(mates) * f64::from(same) <= chance * self.sizes.len() as f64
    }

    /// Takes the parts of a new node off the list and appends the node.
    fn put(&mut self, node: Node) {
        for part in node.parts.into_iter().flat_map(|(first, second, _)| [first, second]) {
            self.taken[part as usize] = true;
        }
        self.whole.push(self.nodes.len() as u32);
        self.nodes.push(node);
        self.taken.push(false);
    }
}

/// Whether two nodes may be one: where the first is aligned, so is what lies on it.
fn even(a: &Node, b: &Node) -> bool {
    a.align == b.align && a.size & (a.align - 1) == 0
}
