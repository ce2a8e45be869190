//! Checked `u32` identifiers and spans into flat arrays.
//!
//! Every table of the graph and of the plan is a plain array; an id is an index into exactly one of them, so two
//! coordinate systems (a declared pass, an executed step) are two types and cannot be mixed up.

use std::fmt;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident, $prefix:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(u32);

        impl $name {
            /// The id that names nothing: the largest `u32`, which no array can reach.
            pub const NONE: Self = Self(u32::MAX);

            /// The id of the element at `index`; `None` when `index` does not fit in 32 bits less one.
            pub const fn new(index: usize) -> Option<Self> {
                if index < u32::MAX as usize { Some(Self(index as u32)) } else { None }
            }

            /// The id of the element at `index`, for indices that come from an array of this crate.
            ///
            /// # Panics
            /// When the array outgrew 2³²−1 elements: no machine this crate runs on can hold such a graph.
            #[inline]
            pub const fn at(index: usize) -> Self {
                assert!(index < u32::MAX as usize, "more than 2^32 - 2 elements in one table");
                Self(index as u32)
            }

            /// As `at`, where the length of the array is checked later and at once for many ids.
            #[inline]
            pub(crate) const fn unchecked(index: usize) -> Self {
                Self(index as u32)
            }

            /// The position in the array that this id indexes.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// Whether this is [`Self::NONE`].
            #[inline]
            pub const fn is_none(self) -> bool {
                self.0 == u32::MAX
            }

            /// `None` for [`Self::NONE`], the id itself otherwise.
            #[inline]
            pub const fn some(self) -> Option<Self> {
                if self.is_none() { None } else { Some(self) }
            }
        }

        impl Default for $name {
            /// [`Self::NONE`].
            fn default() -> Self {
                Self::NONE
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                if self.is_none() { f.write_str(concat!($prefix, "-")) } else { write!(f, concat!($prefix, "{}"), self.0) }
            }
        }
    };
}

id!(
    /// A declared pass: an index into [`Graph::passes`](crate::graph::Tables::passes).
    PassId, "p"
);
id!(
    /// A declared (virtual) resource: an index into [`Graph::resources`](crate::graph::Tables::resources).
    ResourceId, "r"
);
id!(
    /// One version of one resource: what a handle points at.
    VersionId, "v"
);
id!(
    /// One access of one pass to one resource: an index into [`Graph::accesses`](crate::graph::Tables::accesses).
    AccessId, "a"
);
id!(
    /// Bytes of a buffer that an access names: an index into [`Graph::byte_ranges`](crate::graph::Tables::byte_ranges).
    BytesId, "b"
);
id!(
    /// An executed step (one or more merged passes): an index into [`Plan::steps`](crate::Plan::steps).
    StepId, "s"
);
id!(
    /// A physical texture or buffer of the pool: an index into [`Plan::slots`](crate::Plan::slots).
    SlotId, "m"
);

/// A run of consecutive elements of a flat array.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Span {
    /// Index of the first element.
    pub start: u32,
    /// How many elements.
    pub len: u32,
}

impl Span {
    /// The span of `start..end`.
    #[inline]
    pub const fn new(start: usize, end: usize) -> Self {
        Self { start: start as u32, len: (end - start) as u32 }
    }

    /// The indices of this span.
    #[inline]
    pub const fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.start as usize + self.len as usize
    }

    /// The elements of `array` that this span names.
    ///
    /// # Panics
    /// When the span belongs to another array.
    #[inline]
    pub fn of<T>(self, array: &[T]) -> &[T] {
        &array[self.range()]
    }

    /// Whether the span has no element.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.len == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_checked() {
        assert_eq!(PassId::new(7).map(PassId::index), Some(7));
        assert_eq!(PassId::new(u32::MAX as usize), None);
        assert!(PassId::NONE.is_none() && PassId::NONE.some().is_none());
        assert_eq!(format!("{:?} {:?}", PassId::at(3), StepId::NONE), "p3 s-");
    }

    #[test]
    fn a_span_names_its_elements() {
        assert_eq!(Span::new(1, 3).of(&[1, 2, 3, 4]), [2, 3]);
        assert!(Span::default().is_empty());
    }
}
