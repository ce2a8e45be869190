//! Work on a thread of its own, with its progress and a way to end it: panels ask for the result and never wait.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

/// What work and its owner share.
#[derive(Clone, Debug, Default)]
pub struct Handle {
    cancelled: Arc<AtomicBool>,
    /// Finished of how much; 0 of 0 as long as nobody knows.
    progress: Arc<[AtomicU64; 2]>,
}

impl Handle {
    /// Whether the owner no longer wants the result: the work should return at once.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// `done` of `total` units are finished.
    pub fn step(&self, done: u64, total: u64) {
        self.progress[0].store(done, Ordering::Relaxed);
        self.progress[1].store(total, Ordering::Relaxed);
    }
}

/// Work in progress. Dropping it cancels.
#[derive(Debug)]
pub struct Job<T> {
    /// What it does, for the user: `reading frame.ron`.
    pub doing: String,
    handle: Handle,
    result: Receiver<T>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts the work; `wake` is called when there is a result to [`poll`](Self::poll).
    pub fn start(
        doing: impl Into<String>,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce(&Handle) -> T + Send + 'static,
    ) -> Self {
        let (sender, result) = channel();
        let handle = Handle::default();
        let theirs = handle.clone();
        std::thread::spawn(move || {
            // The owner may be gone; then nobody asks.
            if sender.send(work(&theirs)).is_ok() {
                wake();
            }
        });
        Self { doing: doing.into(), handle, result }
    }

    /// The result, once it is there; `Some(Err(()))` when the work ended without one.
    pub fn poll(&self) -> Option<Result<T, ()>> {
        match self.result.try_recv() {
            Ok(result) => Some(Ok(result)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(())),
        }
    }

    /// Waits for the result.
    pub fn wait(&self, at_most: Duration) -> Option<T> {
        self.result.recv_timeout(at_most).ok()
    }

    /// How much is finished, from 0 to 1; none as long as nobody knows.
    pub fn progress(&self) -> Option<f32> {
        let [done, total] = [0, 1].map(|i| self.handle.progress[i].load(Ordering::Relaxed));
        (total > 0).then(|| done as f32 / total as f32)
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.handle.cancelled.store(true, Ordering::Relaxed);
    }
}
