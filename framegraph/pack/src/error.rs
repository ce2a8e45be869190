//! Instances that cannot be packed.

use std::fmt;

/// An instance that cannot be packed; items are named by their index.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum PackError {
    /// An item is never alive.
    EmptyLifetime {
        /// Which.
        item: usize,
        /// First time of its lifetime.
        lower: u32,
        /// First time after it; not more than `lower`.
        upper: u32,
    },
    /// An item's alignment is no power of two.
    Alignment {
        /// Which.
        item: usize,
        /// Its alignment in bytes.
        align: u64,
    },
    /// Items that follow each other without a break in time need offsets beyond 2^63.
    TooLarge {
        /// The item with which the sum gets there.
        item: usize,
    },
    /// There is not one previous offset for each item.
    PreviousLength {
        /// How many items there are.
        items: usize,
        /// How many offsets.
        previous: usize,
    },
    /// There are more items than 2^32 - 2.
    TooMany {
        /// How many.
        items: usize,
    },
}

impl fmt::Display for PackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EmptyLifetime { item, lower, upper } => {
                write!(
                    f,
                    "item {item} is never alive: its lifetime is [{lower}, {upper}); make upper larger than lower"
                )
            }
            Self::Alignment { item, align } => {
                write!(f, "item {item} has alignment {align}; use a power of two, 1 for none")
            }
            Self::TooLarge { item } => {
                write!(f, "up to item {item} sizes and alignments sum to more than 2^63 bytes; no heap is that large")
            }
            Self::PreviousLength { items, previous } => {
                write!(
                    f,
                    "{previous} previous offsets were given for {items} items; give one for each, None where there is none"
                )
            }
            Self::TooMany { items } => write!(f, "{items} items are too many; the limit is 2^32 - 2"),
        }
    }
}

/// The sentence, since that is what an `unwrap` shows.
impl fmt::Debug for PackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for PackError {}
