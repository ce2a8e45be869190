//! Physical textures and buffers that are used again: within a frame by the plan's slots, and from frame to frame.
//!
//! A request is served by the object that served the same tenant last (so views and bind groups made for it stay good),
//! else by the idle object that covers it with the least waste, else by a new one. An object that no frame asked for during
//! `max_age` frames is given up; until then a resize back, an odd size or a toggled effect finds it again, as long as the pool
//! keeps to its budget ([`Limits`]).

use crate::device::gpu::Gpu;
use crate::resources::support::Unsupported;

/// What a pool needs of the shape of its objects.
pub trait Pooled: Copy + Eq {
    /// The wgpu object.
    type Object: Clone + std::fmt::Debug;
    /// Whether an object of this shape can be used where `request` is asked for.
    fn serves(&self, request: &Self) -> bool;
    /// How much more than `request` an object of this shape offers; 0 is a perfect fit.
    fn waste(&self, request: &Self) -> u32;
    /// Bytes without padding.
    fn bytes(&self) -> u64;
    /// Makes an object, called `label` in debuggers and errors.
    ///
    /// # Errors
    /// When the device offers no such thing.
    fn create(&self, gpu: &Gpu, label: &str) -> Result<Self::Object, Unsupported>;
}

/// What one frame asks of the pool.
#[derive(Clone, Copy, Debug)]
pub struct Request<S> {
    /// What the object must be.
    pub shape: S,
    /// Who asks: requests of one tenant in successive frames get one object, as long as it fits.
    pub tenant: u64,
}

/// How long and how much a pool keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Frames after which an object that no frame asked for is given up.
    pub max_age: u64,
    /// Beyond so many times the bytes that the largest of the last [`RECENT`] frames used, objects are given up before they
    /// are old: those first that no frame asked for the longest, so the sizes that a drag has left behind. What the last
    /// two frames used stays in any case: two graphs that take turns must not make everything anew.
    pub budget: u32,
}

/// Frames among which the largest sets the budget.
pub(crate) const RECENT: usize = 8;

/// Hits, misses and memory of a pool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PoolCounts {
    /// Requests that an existing object served.
    pub hits: u64,
    /// Requests for which an object was made.
    pub created: u64,
    /// Objects given up.
    pub evicted: u64,
    /// Objects held now.
    pub objects: u64,
    /// Bytes held now, without padding.
    pub bytes: u64,
    /// Bytes of what the last frame used.
    pub used_bytes: u64,
    /// The most bytes that were held after a frame.
    pub peak_bytes: u64,
    /// What may be held beside what the last two frames used.
    pub budget_bytes: u64,
}

/// Objects of one kind. See the [module](self).
#[derive(Debug)]
pub struct Pool<S: Pooled> {
    entries: Vec<Entry<S>>,
    next: u64,
    frame: u64,
    limits: Limits,
    /// Bytes that the last frames used, in a ring.
    recent: [u64; RECENT],
    counts: PoolCounts,
    /// The entry of each request of the frame.
    chosen: Vec<Option<usize>>,
    /// They are all there, and no entry has moved since.
    settled: bool,
}

#[derive(Debug)]
struct Entry<S: Pooled> {
    /// Never given twice: the older of two equal fits is taken.
    id: u64,
    shape: S,
    bytes: u64,
    object: S::Object,
    tenant: u64,
    /// The frame that used it last.
    used: u64,
}

impl<S: Pooled> Pool<S> {
    /// An empty pool.
    pub fn new(limits: Limits) -> Self {
        let (recent, counts) = ([0; RECENT], PoolCounts::default());
        Self { entries: Vec::new(), next: 0, frame: 0, limits, recent, counts, chosen: Vec::new(), settled: false }
    }

    /// Hits, creations and evictions since the pool was made, and what it holds now.
    pub fn counts(&self) -> PoolCounts {
        PoolCounts { objects: self.entries.len() as u64, bytes: self.bytes(|_| true), ..self.counts }
    }

    fn bytes(&self, counted: impl Fn(&Entry<S>) -> bool) -> u64 {
        self.entries.iter().filter(|e| counted(e)).map(|e| e.bytes).sum()
    }

    /// Begins a frame: everything is idle again.
    pub fn begin_frame(&mut self) {
        self.frame += 1;
    }

    /// Serves all requests of a frame, in order; no object serves two of them. `label` gives the name of a request, for
    /// debuggers and errors, when its object has to be made.
    ///
    /// # Errors
    /// When the device offers no such object as one of them asks for.
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
        // Requests whose earlier object still fits come first, so that no other request takes it.
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

