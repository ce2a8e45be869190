//! Errors of invalid instances.

use std::fmt;

/// Error of an instance; items are identified by their index.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum PackError {
    /// A lifetime is empty.
    EmptyLifetime {
        /// Index of the item.
        item: usize,
        /// Start of the lifetime.
        lower: u32,
        /// End of the lifetime; not above `lower`.
        upper: u32,
    },
    /// An alignment is not a power of two.
    Alignment {
        /// Index of the item.
        item: usize,
        /// Alignment in bytes.
        align: u64,
    },
    /// Items with contiguous lifetimes may need offsets beyond 2^63.
    TooLarge {
        /// The item at which the sum exceeds the limit.
        item: usize,
    },
    /// The number of previous offsets differs from the number of items.
    PreviousLength {
        /// Number of items.
        items: usize,
        /// Number of previous offsets.
        previous: usize,
    },
    /// The instance has more than 2^32 - 2 items.
    TooMany {
        /// Number of items.
        items: usize,
    },
}

impl fmt::Display for PackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EmptyLifetime { item, lower, upper } => {
                write!(f, "item {item} has an empty lifetime, [{lower}, {upper}); use an upper above lower")
            }
            Self::Alignment { item, align } => {
                write!(f, "item {item} has an alignment of {align}; use a power of two, 1 for none")
            }
            Self::TooLarge { item } => {
                write!(f, "sizes and alignments up to item {item} exceed 2^63 bytes; use smaller sizes")
            }
            Self::PreviousLength { items, previous } => {
                write!(f, "{previous} previous offsets for {items} items; pass one for each, or None")
            }
            Self::TooMany { items } => write!(f, "{items} items; the limit is 2^32 - 2"),
        }
    }
}

/// Shows the message, because `unwrap` prints this.
impl fmt::Debug for PackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for PackError {}
