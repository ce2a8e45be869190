//! Pools of physical textures and buffers, reused within a frame through the plan's slots, and from frame to frame.
//!
//! A request is served by the object that last served the same tenant, so that views and bind groups stay valid.
//! Otherwise it is served by the idle object that fits with the least waste, or by a new one. Objects that were not
//! requested for `max_age` frames are dropped, or earlier if the pool exceeds its budget ([`Limits`]).

use crate::device::gpu::Gpu;
use crate::resources::support::Unsupported;

/// Description of objects that a pool can hold.
pub trait Pooled: Copy + Eq {
    /// wgpu object.
    type Object: Clone + std::fmt::Debug;
    /// Returns whether an object of this description can serve `request`.
    fn serves(&self, request: &Self) -> bool;
    /// Returns how much an object of this description exceeds `request`; 0 is a perfect fit.
    fn waste(&self, request: &Self) -> u32;
    /// Returns the size in bytes, without padding.
    fn bytes(&self) -> u64;
    /// Creates an object with a label for debuggers and errors.
    ///
    /// # Errors
    /// Fails if the device does not support the object.
    fn create(&self, gpu: &Gpu, label: &str) -> Result<Self::Object, Unsupported>;
}

/// A request for an object of the pool.
#[derive(Clone, Copy, Debug)]
pub struct Request<S> {
    /// Description of the object.
    pub shape: S,
    /// Identity of the requester. Requests of one tenant get the same object in each frame, as long as it fits.
    pub tenant: u64,
}

/// Limits of age and size of a pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Number of frames after which unused objects are dropped.
    pub max_age: u64,
    /// Maximum size of the pool, as a multiple of the largest of the last [`RECENT`] frames. If it is exceeded, the
    /// objects that were unused for longest are dropped first. Objects of the last two frames are always kept, so that
    /// two alternating graphs do not recreate everything.
    pub budget: u32,
}

/// Number of recent frames whose maximum size sets the budget.
pub(crate) const RECENT: usize = 8;

/// Hits, misses and memory of a pool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PoolCounts {
    /// Number of requests served by existing objects.
    pub hits: u64,
    /// Number of objects created.
    pub created: u64,
    /// Number of objects dropped.
    pub evicted: u64,
    /// Number of objects in the pool.
    pub objects: u64,
    /// Size of all objects in bytes, without padding.
    pub bytes: u64,
    /// Size of the objects that the last frame used, in bytes.
    pub used_bytes: u64,
    /// Maximum size after any frame, in bytes.
    pub peak_bytes: u64,
    /// Current size limit in bytes. Objects of the last two frames may exceed it.
    pub budget_bytes: u64,
}

/// A pool of objects. See the [module documentation](self).
#[derive(Debug)]
pub struct Pool<S: Pooled> {
    entries: Vec<Entry<S>>,
    next: u64,
    frame: u64,
    limits: Limits,
    /// Sizes of recent frames in bytes, as a ring buffer.
    recent: [u64; RECENT],
    counts: PoolCounts,
    /// Index of the entry that serves each request of the frame.
    chosen: Vec<Option<usize>>,
    /// True if `chosen` is complete and no entry has moved since.
    settled: bool,
}

#[derive(Debug)]
struct Entry<S: Pooled> {
    /// Unique number. The older of two equal fits is used.
    id: u64,
    shape: S,
    bytes: u64,
    object: S::Object,
    tenant: u64,
    /// Number of the last frame that used the object.
    used: u64,
}

impl<S: Pooled> Pool<S> {
    /// Creates an empty pool.
    pub fn new(limits: Limits) -> Self {
        let (recent, counts) = ([0; RECENT], PoolCounts::default());
        Self { entries: Vec::new(), next: 0, frame: 0, limits, recent, counts, chosen: Vec::new(), settled: false }
    }

    /// Returns hits, creations and evictions since the pool was created, and its current size.
    pub fn counts(&self) -> PoolCounts {
        PoolCounts { objects: self.entries.len() as u64, bytes: self.bytes(|_| true), ..self.counts }
    }

    fn bytes(&self, counted: impl Fn(&Entry<S>) -> bool) -> u64 {
        self.entries.iter().filter(|e| counted(e)).map(|e| e.bytes).sum()
    }

    /// Begins a frame. All objects become idle.
    pub fn begin_frame(&mut self) {
        self.frame += 1;
    }

