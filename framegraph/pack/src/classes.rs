//! Shape classes for pools, in which only resources of equal shape share memory. Numbers shapes in the order of their
//! first use, and stores the most recently freed slot of each. Slots are numbered and linked by the caller.

/// No slot or class.
pub const NIL: u32 = u32::MAX;

/// One shape.
#[derive(Clone, Copy, Debug)]
struct Class {
    size: [u32; 2],
    layout: u64,
    /// The most recently freed slot; [`NIL`] if there is none.
    free: u32,
}

/// A hash table of shapes.
///
/// ```
/// use framegraph_pack::classes::{Classes, NIL};
///
/// let mut classes = Classes::default();
/// classes.clear(); // Before the first shape, too.
/// let shadow_map = classes.of([1024, 1024], 7);
/// assert_eq!((shadow_map, classes.of([1024, 1024], 7), classes.of([512, 512], 7)), (0, 0, 1));
/// assert_eq!(classes.free(shadow_map).copied(), Some(NIL)); // No slot of this shape is free.
/// ```
#[derive(Debug, Default)]
pub struct Classes {
    /// Open addressing table of class numbers, at most a quarter full; [`NIL`] for empty entries.
    table: Vec<u32>,
    /// Number of bits by which a hash is shifted to get a table index.
    shift: u32,
    classes: Vec<Class>,
}

impl Classes {
    /// Minimum length of the table. All lengths are powers of two.
    const MIN_LEN: usize = 64;

    /// Removes all shapes. The table keeps the length they required.
    pub fn clear(&mut self) {
        let enough = (self.classes.len() * 4).next_power_of_two().max(Self::MIN_LEN);
        self.table.truncate(enough);
        self.table.fill(NIL);
        if self.table.is_empty() {
            self.table.resize(Self::MIN_LEN, NIL);
        }
        self.shift = self.table.len().leading_zeros() + 1;
        self.classes.clear();
    }

    /// Returns the number of a shape, counted from 0. A shape consists of a size in the caller's units and all its
    /// other properties.
    #[inline]
    pub fn of(&mut self, size: [u32; 2], layout: u64) -> u32 {
        let mut at = self.place(size, layout);
        while let Some(class) = self.classes.get(self.table[at] as usize) {
            if (class.size, class.layout) == (size, layout) {
                return self.table[at];
            }
            at = (at + 1) & (self.table.len() - 1);
        }
        self.add(size, layout, at)
    }

    /// Returns a mutable reference to the most recently freed slot of a shape; `None` for [`NIL`].
    #[inline]
    pub fn free(&mut self, class: u32) -> Option<&mut u32> {
        self.classes.get_mut(class as usize).map(|class| &mut class.free)
    }

    /// Returns the first table index to probe for a shape.
    #[inline]
    fn place(&self, size: [u32; 2], layout: u64) -> usize {
        let size = u64::from(size[0]) | u64::from(size[1]) << 32;
        let mixed = (size ^ layout.rotate_left(29)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        (mixed >> self.shift) as usize
    }

    /// Adds a shape, at the given table index if the table need not grow.
    #[inline]
    fn add(&mut self, size: [u32; 2], layout: u64, place: usize) -> u32 {
        let number = self.classes.len();
        self.classes.push(Class { size, layout, free: NIL });
        if self.table.len() < (number + 1) * 4 {
            self.grow();
        } else {
            self.table[place] = number as u32;
        }
        number as u32
    }

    /// Grows the table to twice the required length.
    #[cold]
    fn grow(&mut self) {
        self.table.clear();
        self.table.resize((self.classes.len() * 8).next_power_of_two(), NIL);
        self.shift = self.table.len().leading_zeros() + 1;
        for (number, class) in self.classes.iter().enumerate() {
            let mut at = self.place(class.size, class.layout);
            while self.table[at] != NIL {
                at = (at + 1) & (self.table.len() - 1);
            }
            self.table[at] = number as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_keep_their_numbers_while_the_table_grows() {
        let mut classes = Classes::default();
        let mut before = 0;
        for (round, count) in [1000_u64, 3, 3, 400].into_iter().enumerate() {
            classes.clear();
            for size in 0..count as u32 {
                assert_eq!(classes.of([256, size], 8), size, "round {round}");
            }
            for size in (0..count as u32).rev() {
                assert_eq!(classes.of([256, size], 8), size);
            }
            assert_eq!(classes.of([256, 0], 9), count as u32);
            let most = 64.max(before.max(count) * 16);
            assert!(classes.table.len() as u64 <= most, "round {round}: {} entries", classes.table.len());
            before = count;
        }
    }
}
