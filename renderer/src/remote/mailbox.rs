//! Data that the frame and the threads of the viewers exchange: one slot of each kind, the newest wins.

use super::message::{FrameSample, RemotePlan, RemoteTexture, TextureRequest};
use framegraph::Plan;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, OnceLock, PoisonError, TryLockError};
use std::time::Duration;

/// Maximum number of attached viewers.
pub const MAX_VIEWERS: usize = 4;
/// Interval in which a sender looks for plans and times.
const LOOK: Duration = Duration::from_millis(25);

/// Counts of a server since its start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RemoteCounts {
    /// Number of attached viewers.
    pub viewers: usize,
    /// Connections that were accepted.
    pub accepted: u64,
    /// Connections that were refused, or closed after an error of the peer.
    pub refused: u64,
    /// Plans that the frame offered.
    pub plans: u64,
    /// Samples of times that the frame offered.
    pub times: u64,
    /// Textures that the frame read.
    pub textures: u64,
    /// Offers that replaced one that no viewer had taken.
    pub replaced: u64,
    /// Frames that offered nothing, because a thread held the lock.
    pub skipped: u64,
    /// Messages that were sent completely.
    pub sent: u64,
}

/// Counters behind [`RemoteCounts`].
#[derive(Debug, Default)]
pub(super) struct Counters {
    pub accepted: AtomicU64,
    pub refused: AtomicU64,
    pub plans: AtomicU64,
    pub times: AtomicU64,
    pub textures: AtomicU64,
    pub replaced: AtomicU64,
    pub skipped: AtomicU64,
    pub sent: AtomicU64,
}

/// Adds one to a counter.
pub(super) fn count(counter: &AtomicU64) {
    counter.fetch_add(1, Ordering::Relaxed);
}

/// A plan of the engine. The first viewer's thread converts it.
#[derive(Debug)]
pub(super) struct OfferedPlan {
    plan: Plan,
    converted: OnceLock<RemotePlan>,
}

impl OfferedPlan {
    /// Copies a plan.
    pub fn new(plan: &Plan) -> Self {
        Self { plan: plan.clone(), converted: OnceLock::new() }
    }

    /// Returns the plan as a message.
    pub fn message(&self, engine: &str) -> &RemotePlan {
        let plan = &self.plan;
        self.converted.get_or_init(|| RemotePlan {
            compilation: plan.compilation(),
            json: framegraph::dump::json(plan, engine),
            graph: framegraph::file::to_ron(plan.graph(), engine, plan.frame()),
            caps: plan.caps().clone(),
            options: *plan.options(),
            declared_at: plan.graph().passes().iter().map(|pass| pass.location.to_string()).collect(),
        })
    }
}

/// Slot with the newest value of one kind.
#[derive(Debug)]
pub(super) struct Slot<T> {
    value: Option<Arc<T>>,
    number: u64,
    taken: bool,
}

impl<T> Default for Slot<T> {
    fn default() -> Self {
        Self { value: None, number: 0, taken: true }
    }
}

impl<T> Slot<T> {
    /// Replaces the value, and returns whether no viewer took the previous one.
    fn put(&mut self, value: T) -> bool {
        self.value = Some(Arc::new(value));
        self.number += 1;
        !std::mem::replace(&mut self.taken, false)
    }

    /// Returns the value if it is newer than `seen`, the number of the last one.
    pub fn newer(&mut self, seen: &mut u64) -> Option<Arc<T>> {
        if self.number == *seen {
            return None;
        }
        (*seen, self.taken) = (self.number, true);
        self.value.clone()
    }
}

/// Data on its way to the viewers.
#[derive(Debug, Default)]
pub(super) struct Outbox {
    pub plan: Slot<OfferedPlan>,
    pub times: Slot<FrameSample>,
    /// Answers to each viewer.
    pub textures: [Slot<RemoteTexture>; MAX_VIEWERS],
    /// Viewers that are attached.
    pub attached: [bool; MAX_VIEWERS],
    /// The server ends.
    pub closed: bool,
}

/// Data shared by the frame and the threads of the server.
#[derive(Debug, Default)]
pub(super) struct Mailbox {
    outbox: Mutex<Outbox>,
    changed: Condvar,
    /// Newest request of each viewer.
    requests: Mutex<[Option<TextureRequest>; MAX_VIEWERS]>,
    requested: AtomicBool,
    /// Number of attached viewers.
    pub viewers: AtomicUsize,
    pub counters: Counters,
}

