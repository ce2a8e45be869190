//! Limits the number of queued frames, and thereby the latency between input and display.

use crate::clock::Instant;
use crate::device::error::DeviceError;
use crate::device::gpu::Gpu;
use crate::measure::statistics::{Durations, Summary};
use std::collections::VecDeque;
use std::num::NonZeroU32;
use std::sync::{Arc, OnceLock};
use wgpu::{PollType, SubmissionIndex};

/// Frames that were submitted and are not known to be finished on the device.
///
/// [`FrameLoop`](crate::FrameLoop) contains one. A custom loop calls [`FramesInFlight::begin`] before it reads input,
/// and [`FramesInFlight::submitted`] after it submits.
///
/// ```
/// use framegraph_wgpu::{FramesInFlight, Gpu};
///
/// let gpu = Gpu::noop()?;
/// let mut flight = FramesInFlight::new(&gpu);
/// for _ in 0..5 {
///     flight.begin()?;
///     let commands = gpu.device.create_command_encoder(&Default::default()).finish();
///     flight.submitted(gpu.queue.submit([commands]));
///     assert!(flight.queued() <= 2);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FramesInFlight {
    gpu: Gpu,
    max: NonZeroU32,
    queued: VecDeque<Queued>,
    /// Times of finished frames, reused.
    spare: Vec<Arc<OnceLock<Instant>>>,
    started: Option<Instant>,
    waits: u64,
    latency: Durations,
}

#[derive(Debug)]
struct Queued {
    submission: SubmissionIndex,
    started: Instant,
    /// Time when the device finished the frame, set by a callback while the device is polled.
    done: Arc<OnceLock<Instant>>,
}

impl FramesInFlight {
    /// Default maximum number of queued frames: 2, so that one frame is recorded while the device draws the other.
    pub const DEFAULT: NonZeroU32 = NonZeroU32::MIN.saturating_add(1);

    /// Creates an empty queue with the default maximum of two frames.
    pub fn new(gpu: &Gpu) -> Self {
        let (queued, latency) = (VecDeque::new(), Durations::default());
        Self { gpu: gpu.clone(), max: Self::DEFAULT, queued, spare: Vec::new(), started: None, waits: 0, latency }
    }

    /// Sets the maximum number of queued frames, from the next frame on. 1 gives the lowest latency; higher values give
    /// a more even frame rate.
    pub fn set_max(&mut self, max: NonZeroU32) {
        self.max = max;
    }

    /// Returns the maximum number of queued frames.
    pub fn max(&self) -> NonZeroU32 {
        self.max
    }

    /// Begins a frame. Blocks until fewer frames than the maximum are queued, except in browsers.
    ///
    /// # Errors
    /// Fails if the device is lost.
    pub fn begin(&mut self) -> Result<(), DeviceError> {
        self.gpu.poll()?;
        self.collect();
        let Self { gpu, max, queued, spare, waits, latency, .. } = self;
        let wait = |oldest: &Queued| {
            *waits += 1;
            let oldest = PollType::Wait { submission_index: Some(oldest.submission.clone()), timeout: None };
            gpu.poll_as(oldest, "waiting for an older frame")
        };
        let finished = |frame: Queued| {
            latency.push(frame.ms());
            spare.push(frame.done);
        };
        make_room(queued, *max, wait, finished)?;
        self.started = Some(Instant::now());
        Ok(())
    }

    /// Ends the current frame, whose commands have the index `submission`. If [`FramesInFlight::begin`] was not called,
    /// the frame begins now.
    pub fn submitted(&mut self, submission: SubmissionIndex) {
        let started = self.started.take().unwrap_or_else(Instant::now);
        let mut done = self.spare.pop().unwrap_or_default();
        match Arc::get_mut(&mut done) {
            Some(time) => drop(time.take()),
            // The callback was not dropped yet.
            None => done = Arc::default(),
        }
        let finished = done.clone();
        self.gpu.queue.on_submitted_work_done(move || {
            finished.get_or_init(Instant::now);
        });
        self.queued.push_back(Queued { submission, started, done });
    }

    /// Returns the number of submitted frames that are not known to be finished.
    pub fn queued(&self) -> usize {
        self.queued.len()
    }

    /// Returns how many times [`FramesInFlight::begin`] had to wait for an older frame.
    pub fn waits(&self) -> u64 {
        self.waits
    }

    /// Returns the latency of the last 256 frames in milliseconds, from [`FramesInFlight::begin`] until the device
    /// finished.
    ///
    /// `None` until the first frame is finished. The end of a frame is noticed when the device is polled, so values are
    /// upper bounds.
    pub fn latency(&self) -> Option<Summary> {
        self.latency.summary()
    }

    /// Removes finished frames from the queue and records their latency.
    fn collect(&mut self) {
        while let Some(done) = self.queued.pop_front_if(|oldest| oldest.done.get().is_some()) {
            self.latency.push(done.ms());
            self.spare.push(done.done);
        }
    }
}

impl Queued {
    /// Returns the milliseconds from the begin of the frame until its end, or until now.
    fn ms(&self) -> f64 {
        let done = self.done.get().copied().unwrap_or_else(Instant::now);
        done.duration_since(self.started).as_secs_f64() * 1e3
    }
}

/// Calls `wait` with the oldest frame until fewer than `max` are queued. Hands each awaited frame to `done`.
fn make_room<T, E>(
    queued: &mut VecDeque<T>,
    max: NonZeroU32,
    mut wait: impl FnMut(&T) -> Result<(), E>,
    mut done: impl FnMut(T),
) -> Result<(), E> {
    while queued.len() >= max.get() as usize
        && let Some(oldest) = queued.front()
    {
        wait(oldest)?;
        queued.pop_front().into_iter().for_each(&mut done);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simulates a device that finishes a frame only when waited for. Returns pairs of a frame and the one it waited
    /// for.
    fn waited(max: u32, frames: u32) -> Vec<(u32, u32)> {
        let (mut queued, mut waited) = (VecDeque::new(), Vec::new());
        let max = NonZeroU32::new(max).unwrap_or(NonZeroU32::MIN);
        for frame in 0..frames {
            let wait = |oldest: &u32| {
                waited.push((frame, *oldest));
                Ok::<_, ()>(())
            };
            assert_eq!(make_room(&mut queued, max, wait, drop), Ok(()));
            queued.push_back(frame);
            assert!(queued.len() <= max.get() as usize);
        }
        waited
    }

    #[test]
    fn a_frame_waits_for_the_oldest_frame_in_flight() {
        assert_eq!(waited(1, 4), [(1, 0), (2, 1), (3, 2)]);
        assert_eq!(waited(2, 5), [(2, 0), (3, 1), (4, 2)]);
        assert_eq!(waited(3, 3), []);
    }

    #[test]
    fn a_smaller_maximum_takes_effect_in_the_next_frame() {
        let mut queued = VecDeque::from([0, 1, 2]);
        let mut done = Vec::new();
        let room = make_room(&mut queued, NonZeroU32::MIN, |_| Ok::<_, ()>(()), |frame| done.push(frame));
        assert_eq!((room, done, queued.len()), (Ok(()), vec![0, 1, 2], 0));
    }

    #[test]
    fn a_failed_wait_keeps_the_frame_queued() {
        let mut queued = VecDeque::from([0, 1]);
        assert_eq!(make_room(&mut queued, FramesInFlight::DEFAULT, |_| Err("lost"), drop), Err("lost"));
        assert_eq!(queued.len(), 2);
    }
}
