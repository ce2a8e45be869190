//! Threads that record the steps of a frame in parallel.

use std::fmt;
use std::sync::Arc;

/// A pool of threads for recording. Clones share the threads.
///
/// Each thread is pinned to its own core while cores last. One core is left to the submitting thread, which records as
/// well. Threads beyond the number of cores are not pinned, nor is the submitting thread.
///
/// Pass the workers to [`Executor::record_on`](crate::Executor::record_on), and allow threads with
/// [`Frame::allow_threads`](crate::Frame::allow_threads).
///
/// ```
/// use framegraph_wgpu::{Executor, Gpu, Workers};
///
/// let gpu = Gpu::noop()?;
/// let mut executor = Executor::new(&gpu);
/// let workers = Workers::new()?;
/// assert!(workers.threads() >= 1);
/// executor.record_on(Some(workers));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Workers {
    /// `None` if only the calling thread works.
    pool: Option<Arc<rayon::ThreadPool>>,
}

/// Error: the operating system refused to start a thread.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("no worker threads could be started: {reason}; record on one thread instead")]
pub struct WorkersError {
    /// Message of the operating system.
    pub reason: String,
}

impl fmt::Debug for WorkersError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Workers {
    /// Creates one thread for each available core, counting the calling thread.
    ///
    /// # Errors
    /// Fails if the operating system refuses to start a thread.
    pub fn new() -> Result<Self, WorkersError> {
        Self::with_threads(std::thread::available_parallelism().map_or(1, usize::from))
    }

    /// Creates a pool of `threads` threads, counting the calling thread. 0 and 1 start none.
    ///
    /// # Errors
    /// Fails if the operating system refuses to start a thread.
    pub fn with_threads(threads: usize) -> Result<Self, WorkersError> {
        if threads < 2 {
            return Ok(Self { pool: None });
        }
        let cores = core_affinity::get_core_ids().unwrap_or_default();
        // The last core is left to the submitting thread.
        let cores = cores.split_last().map_or(Vec::new(), |(_, others)| others.to_vec());
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads - 1)
            .thread_name(|index| format!("frame worker {index}"))
            .start_handler(move |index| {
                if let Some(core) = cores.get(index) {
                    core_affinity::set_for_current(*core);
                }
            })
            .build()
            .map_err(|error| WorkersError { reason: error.to_string() })?;
        Ok(Self { pool: Some(Arc::new(pool)) })
    }

    /// Returns the number of threads, counting the calling thread.
    pub fn threads(&self) -> usize {
        self.pool.as_ref().map_or(1, |pool| pool.current_num_threads() + 1)
    }

    /// Returns the pool of additional threads, for other CPU work of the frame. With `in_place_scope`, the calling
    /// thread works too. `None` if there are no additional threads.
    pub fn pool(&self) -> Option<&rayon::ThreadPool> {
        self.pool.as_deref()
    }

    /// Calls every job with the world and returns when all are done. The first runs on the calling thread, the others on
    /// the pool.
    pub(crate) fn run<W: ?Sized + Sync>(&self, jobs: &mut [Job<'_, W>], world: &W) {
        let Some((pool, (first, others))) = self.pool.as_ref().zip(jobs.split_first_mut()) else {
            return jobs.iter_mut().for_each(|job| job(world));
        };
        pool.in_place_scope(|scope| {
            others.iter_mut().for_each(|job| scope.spawn(move |_| job(world)));
            first(world);
        });
    }
}

/// Work of one thread.
pub(crate) type Job<'a, W> = &'a mut (dyn FnMut(&W) + Send);

/// Function that runs jobs on several threads. A value exists only for worlds that threads can share.
pub(crate) type ShareWorld<W> = fn(&Workers, &mut [Job<'_, W>], &W);

/// Runs jobs on several threads.
pub(crate) fn share_world<W: ?Sized + Sync>(workers: &Workers, jobs: &mut [Job<'_, W>], world: &W) {
    workers.run(jobs, world);
}

impl fmt::Debug for Workers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Workers").field("threads", &self.threads()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread::{self, ThreadId};

    /// Checks affinities as reported by the system: a pinned thread may run on one core. The last core is not assigned.
    #[cfg(target_os = "linux")]
    #[test]
    fn threads_are_pinned_while_cores_last() -> Result<(), WorkersError> {
        let cores = core_affinity::get_core_ids().unwrap_or_default();
        let workers = Workers::with_threads(cores.len() + 2)?;
        let pool = workers.pool().ok_or(WorkersError { reason: "no pool".into() })?;
        let may_run_on = pool.broadcast(|_| core_affinity::get_core_ids().unwrap_or_default());
        let expected: Vec<_> =
            (0..=cores.len()).map(|at| if at + 1 < cores.len() { vec![cores[at]] } else { cores.clone() }).collect();
        assert_eq!(may_run_on, expected);
        Ok(())
    }

    /// Checks that all items are processed, the first one by the caller.
    #[test]
    fn every_item_is_processed_once() -> Result<(), WorkersError> {
        for threads in [0, 1, 2, 5] {
            let workers = Workers::with_threads(threads)?;
            assert_eq!(workers.threads(), threads.max(1));
            let mut items: Vec<(u32, Option<ThreadId>)> = (0..40).map(|i| (i, None)).collect();
            let work = |(number, by): &mut (u32, Option<ThreadId>), more: &u32| {
                *number += more;
                *by = Some(thread::current().id());
            };
            let mut jobs: Vec<_> = items.iter_mut().map(|item| move |more: &u32| work(item, more)).collect();
            let mut jobs: Vec<Job<'_, u32>> = jobs.iter_mut().map(|job| job as Job<'_, u32>).collect();
            share_world(&workers, &mut jobs, &100);
            assert!(items.iter().zip(100..).all(|((number, by), i)| *number == i && by.is_some()), "{items:?}");
            assert_eq!(items[0].1, Some(thread::current().id()));
            assert_eq!(threads > 1, items[1].1 != items[0].1, "with {threads} threads");
        }
        Ok(())
    }
}
