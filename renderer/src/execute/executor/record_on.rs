//! Recording on several threads (feature `threads`).

use super::Executor;
use crate::workers::Workers;

impl Executor {
    /// Sets the threads to record on, from the next frame on. `None` records on the calling thread only.
    ///
    /// Frames are split only if they allow it ([`Frame::allow_threads`](crate::Frame::allow_threads)) and it is measured
    /// to be faster ([`Executor::recording_threads`]). Commands, their order and errors do not depend on the threads.
    pub fn record_on(&mut self, workers: Option<Workers>) {
        let timed = self.options.timing || self.options.trace;
        self.threads.set(workers, &self.gpu.device, timed);
    }

    /// Returns the worker threads, which record in addition to the calling thread.
    pub fn workers(&self) -> Option<&Workers> {
        self.threads.workers()
    }

    /// Records every frame that allows it on several threads, even if it is slower. For tests and measurements.
    #[cfg(any(test, feature = "testing"))]
    pub fn force_record_on(&mut self, workers: Workers) {
        self.record_on(Some(workers));
        self.threads.always_split();
    }

    /// Returns the number of threads that recorded the last frame.
    pub fn recording_threads(&self) -> usize {
        self.threads.recording()
    }
}