    /// Serves all requests of a frame, in order. Each object serves at most one request. `label` returns the label of a
    /// request, for objects that are created.
    ///
    /// # Errors
    /// Fails if the device does not support a requested object.
    pub fn acquire<'n>(
        &mut self,
        gpu: &Gpu,
        requests: &[Request<S>],
        label: impl Fn(usize) -> &'n str,
        out: &mut Vec<S::Object>,
    ) -> Result<(), Unsupported> {
        out.clear();
        self.settled = false;
        let mut chosen = std::mem::take(&mut self.chosen);
        chosen.clear();
        // Requests whose last object still fits are served first, so that no other request takes it.
        chosen.extend(requests.iter().map(|r| self.take(r, |e| e.tenant == r.tenant && e.shape.serves(&r.shape))));
        for (at, (request, index)) in requests.iter().zip(&mut chosen).enumerate() {
            let served = match index.or_else(|| self.take(request, |e| e.shape.serves(&request.shape))) {
                Some(served) => served,
                None => self.create(gpu, request, label(at))?,
            };
            out.push(self.entries[served].object.clone());
            *index = Some(served);
        }
        (self.chosen, self.settled) = (chosen, true);
        Ok(())
    }

    /// Returns whether repeating the last frame's requests would return the same objects.
    pub fn is_settled(&self) -> bool {
        self.settled
    }

    /// Repeats the requests of the last frame. Valid only if the pool [is settled](Pool::is_settled).
    pub fn acquire_again(&mut self) {
        for index in self.chosen.iter().flatten() {
            self.entries[*index].used = self.frame;
        }
        self.counts.hits += self.chosen.len() as u64;
    }

    /// Marks the best fitting idle entry as used.
    fn take(&mut self, request: &Request<S>, fits: impl Fn(&Entry<S>) -> bool) -> Option<usize> {
        let idle = self.entries.iter().enumerate().filter(|(_, e)| e.used != self.frame && fits(e));
        let (index, _) = idle.min_by_key(|(_, e)| (e.shape.waste(&request.shape), e.id))?;
        self.entries[index].used = self.frame;
        self.entries[index].tenant = request.tenant;
        self.counts.hits += 1;
        Some(index)
    }

    fn create(&mut self, gpu: &Gpu, request: &Request<S>, label: &str) -> Result<usize, Unsupported> {
        let Request { shape, tenant } = *request;
        let object = shape.create(gpu, label)?;
        let id = self.next;
        self.next += 1;
        self.counts.created += 1;
        self.entries.push(Entry { id, shape, bytes: shape.bytes(), object, tenant, used: self.frame });
        Ok(self.entries.len() - 1)
    }

    /// Ends a frame. Drops objects that are too old or exceed the budget, and calls `gone` for each.
    pub fn evict(&mut self, mut gone: impl FnMut(&S::Object)) {
        let (frame, Limits { max_age, budget }) = (self.frame, self.limits);
        self.retain(|e| frame - e.used <= max_age, &mut gone);
        let used_bytes = self.bytes(|e| e.used == frame);
        self.recent[frame as usize % RECENT] = used_bytes;
        let largest = self.recent.iter().copied().max().unwrap_or(0);
        let budget_bytes = largest.saturating_mul(budget.into());
        let mut bytes = self.bytes(|_| true);
        while bytes > budget_bytes {
            let idle = self.entries.iter().filter(|e| e.used + 1 < frame);
            let Some((id, freed)) = idle.min_by_key(|e| (e.used, e.id)).map(|e| (e.id, e.bytes)) else { break };
            self.retain(|e| e.id != id, &mut gone);
            bytes -= freed;
        }
        let peak_bytes = self.counts.peak_bytes.max(bytes);
        self.counts = PoolCounts { used_bytes, peak_bytes, budget_bytes, ..self.counts };
    }

    /// Drops all objects that this frame did not use, and calls `gone` for each.
    pub fn trim(&mut self, gone: impl FnMut(&S::Object)) {
        let frame = self.frame;
        self.retain(|e| e.used == frame, gone);
    }

    /// Drops all objects that this frame used. Called after a device error, since they may be invalid.
    pub fn discard_frame(&mut self, gone: impl FnMut(&S::Object)) {
        let frame = self.frame;
        self.retain(|e| e.used != frame, gone);
    }

    fn retain(&mut self, stays: impl Fn(&Entry<S>) -> bool, mut gone: impl FnMut(&S::Object)) {
        let before = self.entries.len();
        self.entries.retain(|e| {
            let stays = stays(e);
            if !stays {
                gone(&e.object);
            }
            stays
        });
        let gone = before - self.entries.len();
        self.settled &= gone == 0;
        self.counts.evicted += gone as u64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;
    use crate::device::open_error::OpenError;

    /// Test description: size in the higher digits, usages in the last digit.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    struct Toy(u32);

    impl Pooled for Toy {
        /// Number of objects created before.
        type Object = u64;
        fn serves(&self, request: &Self) -> bool {
            self.0 / 10 == request.0 / 10 && self.0 % 10 >= request.0 % 10
        }
        fn waste(&self, request: &Self) -> u32 {
            self.0 - request.0
        }
        fn bytes(&self) -> u64 {
            u64::from(self.0 / 10)
        }
        fn create(&self, _: &Gpu, label: &str) -> Result<u64, Unsupported> {
            Ok(label.len() as u64)
        }
    }

    struct Bench {
        gpu: Gpu,
        pool: Pool<Toy>,
    }

    impl Bench {
        fn new(max_age: u64, budget: u32) -> Result<Self, OpenError> {
            Ok(Self { gpu: Gpu::noop()?, pool: Pool::new(Limits { max_age, budget }) })
        }

        /// Executes one frame with pairs of tenant and description. Returns the object numbers.
        fn frame(&mut self, asked: &[(u64, u32)]) -> Vec<u64> {
            self.pool.begin_frame();
            let requests: Vec<_> = asked.iter().map(|(t, s)| Request { shape: Toy(*s), tenant: *t }).collect();
            let mut out = Vec::new();
            // The object number is encoded in the length of the label.
            let labels = "1".repeat(64);
            let made = std::cell::Cell::new(self.pool.counts.created as usize);
            let label = |_: usize| &labels[..made.replace(made.get() + 1)];
            let served = self.pool.acquire(&self.gpu, &requests, label, &mut out);
            assert!(served.is_ok(), "creating a test object cannot fail");
            self.pool.evict(|_| ());
            out
        }
    }

    #[test]
    fn tenants_keep_their_objects() -> Result<(), OpenError> {
        let mut bench = Bench::new(30, 9)?;
        assert_eq!(bench.frame(&[(7, 40), (8, 40)]), [0, 1]);
        assert_eq!(bench.frame(&[(8, 40), (7, 40)]), [1, 0], "the order of requests does not matter");
        assert_eq!(bench.frame(&[(9, 40), (8, 40)]), [0, 1], "a new tenant gets the unused object");
        let PoolCounts { hits, created, evicted, objects, bytes, .. } = bench.pool.counts();
        assert_eq!((hits, created, evicted, objects, bytes), (4, 2, 0, 2, 8));
        Ok(())
    }

    #[test]
    fn the_best_fit_is_used_and_no_object_twice() -> Result<(), OpenError> {
        let mut bench = Bench::new(30, 9)?;
        assert_eq!(bench.frame(&[(1, 45), (2, 42)]), [0, 1]);
        assert_eq!(bench.frame(&[(3, 41)]), [1], "42 wastes less than 45");
        assert_eq!(bench.frame(&[(4, 41), (5, 41), (6, 41)]), [1, 0, 2]);
        Ok(())
    }

    #[test]
    fn age_evicts_and_a_resize_back_finds_the_old_object() -> Result<(), OpenError> {
        let mut bench = Bench::new(3, 9)?;
        assert_eq!(bench.frame(&[(1, 40)]), [0]);
        assert_eq!(bench.frame(&[(1, 90)]), [1]);
        assert_eq!(bench.frame(&[(1, 40)]), [0]);
        for _ in 0..3 {
            assert_eq!(bench.frame(&[(1, 40)]), [0]);
        }
        let PoolCounts { hits, created, evicted, objects, bytes, .. } = bench.pool.counts();
        assert_eq!((hits, created, evicted, objects, bytes), (4, 2, 1, 1, 4));
        assert_eq!(bench.frame(&[(1, 90)]), [2], "ids are unique");
        Ok(())
    }

    /// Simulates a window resize: each frame requests two objects of a new size.
    #[test]
    fn old_sizes_are_dropped_beyond_the_budget() -> Result<(), OpenError> {
        let mut bench = Bench::new(30, 3)?;
        for size in 100..120 {
            let ids = bench.frame(&[(1, size * 10), (2, size * 10 + 1)]);
            let PoolCounts { bytes, used_bytes, budget_bytes, peak_bytes, .. } = bench.pool.counts();
            assert_eq!(used_bytes, u64::from(size) * 2);
            assert_eq!(budget_bytes, used_bytes * 3);
            assert!(bytes <= budget_bytes && peak_bytes >= bytes, "{bytes} of {budget_bytes}");
            if size > 102 {
                // The budget allows three frames.
                assert_eq!(bytes, u64::from(size + size - 1) * 2 + u64::from(size - 2) * 2, "size {size}");
                assert_eq!(ids[0], u64::from(size - 100) * 2);
            }
        }
        assert_eq!(bench.frame(&[(1, 1180), (2, 1181)]), [36, 37], "the previous size is still pooled");
        bench.pool.trim(|_| ());
        assert_eq!(bench.pool.counts().bytes, 236, "only objects of the last frame remain");
        Ok(())
    }

    #[test]
    fn alternating_graphs_keep_their_objects() -> Result<(), OpenError> {
        let mut bench = Bench::new(30, 1)?;
        let (large, small) = ([(1, 9000), (2, 9000)], [(3, 50)]);
        bench.frame(&large);
        bench.frame(&small);
        for _ in 0..20 {
            assert_eq!((bench.frame(&large), bench.frame(&small)), (vec![0, 1], vec![2]));
        }
        Ok(())
    }
}
