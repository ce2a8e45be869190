//! Models the duration of a frame on several queues. Queues do not slow each other down in this model.

use crate::layout::{QueueId, QueueLayout};

/// Start and end of each step, in microseconds from the start of the frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times {
    pub begins_us: Vec<f64>,
    pub ends_us: Vec<f64>,
    /// Time at which all queues have ended and the first one is notified.
    pub total_us: f64,
}

/// Runs each queue's steps in order. A step begins when the previous step on its queue and all its dependencies have
/// ended, plus the semaphore delay for dependencies on other queues.
pub fn simulate(layout: &QueueLayout, lanes: &[QueueId], dependencies: &[Vec<u32>], costs_us: &[f64]) -> Times {
    let mut times = Times { begins_us: Vec::new(), ends_us: Vec::with_capacity(lanes.len()), total_us: 0.0 };
    let mut free_us = vec![0.0_f64; layout.queues.len()];
    for (step, lane) in lanes.iter().enumerate() {
        let ready_us = |earlier: &u32| {
            let earlier = *earlier as usize;
            times.ends_us[earlier] + if lanes[earlier] == *lane { 0.0 } else { layout.semaphore_us }
        };
        let begin_us = dependencies[step].iter().map(ready_us).fold(free_us[lane.index()], f64::max);
        times.begins_us.push(begin_us);
        times.ends_us.push(begin_us + costs_us[step]);
        free_us[lane.index()] = begin_us + costs_us[step];
    }
    let joined = |(queue, free_us): (usize, &f64)| match (queue, *free_us) {
        (0, free_us) => free_us,
        (_, 0.0) => 0.0,
        (_, free_us) => free_us + layout.semaphore_us,
    };
    times.total_us = free_us.iter().enumerate().map(joined).fold(0.0, f64::max);
    times
}
