//! Instances with a known optimum: a rectangle of time and bytes that is cut into pieces.
//!
//! The pieces fill the rectangle, so its height is a lower bound and can be reached. If pieces are left out
//! ([`Planted::left_out_percent`]), the height can still be reached; the published "challenging" instances look like
//! that.
//!
//! ```
//! use framegraph_pack::planted::{Cuts, Planted};
//!
//! let items = Planted { items: 40, ..Planted::square(Cuts::Even) }.items(7);
//! let area: u64 = items.iter().map(|item| item.size * u64::from(item.upper - item.lower)).sum();
//! assert_eq!((items.len(), area), (40, 1024 * 1024));
//! ```

use crate::Interval;
use crate::entropy::Entropy;

/// Direction and pattern of the cuts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cuts {
    /// Mostly through the longer side of a piece. Sides are measured relative to those of the rectangle.
    Even,
    /// Mostly between addresses: long lifetimes and small sizes.
    Long,
    /// Mostly between times: short lifetimes and large sizes.
    Brief,
    /// A third of the pieces are cut into five around a middle one, which no straight cut can separate.
    Pinwheels,
    /// Into rows, each cut into five at different times: a fifth of the pieces is live at any time.
    Rows,
}

impl Cuts {
    /// All variants.
    pub const ALL: [Self; 5] = [Self::Even, Self::Long, Self::Brief, Self::Pinwheels, Self::Rows];

    /// Name of the variant in tables.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::Long => "long",
            Self::Brief => "brief",
            Self::Pinwheels => "pinwheels",
            Self::Rows => "rows",
        }
    }
}

/// Parameters of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Planted {
    /// Number of pieces, unless the rectangle is too small.
    pub items: usize,
    /// Width of the rectangle: lifetimes are within `0..times`. From 1 to 65536.
    pub times: u32,
    /// Height of the rectangle in units. From 1 to 65536.
    pub units: u32,
    /// Bytes per unit, a power of two; every item is aligned to it.
    pub unit_bytes: u64,
    /// Direction and pattern of the cuts.
    pub cuts: Cuts,
    /// Percentage of pieces that are left out. Above 0, the height is not a lower bound.
    pub left_out_percent: u32,
}

/// A piece: times and units.
#[derive(Clone, Copy)]
struct Piece {
    time: [u32; 2],
    unit: [u32; 2],
}

impl Piece {
    const fn times(self) -> u32 {
        self.time[1] - self.time[0]
    }

    const fn units(self) -> u32 {
        self.unit[1] - self.unit[0]
    }
}

impl Planted {
    /// Returns the parameters of 1000 pieces of a square of 1024 times and 1024 units of one byte.
    pub const fn square(cuts: Cuts) -> Self {
        Self { items: 1000, times: 1024, units: 1024, unit_bytes: 1, cuts, left_out_percent: 0 }
    }

    /// The minimum top if no piece is left out, in bytes.
    pub const fn height_bytes(&self) -> u64 {
        self.units as u64 * self.unit_bytes
    }

    /// Returns the items of one seed, in random order.
    pub fn items(&self, seed: u64) -> Vec<Interval> {
        let entropy = &mut Entropy::seeded(seed);
        let mut pieces = vec![Piece { time: [0, self.times], unit: [0, self.units] }];
        let mut failures = 0;
        while pieces.len() < self.items && failures < 64 * self.items {
            let before = pieces.len();
            self.cut(entropy, &mut pieces);
            failures += usize::from(pieces.len() == before);
        }
        for last in (1..pieces.len()).rev() {
            pieces.swap(last, entropy.below(last as u32 + 1) as usize);
        }
        pieces.retain(|_| entropy.below(100) >= self.left_out_percent);
        let item = |piece: &Piece| Interval {
            lower: piece.time[0],
            upper: piece.time[1],
            size: u64::from(piece.units()) * self.unit_bytes,
            align: self.unit_bytes,
        };
        pieces.iter().map(item).collect()
    }