    /// Whether the requests of the frame before would be served as they were.
    pub fn is_settled(&self) -> bool {
        self.settled
    }

    /// Serves the requests of the frame before as they were. Only where the pool [is settled](Pool::is_settled).
    pub fn acquire_again(&mut self) {
        for index in self.chosen.iter().flatten() {
            self.entries[*index].used = self.frame;
        }
        self.counts.hits += self.chosen.len() as u64;
    }

    /// Marks the best idle entry that fits as used.
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

    /// Ends a frame: gives up what is too old or beyond the budget, and calls `gone` for each.
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

    /// Gives up everything that this frame did not use, and calls `gone` for each.
    pub fn trim(&mut self, gone: impl FnMut(&S::Object)) {
        let frame = self.frame;
        self.retain(|e| e.used == frame, gone);
    }

    /// Gives up everything that this frame used: after the device refused something, nothing is known of it.
    pub fn forget_frame(&mut self, gone: impl FnMut(&S::Object)) {
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
    use crate::device::gpu::{Gpu, OpenError};

    /// A stand-in: size in the higher digits, offered uses in the last one.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    struct Toy(u32);

    impl Pooled for Toy {
        /// How many were made before it.
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

        /// One frame of (tenant, shape); returns the ids.
        fn frame(&mut self, asked: &[(u64, u32)]) -> Vec<u64> {
            self.pool.begin_frame();
            let requests: Vec<_> = asked.iter().map(|(t, s)| Request { shape: Toy(*s), tenant: *t }).collect();
            let mut out = Vec::new();
            // A toy is as many as there were before it: its label's length.
            let labels = "1".repeat(64);
            let made = std::cell::Cell::new(self.pool.counts.created as usize);
            let label = |_: usize| &labels[..made.replace(made.get() + 1)];
            let served = self.pool.acquire(&self.gpu, &requests, label, &mut out);
            assert!(served.is_ok(), "a toy is always made");
            self.pool.evict(|_| ());
            out
        }
    }

    #[test]
    fn tenants_keep_their_objects_whatever_comes_before_them() -> Result<(), OpenError> {
        let mut bench = Bench::new(30, 9)?;
        assert_eq!(bench.frame(&[(7, 40), (8, 40)]), [0, 1]);
        assert_eq!(bench.frame(&[(8, 40), (7, 40)]), [1, 0], "the order of requests does not matter");
        assert_eq!(bench.frame(&[(9, 40), (8, 40)]), [0, 1], "a newcomer takes what nobody keeps");
        let PoolCounts { hits, created, evicted, objects, bytes, .. } = bench.pool.counts();
        assert_eq!((hits, created, evicted, objects, bytes), (4, 2, 0, 2, 8));
        Ok(())
    }

    #[test]
    fn the_best_fit_is_taken_and_no_object_twice() -> Result<(), OpenError> {
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
        assert_eq!(bench.frame(&[(1, 90)]), [2], "ids are never given twice");
        Ok(())
    }

    /// A drag: each frame asks for two objects of a size that no other frame has. Without a budget, all of the last 30 stay.
    #[test]
    fn sizes_that_a_drag_leaves_behind_go_once_the_budget_is_reached() -> Result<(), OpenError> {
        let mut bench = Bench::new(30, 3)?;
        for size in 100..120 {
            let ids = bench.frame(&[(1, size * 10), (2, size * 10 + 1)]);
            let PoolCounts { bytes, used_bytes, budget_bytes, peak_bytes, .. } = bench.pool.counts();
            assert_eq!(used_bytes, u64::from(size) * 2);
            assert_eq!(budget_bytes, used_bytes * 3);
            assert!(bytes <= budget_bytes && peak_bytes >= bytes, "{bytes} of {budget_bytes}");
            if size > 102 {
                // Three frames' worth, of which the first ends below the budget.
                assert_eq!(bytes, u64::from(size + size - 1) * 2 + u64::from(size - 2) * 2, "size {size}");
                assert_eq!(ids[0], u64::from(size - 100) * 2);
            }
        }
        assert_eq!(bench.frame(&[(1, 1180), (2, 1181)]), [36, 37], "the size before is still there");
        bench.pool.trim(|_| ());
        assert_eq!(bench.pool.counts().bytes, 236, "what the last frame used");
        Ok(())
    }

    #[test]
    fn two_graphs_that_take_turns_keep_their_objects_whatever_the_budget() -> Result<(), OpenError> {
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
