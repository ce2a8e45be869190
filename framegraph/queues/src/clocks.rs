//! Which semaphores suffice: a wait that follows from others is not said.

use crate::layout::{QueueId, QueueLayout};

/// A dependency between queues: `before` waits until `after` is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    pub after: u32,
    pub before: u32,
}

/// The waits between queues that the others do not imply, in the order of the steps that wait.
///
/// Each step knows of each queue up to which step it is over. It learns that from the step before it on its own queue, and from
/// those that it waits for.
pub fn waits(layout: &QueueLayout, lanes: &[QueueId], dependencies: &[Vec<u32>]) -> (Vec<Edge>, Order) {
    let queues = layout.queues.len();
    // Of each step, by queue, one more than the last step that is over when it is.
    let mut known: Vec<Vec<u32>> = Vec::with_capacity(lanes.len());
    let mut last_on: Vec<Option<usize>> = vec![None; queues];
    let mut waits = Vec::new();
    for (step, lane) in lanes.iter().enumerate() {
        let mut own = last_on[lane.index()].map_or_else(|| vec![0; queues], |last| known[last].clone());
        // The latest first: what it knows need not be waited for.
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

/// Which steps are over when others begin.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Order {
    lanes: Vec<QueueId>,
    /// Of each step, by queue, one more than the last step that is over when it is.
    known: Vec<Vec<u32>>,
}

impl Order {
    /// Whether `first` is over before `second` begins.
    pub fn is_before(&self, first: u32, second: u32) -> bool {
        first != second && self.known[second as usize][self.lanes[first as usize].index()] > first
    }
}