impl Mailbox {
    /// Locks the outbox. For the threads of the server, which hold it to copy pointers only.
    pub fn outbox(&self) -> MutexGuard<'_, Outbox> {
        self.outbox.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Locks the outbox without waiting. For the frame.
    fn try_outbox(&self) -> Option<MutexGuard<'_, Outbox>> {
        match self.outbox.try_lock() {
            Ok(outbox) => Some(outbox),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => {
                count(&self.counters.skipped);
                None
            }
        }
    }

    /// Waits for a texture or the end, at most [`LOOK`]. Plans and times wake no thread, because a woken thread can
    /// preempt the frame.
    pub fn wait(&self, outbox: MutexGuard<'_, Outbox>) {
        drop(self.changed.wait_timeout(outbox, LOOK).unwrap_or_else(PoisonError::into_inner));
    }

    /// Wakes the threads that wait.
    pub fn wake(&self) {
        self.changed.notify_all();
    }

    /// Offers data to the viewers without waiting, and returns whether that succeeded.
    fn offer(&self, put: impl FnOnce(&mut Outbox) -> bool, counter: &AtomicU64) -> bool {
        let Some(mut outbox) = self.try_outbox() else { return false };
        if put(&mut outbox) {
            count(&self.counters.replaced);
        }
        drop(outbox);
        count(counter);
        true
    }

    /// Offers a plan without waiting, and returns whether that succeeded.
    pub fn offer_plan(&self, plan: OfferedPlan) -> bool {
        self.offer(|outbox| outbox.plan.put(plan), &self.counters.plans)
    }

    /// Offers times without waiting, and returns whether that succeeded.
    pub fn offer_times(&self, times: FrameSample) -> bool {
        self.offer(|outbox| outbox.times.put(times), &self.counters.times)
    }

    /// Offers a texture to one viewer without waiting. Returns it if that failed.
    pub fn offer_texture(&self, viewer: usize, texture: RemoteTexture) -> Result<(), RemoteTexture> {
        let Some(mut outbox) = self.try_outbox() else { return Err(texture) };
        if outbox.textures[viewer].put(texture) {
            count(&self.counters.replaced);
        }
        drop(outbox);
        count(&self.counters.textures);
        self.wake();
        Ok(())
    }

    /// Stores the request of a viewer; `None` removes it.
    pub fn request(&self, viewer: usize, request: Option<TextureRequest>) {
        let mut requests = self.requests.lock().unwrap_or_else(PoisonError::into_inner);
        requests[viewer] = request;
        self.requested.store(requests.iter().any(Option::is_some), Ordering::Release);
    }

    /// Takes a request without waiting, of the first viewer after `last` that has one.
    pub fn take_request(&self, last: usize) -> Option<(usize, TextureRequest)> {
        if !self.requested.load(Ordering::Acquire) {
            return None;
        }
        let mut requests = self.requests.try_lock().ok()?;
        let mut viewers = (1..=MAX_VIEWERS).map(|step| (last + step) % MAX_VIEWERS);
        let viewer = viewers.find(|viewer| requests[*viewer].is_some());
        let found = viewer.and_then(|viewer| Some((viewer, requests[viewer].take()?)));
        self.requested.store(requests.iter().any(Option::is_some), Ordering::Release);
        found
    }

    /// Returns the counts.
    pub fn counts(&self) -> RemoteCounts {
        let Counters { accepted, refused, plans, times, textures, replaced, skipped, sent } = &self.counters;
        let of = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        RemoteCounts {
            viewers: self.viewers.load(Ordering::Relaxed),
            accepted: of(accepted),
            refused: of(refused),
            plans: of(plans),
            times: of(times),
            textures: of(textures),
            replaced: of(replaced),
            skipped: of(skipped),
            sent: of(sent),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_value_wins_and_a_held_lock_is_not_waited_for() {
        let mailbox = Mailbox::default();
        let sample = |frame| FrameSample { frame, ..FrameSample::default() };
        for frame in 1..=1000 {
            assert!(mailbox.offer_times(sample(frame)));
        }
        let mut seen = 0;
        let newest = mailbox.outbox().times.newer(&mut seen).map(|times| times.frame);
        assert_eq!((newest, mailbox.outbox().times.newer(&mut seen)), (Some(1000), None));
        let counts = mailbox.counts();
        assert_eq!((counts.times, counts.replaced, counts.skipped), (1000, 999, 0));

        let held = mailbox.outbox();
        assert!(!mailbox.offer_times(sample(1001)), "returns while another thread holds the lock");
        drop(held);
        assert_eq!((mailbox.counts().times, mailbox.counts().skipped), (1000, 1));
    }

    #[test]
    fn requests_are_taken_in_turn_and_newer_ones_replace_older_ones() {
        let mailbox = Mailbox::default();
        let request = |number| {
            let (text, aspect) = (String::new(), framegraph::Aspect::All);
            Some(TextureRequest { number, text, aspect, sample: None })
        };
        assert_eq!(mailbox.take_request(0), None);
        (1..=9).for_each(|number| mailbox.request(2, request(number)));
        mailbox.request(0, request(10));
        let next = |last| mailbox.take_request(last).map(|(viewer, request)| (viewer, request.number));
        assert_eq!((next(0), next(2), next(0)), (Some((2, 9)), Some((0, 10)), None));
    }
}
