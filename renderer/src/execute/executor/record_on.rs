//! Recording on several threads, where the program was built with the feature `threads`.

use super::Executor;
use crate::workers::Workers;

impl Executor {
    /// Records steps on these threads too, from the next frame on, where that is measured to be faster
    /// ([`Executor::recording_threads`]); on this thread alone without. What reaches the device is the same, in the same
    /// order, and so is an error.
    pub fn record_on(&mut self, workers: Option<Workers>) {
        let timed = self.options.timing || self.options.trace;
        self.threads.set(workers, &self.gpu.device, timed);
    }

    /// The threads that it may record on, beside the caller's.
    pub fn workers(&self) -> Option<&Workers> {
        self.threads.workers()
    }

    /// As [`Executor::record_on`], of every frame, whether it is faster or not: for tests and measurements.
    #[cfg(any(test, feature = "testing"))]
    pub fn always_record_on(&mut self, workers: Workers) {
        self.record_on(Some(workers));
        self.threads.always();
    }

    /// How many threads recorded the last frame.
    pub fn recording_threads(&self) -> usize {
        self.threads.recording()
    }
}
