//! Pool of executors, so that tests compile a device's pipelines only once.

use framegraph_wgpu::{Executor, Gpu};
use std::ops::{Deref, DerefMut};
use std::sync::{Mutex, PoisonError};

/// Idle executors, the most recently used last. They keep their devices open, so there are at most as many as
/// concurrent tests.
static IDLE: Mutex<Vec<Executor>> = Mutex::new(Vec::new());

/// An executor from the pool, which may have drawn other frames. It has no history textures.
#[derive(Debug)]
pub struct Lent(Option<Executor>);

/// Returns an idle executor of the device, or a new one.
///
/// ```no_run
/// let gpu = framegraph_wgpu::Gpu::open(&framegraph_wgpu::AdapterRequest::from_env())?;
/// let first = tests::executors::lend(&gpu);
/// assert!(*first.gpu() == gpu);
/// # Ok::<(), framegraph_wgpu::OpenError>(())
/// ```
#[must_use]
pub fn lend(gpu: &Gpu) -> Lent {
    let mut idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
    let used = idle.iter().position(|executor| executor.gpu() == gpu).map(|at| idle.remove(at));
    drop(idle);
    Lent(Some(used.unwrap_or_else(|| Executor::new(gpu))))
}

impl Deref for Lent {
    type Target = Executor;

    fn deref(&self) -> &Executor {
        self.0.as_ref().expect("it is given back at the end")
    }
}

impl DerefMut for Lent {
    fn deref_mut(&mut self) -> &mut Executor {
        self.0.as_mut().expect("it is given back at the end")
    }
}

impl Drop for Lent {
    fn drop(&mut self) {
        let Some(mut executor) = self.0.take().filter(|_| !std::thread::panicking()) else { return };
        executor.reset_histories();
        executor.trim();
        let mut idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
        idle.push(executor);
        let most = std::thread::available_parallelism().map_or(1, usize::from);
        let gone = (idle.len() > most).then(|| idle.remove(0));
        drop(idle);
        drop(gone);
    }
}
