//! Physical textures and buffers that are used again: within a frame by the plan's slots, and from frame to frame.
//!
//! A request is served by the object that served the same tenant last (so views and bind groups made for it stay good),
//! else by the idle object that covers it with the least waste, else by a new one. An object that no frame asked for during
//! `max_age` frames is given up; until then a resize back, an odd size or a toggled effect finds it again.

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
}

/// Objects of one kind. See the [module](self).
#[derive(Debug)]
pub struct Pool<S: Pooled> {
    entries: Vec<Entry<S>>,
    next: u64,
    frame: u64,
    max_age: u64,
    counts: PoolCounts,
    /// The entry of each request of the frame; kept for its memory.
    chosen: Vec<Option<usize>>,
}

#[derive(Debug)]
struct Entry<S: Pooled> {
    /// Never given twice: the older of two equal fits is taken.
    id: u64,
    shape: S,
    object: S::Object,
    tenant: u64,
    /// The frame that used it last.
    used: u64,
}

impl<S: Pooled> Pool<S> {
    /// An empty pool whose objects are given up after `max_age` frames without use.
    pub fn new(max_age: u64) -> Self {
        Self { entries: Vec::new(), next: 0, frame: 0, max_age, counts: PoolCounts::default(), chosen: Vec::new() }
    }

    /// Hits, creations and evictions since the pool was made, and what it holds now.
    pub fn counts(&self) -> PoolCounts {
        let bytes = self.entries.iter().map(|e| e.shape.bytes()).sum();
        PoolCounts { objects: self.entries.len() as u64, bytes, ..self.counts }
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
        let mut chosen = std::mem::take(&mut self.chosen);
        chosen.clear();
        // Requests whose earlier object still fits come first, so that no other request takes it.
        chosen.extend(requests.iter().map(|r| self.take(r, |e| e.tenant == r.tenant && e.shape.serves(&r.shape))));
        for (at, (request, index)) in requests.iter().zip(&chosen).enumerate() {
            let index = match index.or_else(|| self.take(request, |e| e.shape.serves(&request.shape))) {
                Some(index) => index,
                None => self.create(gpu, request, label(at))?,
            };
            out.push(self.entries[index].object.clone());
        }
        self.chosen = chosen;
        Ok(())
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
        self.entries.push(Entry { id, shape, object, tenant, used: self.frame });
        Ok(self.entries.len() - 1)
    }

    /// Gives up what has not been used for too long, and calls `gone` for each.
    pub fn evict(&mut self, gone: impl FnMut(&S::Object)) {
        let (frame, max_age) = (self.frame, self.max_age);
        self.retain(|e| frame - e.used <= max_age, gone);
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
        self.counts.evicted += (before - self.entries.len()) as u64;
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
        fn new(max_age: u64) -> Result<Self, OpenError> {
            Ok(Self { gpu: Gpu::noop()?, pool: Pool::new(max_age) })
        }

        /// One frame of (tenant, shape); returns the ids.
        fn frame(&mut self, asked: &[(u64, u32)]) -> Vec<u64> {
            self.pool.begin_frame();
            let requests: Vec<_> = asked.iter().map(|(t, s)| Request { shape: Toy(*s), tenant: *t }).collect();
            let mut out = Vec::new();
            // A toy is as many as there were before it: its label's length.
            let labels = ["", "1", "12", "123"];
            let made = std::cell::Cell::new(self.pool.counts.created as usize);
            let label = |_: usize| {
                let label = labels[made.get()];
                made.set(made.get() + 1);
                label
            };
            let served = self.pool.acquire(&self.gpu, &requests, label, &mut out);
            assert!(served.is_ok(), "a toy is always made");
            self.pool.evict(|_| ());
            out
        }
    }

    #[test]
    fn tenants_keep_their_objects_whatever_comes_before_them() -> Result<(), OpenError> {
        let mut bench = Bench::new(30)?;
        assert_eq!(bench.frame(&[(7, 40), (8, 40)]), [0, 1]);
        assert_eq!(bench.frame(&[(8, 40), (7, 40)]), [1, 0], "the order of requests does not matter");
        assert_eq!(bench.frame(&[(9, 40), (8, 40)]), [0, 1], "a newcomer takes what nobody keeps");
        assert_eq!(bench.pool.counts(), PoolCounts { hits: 4, created: 2, evicted: 0, objects: 2, bytes: 8 });
        Ok(())
    }

    #[test]
    fn the_best_fit_is_taken_and_no_object_twice() -> Result<(), OpenError> {
        let mut bench = Bench::new(30)?;
        assert_eq!(bench.frame(&[(1, 45), (2, 42)]), [0, 1]);
        assert_eq!(bench.frame(&[(3, 41)]), [1], "42 wastes less than 45");
        assert_eq!(bench.frame(&[(4, 41), (5, 41), (6, 41)]), [1, 0, 2]);
        Ok(())
    }

    #[test]
    fn age_evicts_and_a_resize_back_finds_the_old_object() -> Result<(), OpenError> {
        let mut bench = Bench::new(3)?;
        assert_eq!(bench.frame(&[(1, 40)]), [0]);
        assert_eq!(bench.frame(&[(1, 90)]), [1]);
        assert_eq!(bench.frame(&[(1, 40)]), [0]);
        for _ in 0..3 {
            assert_eq!(bench.frame(&[(1, 40)]), [0]);
        }
        assert_eq!(bench.pool.counts(), PoolCounts { hits: 4, created: 2, evicted: 1, objects: 1, bytes: 4 });
        assert_eq!(bench.frame(&[(1, 90)]), [2], "ids are never given twice");
        Ok(())
    }
}