    /// Cuts the largest of a few random pieces, unless it is too small.
    fn cut(&self, entropy: &mut Entropy<'_>, pieces: &mut Vec<Piece>) {
        let area = |k: usize| u64::from(pieces[k].times()) * u64::from(pieces[k].units());
        let drawn = [(); 4].map(|()| entropy.below(pieces.len() as u32) as usize);
        let Some(k) = drawn.into_iter().max_by_key(|&k| area(k)) else { return };
        let piece = pieces[k];
        if self.cuts == Cuts::Pinwheels
            && self.items - pieces.len() >= 4
            && piece.times().min(piece.units()) >= 3
            && entropy.below(3) == 0
        {
            pieces.swap_remove(k);
            pieces.extend(pinwheel(entropy, piece));
            return;
        }
        // Sides relative to the rectangle. The probability of a cut between times is that of the longer side.
        let width = u64::from(piece.times()) * u64::from(self.units);
        let height = u64::from(piece.units()) * u64::from(self.times);
        let (width, height) = match self.cuts {
            Cuts::Long => (width, 8 * height),
            Cuts::Brief => (8 * width, height),
            Cuts::Rows if 5 * pieces.len() < self.items => (0, 1),
            Cuts::Rows => (1, 0),
            Cuts::Even | Cuts::Pinwheels if entropy.below(3) == 0 => (1, 1),
            Cuts::Even | Cuts::Pinwheels => (width, height),
        };
        let between_times = u64::from(entropy.below(1 << 16)) * (width + height) < width << 16;
        let side = if between_times { piece.time } else { piece.unit };
        if side[1] - side[0] < 2 {
            return;
        }
        let at = side[0] + 1 + entropy.below(side[1] - side[0] - 1);
        let (mut low, mut high) = (piece, piece);
        if between_times {
            (low.time[1], high.time[0]) = (at, at);
        } else {
            (low.unit[1], high.unit[0]) = (at, at);
        }
        pieces[k] = low;
        pieces.push(high);
    }
}

/// Cuts a piece into five: four in a cycle around a middle one.
fn pinwheel(entropy: &mut Entropy<'_>, piece: Piece) -> [Piece; 5] {
    let mut between = |[low, high]: [u32; 2]| {
        let first = low + 1 + entropy.below(high - low - 2);
        [first, first + 1 + entropy.below(high - first - 1)]
    };
    let ([t, u], [a, b]) = (between(piece.time), between(piece.unit));
    let ([t0, t1], [a0, a1]) = (piece.time, piece.unit);
    let pieces = [([t0, u], [a0, a]), ([u, t1], [a0, b]), ([t, t1], [b, a1]), ([t0, t], [a, a1]), ([t, u], [a, b])];
    let mirrored = entropy.below(2) == 0;
    pieces.map(|(time, unit)| {
        let unit = if mirrored { [a0 + a1 - unit[1], a0 + a1 - unit[0]] } else { unit };
        Piece { time, unit }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_fill_the_rectangle_at_every_time() {
        for cuts in Cuts::ALL {
            for (times, units, unit_bytes) in [(1024, 1024, 1), (16, 4096, 256), (40000, 60, 4096)] {
                let plan = Planted { items: 300, times, units, unit_bytes, ..Planted::square(cuts) };
                let items = plan.items(3);
                assert_eq!(items.len(), 300, "{plan:?}");
                let mut change = std::collections::BTreeMap::new();
                for item in &items {
                    *change.entry(item.lower).or_insert(0) += item.size as i64;
                    *change.entry(item.upper).or_insert(0) -= item.size as i64;
                }
                let sums = change.values().scan(0, |live, change| {
                    *live += change;
                    Some(*live as u64)
                });
                let live: Vec<_> = sums.collect();
                let (end, full) = live.split_last().expect("the instance has items");
                assert!(*end == 0 && full.iter().all(|&live| live == plan.height_bytes()), "{plan:?}: {live:?}");
            }
        }
    }

    #[test]
    fn left_out_pieces_leave_less_than_the_height() {
        let plan = Planted { left_out_percent: 20, ..Planted::square(Cuts::Even) };
        let area: u64 = plan.items(1).iter().map(|i| i.size * u64::from(i.upper - i.lower)).sum();
        assert!((700_000..950_000).contains(&area), "{area}");
    }
}
