//! Typed indices: a [`MeshId`](crate::MeshId) cannot be used where a [`MaterialId`](crate::MaterialId) is meant.

use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;

/// The position of a `T` in the [`Scene`](super::Scene)'s array of `T`.
///
/// A `u32`, typed by what it counts. It carries no reference to the scene it came from.
pub struct Id<T> {
    index: u32,
    of: PhantomData<fn() -> T>,
}

impl<T> Id<T> {
    /// The id of the element at `index`.
    ///
    /// # Panics
    ///
    /// When `index` does not fit in 32 bits; the importers refuse files that large long before.
    #[must_use]
    pub fn new(index: usize) -> Self {
        let index = u32::try_from(index).expect("a scene holds fewer than 2^32 of anything");
        Self { index, of: PhantomData }
    }

    /// The position in the scene's array.
    #[must_use]
    pub fn index(self) -> usize {
        self.index as usize
    }
}

// Written out because a derive would ask `T` for each trait.
impl<T> Clone for Id<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Id<T> {}

impl<T> PartialEq for Id<T> {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}

impl<T> Eq for Id<T> {}

impl<T> PartialOrd for Id<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Id<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.index.cmp(&other.index)
    }
}

impl<T> Hash for Id<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.index.hash(state);
    }
}

impl<T> fmt::Debug for Id<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.index)
    }
}
