//! Typed `u32` ids and spans of flat arrays.
//!
//! Graphs and plans consist of plain arrays. Each id type indexes exactly one of them, so that, for example, a declared
//! pass and an executed step cannot be confused.

use std::fmt;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident, $prefix:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(u32);

        impl $name {
            /// The id of no element: `u32::MAX`.
            pub const NONE: Self = Self(u32::MAX);

            /// Returns the id of the element at `index`; `None` if `index` is `u32::MAX` or more.
            pub const fn new(index: usize) -> Option<Self> {
                if index < u32::MAX as usize { Some(Self(index as u32)) } else { None }
            }

            /// Returns the id of the element at `index`, for indices into arrays of this crate.
            ///
            /// # Panics
            /// Panics if `index` is `u32::MAX` or more.
            #[inline]
            pub const fn at(index: usize) -> Self {
                assert!(index < u32::MAX as usize, "more than 2^32 - 2 elements in one table");
                Self(index as u32)
            }

            /// Returns the id without checking `index`. The caller checks the length of the array later, once for many
            /// ids.
            #[inline]
            pub(crate) const fn unchecked(index: usize) -> Self {
                Self(index as u32)
            }

            /// The position in the array that this id indexes.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// Returns `true` for [`Self::NONE`].
            #[inline]
            pub const fn is_none(self) -> bool {
                self.0 == u32::MAX
            }

            /// Returns `None` for [`Self::NONE`], otherwise the id.
            #[inline]
            pub const fn some(self) -> Option<Self> {
                if self.is_none() { None } else { Some(self) }
            }
        }

        impl Default for $name {
            /// Returns [`Self::NONE`].
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
    /// A declared resource: an index into [`Graph::resources`](crate::graph::Tables::resources).
    ResourceId, "r"
);
id!(
    /// A version of a resource: an index into [`Graph::versions`](crate::graph::Tables::versions).
    VersionId, "v"
);
id!(
    /// An access of a pass to a resource: an index into [`Graph::accesses`](crate::graph::Tables::accesses).
    AccessId, "a"
);
id!(
    /// A range of buffer bytes: an index into [`Graph::byte_ranges`](crate::graph::Tables::byte_ranges).
    BytesId, "b"
);
id!(
    /// An executed step of one or more passes: an index into [`Plan::steps`](crate::Plan::steps).
    StepId, "s"
);
id!(
    /// A physical texture or buffer of the pool: an index into [`Plan::slots`](crate::Plan::slots).
    SlotId, "m"
);

/// A range of consecutive elements of a flat array.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Span {
    /// Index of the first element.
    pub start: u32,
    /// Number of elements.
    pub len: u32,
}

impl Span {
    /// Returns the span of `start..end`.
    #[inline]
    pub const fn new(start: usize, end: usize) -> Self {
        Self { start: start as u32, len: (end - start) as u32 }
    }

    /// Returns the indices of this span.
    #[inline]
    pub const fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.start as usize + self.len as usize
    }

    /// Returns the elements of `array` in this span.
    ///
    /// # Panics
    /// Panics if the span exceeds the array.
    #[inline]
    pub fn of<T>(self, array: &[T]) -> &[T] {
        &array[self.range()]
    }

    /// Returns `true` if the span has no elements.
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
