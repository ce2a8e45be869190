//! Finds the semaphores that are not implied by others.

use crate::layout::{QueueId, QueueLayout};

/// A dependency between queues: step `before` waits until step `after` has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    pub after: u32,
    pub before: u32,
}

/// Returns the waits between queues that others do not imply, in the order of the waiting steps.
///
/// Uses vector clocks: each step knows the last completed step of each queue, from its predecessor on its own queue and
/// from the steps it waits for.
pub fn waits(layout: &QueueLayout, lanes: &[QueueId], dependencies: &[Vec<u32>]) -> (Vec<Edge>, Order) {
    let queues = layout.queues.len();
    // For each step and queue, one more than the last step completed before the step ends.
    let mut known: Vec<Vec<u32>> = Vec::with_capacity(lanes.len());
    let mut last_on: Vec<Option<usize>> = vec![None; queues];
    let mut waits = Vec::new();
    for (step, lane) in lanes.iter().enumerate() {
        let mut own = last_on[lane.index()].map_or_else(|| vec![0; queues], |last| known[last].clone());
        // Latest first, because steps known to it need no wait.
        for after in &dependencies[step] {
            let of = lanes[*after as usize].index();
            if of != lane.index() && own[of] <= *after {
                waits.push(Edge { after: *after, before: step as u32 });
                own.iter_mut().zip(&known[*after as usize]).for_each(|(own, other)| *own = (*own).max(*other));
            }
        }
        own[lane.index()] = step as u32 + 1;
        known.push(own);
        last_on[lane.index()] = Some(step);
    }
    (waits, Order { lanes: lanes.to_vec(), known })
}

/// The partial order of steps.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Order {
    lanes: Vec<QueueId>,
    /// For each step and queue, one more than the last step completed before the step ends.
    known: Vec<Vec<u32>>,
}

impl Order {
    /// Returns `true` if `first` ends before `second` begins.
    pub fn is_before(&self, first: u32, second: u32) -> bool {
        first != second && self.known[second as usize][self.lanes[first as usize].index()] > first
    }
}
