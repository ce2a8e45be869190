//! At most so many frames queued: a frame begins when the device is done with the one that many before it, so that what is shown
//! is never further behind what was asked for.

use crate::device::error::DeviceError;
use crate::device::gpu::Gpu;
use crate::measure::statistics::{Durations, Summary};
use std::collections::VecDeque;
use std::num::NonZeroU32;
use std::sync::{Arc, OnceLock};
use std::time::Instant;
use wgpu::{PollType, SubmissionIndex};

/// The frames that were submitted and that the device is not done with. [`FrameLoop`](crate::FrameLoop) has one; a loop of one's
/// own calls [`FramesInFlight::begin`] before it looks at the input, and [`FramesInFlight::submitted`] behind its submission.
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
    most: NonZeroU32,
    queued: VecDeque<Queued>,
    begun: Option<Instant>,
    waits: u64,
    latency: Durations,
}

#[derive(Debug)]
struct Queued {
    submission: SubmissionIndex,
    begun: Instant,
    /// When the device was done with it; whoever polls the device learns that.
    done: Arc<OnceLock<Instant>>,
}

impl FramesInFlight {
    /// Frames queued at most unless another number is set: the device draws one while the next is recorded.
    pub const DEFAULT: NonZeroU32 = NonZeroU32::MIN.saturating_add(1);

    /// With the default of two frames.
    pub fn new(gpu: &Gpu) -> Self {
        let (queued, latency) = (VecDeque::new(), Durations::default());
        Self { gpu: gpu.clone(), most: Self::DEFAULT, queued, begun: None, waits: 0, latency }
    }

    /// How many frames may be queued, from the next one on: one for the least latency, more for an even rate.
    pub fn set_most(&mut self, most: NonZeroU32) {
        self.most = most;
    }

    /// How many frames may be queued.
    pub fn most(&self) -> NonZeroU32 {
        self.most
    }

    /// Begins a frame: waits for the oldest that is queued, as long as there are as many as may be.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn begin(&mut self) -> Result<(), DeviceError> {
        self.gpu.poll()?;
        self.collect();
        let Self { gpu, most, queued, waits, latency, .. } = self;
        let wait = |oldest: &Queued| {
            *waits += 1;
            let oldest = PollType::Wait { submission_index: Some(oldest.submission.clone()), timeout: None };
            gpu.poll_as(oldest, "waiting for an older frame")
        };
        make_room(queued, *most, wait, |done| latency.push(done.ms()))?;
        self.begun = Some(Instant::now());
        Ok(())
    }

    /// Ends the frame that was begun last: these are its commands. Without one that was begun, it begins here.
    pub fn submitted(&mut self, submission: SubmissionIndex) {
        let begun = self.begun.take().unwrap_or_else(Instant::now);
        let done = Arc::new(OnceLock::new());
        let told = done.clone();
        self.gpu.queue.on_submitted_work_done(move || {
            told.get_or_init(Instant::now);
        });
        self.queued.push_back(Queued { submission, begun, done });
    }

    /// Frames that were submitted and of which it is not known that the device is done with them.
    pub fn queued(&self) -> usize {
        self.queued.len()
    }

    /// How often a frame had to wait for an older one.
    pub fn waits(&self) -> u64 {
        self.waits
    }

    /// Milliseconds from the begin of a frame until the device was done with it, of the latest 256 frames; none before the first
    /// is done. A frame's end is noted when the device is next polled, so this is an upper bound.
    pub fn latency(&self) -> Option<Summary> {
        self.latency.summary()
    }

    /// Takes note of frames that are done.
    fn collect(&mut self) {
        while let Some(done) = self.queued.pop_front_if(|oldest| oldest.done.get().is_some()) {
            self.latency.push(done.ms());
        }
    }
}

impl Queued {
    /// Milliseconds until it was done, or until now.
    fn ms(&self) -> f64 {
        let done = self.done.get().copied().unwrap_or_else(Instant::now);
        done.duration_since(self.begun).as_secs_f64() * 1e3
    }
}

/// Has `wait` wait for the oldest, until there is room for one more among `most`, and hands out those that it waited for.
fn make_room<T, E>(
    queued: &mut VecDeque<T>,
    most: NonZeroU32,
    mut wait: impl FnMut(&T) -> Result<(), E>,
    mut done: impl FnMut(T),
) -> Result<(), E> {
    while queued.len() >= most.get() as usize
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

    /// Frames of a device that is done with none by itself: frame n waits for the one `most` before it, and for no other.
    fn waited(most: u32, frames: u32) -> Vec<(u32, u32)> {
        let (mut queued, mut waited) = (VecDeque::new(), Vec::new());
        let most = NonZeroU32::new(most).unwrap_or(NonZeroU32::MIN);
        for frame in 0..frames {
            let wait = |oldest: &u32| {
                waited.push((frame, *oldest));
                Ok::<_, ()>(())
            };
            assert_eq!(make_room(&mut queued, most, wait, drop), Ok(()));
            queued.push_back(frame);
            assert!(queued.len() <= most.get() as usize);
        }
        waited
    }

    #[test]
    fn a_frame_waits_for_the_one_that_many_before_it() {
        assert_eq!(waited(1, 4), [(1, 0), (2, 1), (3, 2)]);
        assert_eq!(waited(2, 5), [(2, 0), (3, 1), (4, 2)]);
        assert_eq!(waited(3, 3), []);
    }

    #[test]
    fn fewer_frames_than_before_take_effect_with_the_next_one() {
        let mut queued = VecDeque::from([0, 1, 2]);
        let mut done = Vec::new();
        let room = make_room(&mut queued, NonZeroU32::MIN, |_| Ok::<_, ()>(()), |frame| done.push(frame));
        assert_eq!((room, done, queued.len()), (Ok(()), vec![0, 1, 2], 0));
    }

    #[test]
    fn what_cannot_be_waited_for_stays_queued() {
        let mut queued = VecDeque::from([0, 1]);
        assert_eq!(make_room(&mut queued, FramesInFlight::DEFAULT, |_| Err("lost"), drop), Err("lost"));
        assert_eq!(queued.len(), 2);
    }
}
