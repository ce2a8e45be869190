//! Is there a packing of at most this height? A depth-first search over canonical packings.
//!
//! After Moffitt, "MiniMalloc: A Lightweight Memory Allocator for Hardware-Accelerated Machine Learning" (ASPLOS
//! 2023, doi 10.1145/3623278.3624752), with one idea of our own. A packing is *canonical* when no item can be moved
//! down; every packing can be made canonical without raising its top, so only these are searched. Items are placed
//! from the bottom up, each on the lowest position that what is already placed leaves it (`floor`); the next item is
//! always the one whose position is lowest, so nothing placed later goes under it.
//!
//! - **Section inference.** A section whose lowest open position plus its unplaced bytes passes the capacity cannot
//!   be filled: back up. To see that cheaply each section keeps a *witness*, an unplaced item low enough to show that
//!   the section is still fine; only when the witness is placed or raised are the section's other items looked at.
//! - **Refusals.** When placing item `i` at its floor has failed, what remains to be searched are packings where `i`
//!   is *not* there. A canonical packing leaves `i` up only if another item stands in its way, so its true position
//!   (`bound`) is at least the end of the lowest item that can still do so; if there is none, back up. This replaces
//!   the order constraint, the dominance test and the monotone floor of the paper, and prunes up to 300 times more on
//!   the hard instances, since a refused item soon makes its sections overflow. Items of equal lifetime, size and
//!   alignment are refused together.
//! - **Decomposition.** When no unplaced item crosses a boundary between sections any more, the two sides are solved
//!   one after the other; if one has no solution the item that separated them moves on at once.
//! - **Shortfall.** The least number of bytes by which a capacity test failed is kept: a search that ends without a
//!   packing also refutes every capacity that is less than that much larger.

mod component;
mod inference;

use super::meter::Meter;
use super::order::{Key, Order};
use super::problem::Problem;

const NONE: u32 = u32::MAX;

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// `Canonical::offsets` holds a packing.
    Found,
    /// There is none, nor is there for any capacity below this one.
    Refuted(u64),
    /// The limit was reached first.
    Undecided,
}

/// A set of items that no unplaced item connects with the rest, in the order they are tried.
#[derive(Clone, Copy, Debug)]
struct Component {
    first: u32,
    end: u32,
    /// The component to solve when this one is done.
    next: u32,
    /// The frame whose item split this component off: where to back up to when it has no solution.
    parent: u32,
}

/// An item placed, and how much of each trail belongs to what was before.
#[derive(Clone, Copy, Debug)]
struct Frame {
    component: u32,
    item: u32,
    raised: u32,
    witnessed: u32,
    components: u32,
    arena: u32,
}

/// The search and its reusable memory.
#[derive(Debug, Default)]
pub(super) struct Canonical {
    /// Where each item is.
    pub offsets: Vec<u64>,
    /// Placements tried in the last run.
    pub nodes: u64,
    /// How often each section was found overfull; the caller resets it.
    pub failures: Vec<u32>,
    /// What weighted orders multiply each section with; the caller sets it.
    pub weights: Vec<u32>,
    capacity: u64,
    shortfall: u64,
    looks: u64,
    placed: Vec<bool>,
    /// The lowest position on top of what is placed.
    floor: Vec<u64>,
    /// A lower bound on the final position; above `floor` for refused items.
    bound: Vec<u64>,
    total: Vec<u64>,
    witness: Vec<u32>,
    /// Unplaced items that are alive both in a section and the next.
    crossing: Vec<u32>,
    components: Vec<Component>,
    arena: Vec<u32>,
    frames: Vec<Frame>,
    raised: Vec<(u32, u64, u64)>,
    witnessed: Vec<(u32, u32)>,
    keys: Vec<Key>,
    cuts: Vec<u32>,
    pieces: Vec<u64>,
}

enum Choice {
    Done,
    Place(usize),
    Stuck,
}

impl Canonical {
    /// Looks for a packing with a top of at most `capacity`, trying at most `limit` placements.
    ///
    /// `equal` gives equal items equal numbers. Each component is sorted anew by what is then unplaced.
    pub fn run(
        &mut self,
        problem: &Problem,
        equal: &[u32],
        capacity: u64,
        order: Order,
        limit: u64,
        meter: &mut Meter<'_>,
    ) -> Outcome {
        self.start(problem, capacity);
        if let Some(&most) = self.total.iter().max()
            && most > capacity
        {
            return Outcome::Refuted(most);
        }
        self.arena.extend(0..problem.len() as u32);
        self.sort(problem, order, 0);
        self.components.push(Component { first: 0, end: self.arena.len() as u32, next: NONE, parent: NONE });
        let mut current = self.split(problem, 0, 0..problem.sections(), order);
        let mut alive = true;
        while current != NONE {
            let component = self.components[current as usize];
            let choice = if alive { self.lowest(component) } else { Choice::Stuck };
            match choice {
                Choice::Done => current = component.next,
                Choice::Place(i) => {
                    if self.nodes >= limit || meter.is_empty() {
                        return Outcome::Undecided;
                    }
                    self.nodes += 1;
                    let frame = self.frame(current, i as u32);
                    if self.place(problem, i) && self.reconsider(problem, component, self.offsets[i], equal) {
                        self.frames.push(frame);
                        current = self.split(problem, current, problem.span(i), order);
                    } else {
                        self.undo(problem, frame);
                        alive = self.refuse(problem, i, self.floor[i], equal);
                    }
                    meter.spend(core::mem::take(&mut self.looks));
                }
                Choice::Stuck => {
                    let last = self.frames.len() as u32;
                    let own = self.frames.last().is_some_and(|frame| frame.component == current);
                    let target = if own { last - 1 } else { component.parent };
                    if target == NONE {
                        let step = if self.shortfall == u64::MAX { 1 } else { self.shortfall };
                        return Outcome::Refuted(capacity + step);
                    }
                    while self.frames.len() as u32 > target {
                        let frame = self.frames.pop().expect("target is a frame below the top");
                        self.undo(problem, frame);
                        (current, alive) = (frame.component, true);
                        if self.frames.len() as u32 == target {
                            let i = frame.item as usize;
                            alive = self.refuse(problem, i, self.floor[i], equal);
                        }
                    }
                }
            }
        }
        Outcome::Found
    }

    fn start(&mut self, problem: &Problem, capacity: u64) {
        let (n, sections) = (problem.len(), problem.sections());
        (self.capacity, self.shortfall, self.nodes, self.looks) = (capacity, u64::MAX, 0, n as u64);
        reset(&mut self.offsets, n, 0);
        reset(&mut self.placed, n, false);
        reset(&mut self.floor, n, 0);
        reset(&mut self.bound, n, 0);
        self.total.clone_from(&problem.total);
        reset(&mut self.crossing, sections, 0);
        reset(&mut self.witness, sections, 0);
        self.components.clear();
        self.arena.clear();
        self.frames.clear();
        self.raised.clear();
        self.witnessed.clear();
        for i in 0..n {
            let span = problem.span(i);
            self.looks += span.len() as u64;
            self.witness[span.clone()].fill(i as u32);
            self.crossing[span.start..span.end - 1].iter_mut().for_each(|count| *count += 1);
        }
    }

    fn frame(&self, component: u32, item: u32) -> Frame {
        Frame {
            component,
            item,
            raised: self.raised.len() as u32,
            witnessed: self.witnessed.len() as u32,
            components: self.components.len() as u32,
            arena: self.arena.len() as u32,
        }
    }
}

fn reset<T: Clone>(vec: &mut Vec<T>, len: usize, value: T) {
    vec.clear();
    vec.resize(len, value);
}
