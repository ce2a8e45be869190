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
    /// Textures that the frame offered, including answers with an error.
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

    /// Removes the value, and returns it.
    fn clear(&mut self) -> Option<Arc<T>> {
        self.taken = true;
        self.value.take()
    }

    /// Returns the value if it is newer than `seen`, the number of the last one. `None` after [`Slot::clear`].
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
    /// Answer to each viewer, until its thread takes it.
    pub textures: [Option<RemoteTexture>; MAX_VIEWERS],
    /// Viewers that are attached.
    pub attached: [bool; MAX_VIEWERS],
    /// Number of connections that each viewer's index had so far.
    connections: [u64; MAX_VIEWERS],
    /// The server ends.
    pub closed: bool,
}

/// Request of a viewer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Requested {
    /// Index of the viewer.
    pub viewer: usize,
    /// Connection of the viewer, from [`Mailbox::attach`]. A later viewer with this index has another one.
    pub connection: u64,
    pub request: TextureRequest,
}

/// Data shared by the frame and the threads of the server.
#[derive(Debug, Default)]
pub(super) struct Mailbox {
    outbox: Mutex<Outbox>,
    changed: Condvar,
    /// Newest request of each viewer.
    requests: Mutex<[Option<Requested>; MAX_VIEWERS]>,
    requested: AtomicBool,
    /// Number of attached viewers.
    pub viewers: AtomicUsize,
    /// Number of times that the last viewer left.
    pub sessions: AtomicU64,
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

    /// Marks a viewer as attached, and returns the number of its connection.
    pub fn attach(&self, viewer: usize) -> u64 {
        self.set_attached(viewer, true)
    }

    /// Marks a viewer as not attached.
    pub fn detach(&self, viewer: usize) {
        self.set_attached(viewer, false);
    }

    /// Removes the data of the viewer with this index, and all data without viewers.
    fn set_attached(&self, viewer: usize, attached: bool) -> u64 {
        self.remove_request(viewer);
        let mut outbox = self.outbox();
        let was_attached = std::mem::replace(&mut outbox.attached[viewer], attached);
        outbox.connections[viewer] += u64::from(attached);
        let connection = outbox.connections[viewer];
        let viewers = outbox.attached.iter().filter(|attached| **attached).count();
        let texture = outbox.textures[viewer].take();
        let rest = (viewers == 0).then(|| (outbox.plan.clear(), outbox.times.clear()));
        // Under the lock, so that the last change of the list is also the last one of the numbers. The session is stored
        // first: a frame that sees a later viewer also sees it.
        self.sessions.fetch_add(u64::from(was_attached && viewers == 0), Ordering::Release);
        self.viewers.store(viewers, Ordering::Release);
        drop(outbox);
        // Large values are freed without the lock.
        drop((texture, rest));
        self.wake();
        connection
    }

    /// Offers data to the viewers without waiting, and returns whether that succeeded.
    fn offer(&self, put: impl FnOnce(&mut Outbox) -> bool, counter: &AtomicU64) -> bool {
        let Some(mut outbox) = self.try_outbox() else { return false };
        // The last viewer may have left since the frame looked.
        if !outbox.attached.contains(&true) {
            return false;
        }
        if put(&mut outbox) {
            count(&self.counters.replaced);
        }
        drop(outbox);
        count(counter);
        true
    }

    /// Offers a plan without waiting, and returns whether that succeeded. Copies the plan only in this case.
    pub fn offer_plan(&self, plan: &Plan) -> bool {
        self.offer(|outbox| outbox.plan.put(OfferedPlan::new(plan)), &self.counters.plans)
    }

    /// Offers times without waiting, and returns whether that succeeded.
    pub fn offer_times(&self, times: FrameSample) -> bool {
        self.offer(|outbox| outbox.times.put(times), &self.counters.times)
    }

    /// Offers the answer to a request without waiting, and returns it if that failed. The answer is dropped if the
    /// connection has ended.
    pub fn offer_texture(&self, to: &Requested, texture: RemoteTexture) -> Result<(), RemoteTexture> {
        let Some(mut outbox) = self.try_outbox() else { return Err(texture) };
        if !outbox.attached[to.viewer] || outbox.connections[to.viewer] != to.connection {
            return Ok(());
        }
        let replaced = outbox.textures[to.viewer].replace(texture);
        drop(outbox);
        if replaced.is_some() {
            count(&self.counters.replaced);
        }
        count(&self.counters.textures);
        self.wake();
        Ok(())
    }

