//! Background work with progress and cancellation: panels poll for the result and never block.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::time::Duration;

/// State shared by the work and its owner.
#[derive(Clone, Debug, Default)]
pub struct Handle {
    cancelled: Arc<AtomicBool>,
    /// Completed and total units; 0 and 0 while unknown.
    progress: Arc<[AtomicU64; 2]>,
}

impl Handle {
    /// Returns whether the owner cancelled the work, which should then return at once.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Reports that `done` of `total` units are completed.
    pub fn step(&self, done: u64, total: u64) {
        self.progress[0].store(done, Ordering::Relaxed);
        self.progress[1].store(total, Ordering::Relaxed);
    }
}

/// Running work, cancelled on drop.
#[derive(Debug)]
pub struct Job<T> {
    /// Description for the user, such as `reading frame.ron`.
    pub doing: String,
    handle: Handle,
    result: Receiver<T>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts the work on a new thread. `wake` is called when [`poll`](Self::poll) returns a result, also if the work
    /// panics.
    pub fn start(
        doing: impl Into<String>,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce(&Handle) -> T + Send + 'static,
    ) -> Self {
        let (sender, result) = channel();
        let handle = Handle::default();
        let theirs = handle.clone();
        std::thread::spawn(move || {
            let mut wake = Wake(Some(wake));
            // A panic drops variables in reverse order: the sender first, so that the woken owner finds no result.
            let sender = sender;
            // Sending fails if the owner is gone.
            if sender.send(work(&theirs)).is_err() {
                wake.0 = None;
            }
        });
        Self { doing: doing.into(), handle, result }
    }

    /// Returns the result if available; `Some(Err(()))` if the work panicked.
    pub fn poll(&self) -> Option<Result<T, ()>> {
        match self.result.try_recv() {
            Ok(result) => Some(Ok(result)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(())),
        }
    }

    /// Asks the work to end early. Its result is still available.
    pub fn cancel(&self) {
        self.handle.cancelled.store(true, Ordering::Relaxed);
    }

    /// Waits for the result, at most the given time; `Some(Err(()))` if the work panicked.
    pub fn wait(&self, at_most: Duration) -> Option<Result<T, ()>> {
        match self.result.recv_timeout(at_most) {
            Ok(result) => Some(Ok(result)),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Err(())),
        }
    }

    /// Returns the message for work that panicked.
    pub fn failure(&self) -> String {
        format!("internal error: {} ended without a result", self.doing)
    }

    /// Returns the completed fraction, 0 to 1; `None` while unknown.
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

/// Wakes the owner on drop, and thereby also after a panic.
struct Wake<W: FnOnce()>(Option<W>);

impl<W: FnOnce()> Drop for Wake<W> {
    fn drop(&mut self) {
        if let Some(wake) = self.0.take() {
            wake();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_wakes_the_owner_and_is_no_timeout() {
        let (wake, woken) = channel();
        let wakes = |wake: &std::sync::mpsc::Sender<()>| {
            let wake = wake.clone();
            move || _ = wake.send(())
        };
        let job: Job<u32> = Job::start("panicking", wakes(&wake), |_| panic!("expected by the test"));
        woken.recv_timeout(Duration::from_secs(60)).expect("a panic wakes the owner");
        assert_eq!((job.poll(), job.wait(Duration::ZERO)), (Some(Err(())), Some(Err(()))));
        assert_eq!(job.failure(), "internal error: panicking ended without a result");

        let (go, wait) = channel::<()>();
        let job = Job::start("waiting", wakes(&wake), move |_| wait.recv().is_ok());
        assert_eq!((job.poll(), job.wait(Duration::ZERO)), (None, None), "it is still running");
        go.send(()).expect("it waits");
        woken.recv_timeout(Duration::from_secs(60)).expect("a result wakes the owner");
        assert_eq!(job.wait(Duration::ZERO), Some(Ok(true)));
    }
}
