//! First fit in the order of birth: an allocator run over time, for instances too dense to look at pairs of items.
//!
//! Items are born and die as time passes; each takes the lowest gap that holds it among those alive (Robson 1974
//! bounds what any such allocator wastes). It knows nothing of the future, so it is seldom the best, but its time is
//! about `n sqrt(n)` and its memory linear however many items are alive together.
//!
//! The live items are kept by offset in chunks, each with the width of its widest gap, so that most chunks are passed
//! over.

use super::problem::{Problem, align_up};

/// Items a chunk can hold.
const CHUNK: usize = 256;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Sweep {
    births: Vec<(u32, u64, u32)>,
    deaths: Vec<(u32, u32)>,
    /// Offset and end of live items, `CHUNK` slots a chunk; each chunk's items are ascending.
    slots: Vec<(u64, u64)>,
    chunks: Vec<Chunk>,
    /// Chunks in use, by offset, and those not in use.
    sequence: Vec<u32>,
    spare: Vec<u32>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Chunk {
    len: usize,
    /// First offset, the end of the last item, and the widest gap between two items of the chunk.
    first: u64,
    end: u64,
    widest: u64,
}

impl Sweep {
    /// Packs all items. Returns the top.
    pub fn pack(&mut self, problem: &Problem, offsets: &mut [u64]) -> u64 {
        self.births.clear();
        self.deaths.clear();
        for i in 0..problem.len() {
            self.births.push((problem.lo[i], !problem.size[i], i as u32));
            self.deaths.push((problem.hi[i], i as u32));
        }
        self.births.sort_unstable();
        self.deaths.sort_unstable();
        self.slots.clear();
        self.chunks.clear();
        self.sequence.clear();
        self.spare.clear();
        let (mut top, mut died) = (0, 0);
        for k in 0..self.births.len() {
            let (section, _, i) = self.births[k];
            while let Some(&(end, dead)) = self.deaths.get(died)
                && end <= section
            {
                self.remove(offsets[dead as usize]);
                died += 1;
            }
            let i = i as usize;
            offsets[i] = self.insert(problem.size[i], problem.align[i]);
            top = top.max(offsets[i] + problem.size[i]);
        }
        top
    }

    /// Takes the lowest gap. Returns its offset.
    fn insert(&mut self, size: u64, align: u64) -> u64 {
        let mut roof = 0;
        for at in 0..self.sequence.len() {
            let chunk = self.chunks[self.sequence[at] as usize];
            let before = chunk.first - roof;
            if chunk.widest.max(before) >= size {
                let base = self.sequence[at] as usize * CHUNK;
                for k in 0..chunk.len {
                    let start = align_up(roof, align);
                    if start + size <= self.slots[base + k].0 {
                        self.put(at, k, (start, start + size));
                        return start;
                    }
                    roof = self.slots[base + k].1;
                }
            }
            roof = chunk.end;
        }
        let start = align_up(roof, align);
        match self.sequence.last() {
            Some(&last) => self.put(self.sequence.len() - 1, self.chunks[last as usize].len, (start, start + size)),
            None => {
                let chunk = self.fresh();
                self.sequence.push(chunk);
                self.put(0, 0, (start, start + size));
            }
        }
        start
    }

    /// Inserts a live item before slot `k` of the chunk at `at` in the sequence, splitting the chunk if it is full.
    fn put(&mut self, mut at: usize, mut k: usize, item: (u64, u64)) {
        let mut c = self.sequence[at] as usize;
        if self.chunks[c].len == CHUNK {
            let upper = self.fresh() as usize;
            let half = CHUNK / 2;
            self.slots.copy_within(c * CHUNK + half..(c + 1) * CHUNK, upper * CHUNK);
            (self.chunks[c].len, self.chunks[upper].len) = (half, CHUNK - half);
            self.sequence.insert(at + 1, upper as u32);
            self.summarize(c);
            self.summarize(upper);
            if k > half {
                (at, k) = (at + 1, k - half);
                c = self.sequence[at] as usize;
            }
        }
        let (base, len) = (c * CHUNK, self.chunks[c].len);
        self.slots.copy_within(base + k..base + len, base + k + 1);
        self.slots[base + k] = item;
        self.chunks[c].len += 1;
        self.summarize(c);
    }

    /// Frees the live item at `offset`.
    fn remove(&mut self, offset: u64) {
        let after = self.sequence.partition_point(|&c| self.chunks[c as usize].first <= offset);
        let c = self.sequence[after - 1] as usize;
        let (base, len) = (c * CHUNK, self.chunks[c].len);
        let k = self.slots[base..base + len].partition_point(|slot| slot.0 < offset);
        self.slots.copy_within(base + k + 1..base + len, base + k);
        self.chunks[c].len -= 1;
        if len == 1 {
            self.sequence.remove(after - 1);
            self.spare.push(c as u32);
        } else {
            self.summarize(c);
        }
    }

    fn fresh(&mut self) -> u32 {
        self.spare.pop().unwrap_or_else(|| {
            self.chunks.push(Chunk::default());
            self.slots.resize(self.chunks.len() * CHUNK, (0, 0));
            self.chunks.len() as u32 - 1
        })
    }

    fn summarize(&mut self, c: usize) {
        let len = self.chunks[c].len;
        let slots = &self.slots[c * CHUNK..c * CHUNK + len];
        let widest = slots.windows(2).map(|pair| pair[1].0 - pair[0].1).max().unwrap_or(0);
        self.chunks[c] = Chunk { len, first: slots[0].0, end: slots[len - 1].1, widest };
    }
}