    /// Stores a request. It replaces an earlier one of the same viewer.
    pub fn request(&self, requested: Requested) {
        self.set_request(requested.viewer, Some(requested));
    }

    /// Removes the request of a viewer.
    fn remove_request(&self, viewer: usize) {
        self.set_request(viewer, None);
    }

    fn set_request(&self, viewer: usize, requested: Option<Requested>) {
        let mut requests = self.requests.lock().unwrap_or_else(PoisonError::into_inner);
        requests[viewer] = requested;
        self.requested.store(requests.iter().any(Option::is_some), Ordering::Release);
    }

    /// Takes a request without waiting, of the first viewer after `last` that has one.
    pub fn take_request(&self, last: usize) -> Option<Requested> {
        if !self.requested.load(Ordering::Acquire) {
            return None;
        }
        let mut requests = self.requests.try_lock().ok()?;
        let mut viewers = (1..=MAX_VIEWERS).map(|step| (last + step) % MAX_VIEWERS);
        let viewer = viewers.find(|viewer| requests[*viewer].is_some());
        let found = viewer.and_then(|viewer| requests[viewer].take());
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
        mailbox.attach(0);
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

    fn requested(viewer: usize, connection: u64, number: u32) -> Requested {
        let (text, aspect) = (String::new(), framegraph::Aspect::All);
        Requested { viewer, connection, request: TextureRequest { number, text, aspect, sample: None } }
    }

    #[test]
    fn answers_reach_only_the_connection_that_requested_them() {
        let mailbox = Mailbox::default();
        let first = mailbox.attach(1);
        mailbox.request(requested(1, first, 7));
        let taken = mailbox.take_request(0).expect("a request is stored");
        let texture = || RemoteTexture::failed(7, "none".into());
        mailbox.detach(1);
        assert_eq!(mailbox.offer_texture(&taken, texture()), Ok(()));
        let second = mailbox.attach(1);
        assert_eq!(mailbox.offer_texture(&taken, texture()), Ok(()));
        assert!(second != first && mailbox.outbox().textures[1].is_none(), "the answer is dropped");
        assert_eq!(mailbox.counts().textures, 0);

        let own = requested(1, second, 8);
        assert_eq!(mailbox.offer_texture(&own, texture()), Ok(()));
        assert_eq!(mailbox.outbox().textures[1].take(), Some(texture()), "sending removes the answer");
        assert_eq!(mailbox.outbox().textures[1], None);
    }

    #[test]
    fn nothing_is_kept_without_viewers() {
        let mailbox = Mailbox::default();
        let sample = || FrameSample { frame: 1, ..FrameSample::default() };
        let kept = |mailbox: &Mailbox| mailbox.outbox().times.newer(&mut 0).is_some();
        assert!(!mailbox.offer_times(sample()), "no viewer is attached");
        let [first, second] = [0, 1].map(|viewer| mailbox.attach(viewer));
        assert!(mailbox.offer_times(sample()) && mailbox.offer_plan(&Plan::new()));
        assert_eq!(mailbox.offer_texture(&requested(0, first, 1), RemoteTexture::failed(1, "a".into())), Ok(()));
        assert_eq!(mailbox.offer_texture(&requested(1, second, 1), RemoteTexture::failed(1, "b".into())), Ok(()));
        mailbox.detach(0);
        assert!(mailbox.outbox().textures[0].is_none() && mailbox.outbox().textures[1].is_some());
        assert!(kept(&mailbox) && mailbox.sessions.load(Ordering::Relaxed) == 0);
        mailbox.detach(1);
        mailbox.detach(1);
        assert_eq!((mailbox.sessions.load(Ordering::Relaxed), mailbox.counts().viewers), (1, 0));
        assert!(!kept(&mailbox) && mailbox.outbox().plan.newer(&mut 0).is_none());
        assert!(mailbox.outbox().textures[1].is_none());
        mailbox.attach(0);
        assert!(!kept(&mailbox), "a later viewer gets nothing of earlier ones");
    }

    #[test]
    fn requests_are_taken_in_turn_and_newer_ones_replace_older_ones() {
        let mailbox = Mailbox::default();
        assert_eq!(mailbox.take_request(0), None);
        (1..=9).for_each(|number| mailbox.request(requested(2, 1, number)));
        mailbox.request(requested(0, 1, 10));
        let next = |last| mailbox.take_request(last).map(|found| (found.viewer, found.request.number));
        assert_eq!((next(0), next(2), next(0)), (Some((2, 9)), Some((0, 10)), None));
    }
}
