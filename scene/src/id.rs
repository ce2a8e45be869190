//! Typed indices: a [`MeshId`](crate::MeshId) cannot be used in place of a [`MaterialId`](crate::MaterialId).

use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;

/// Position of a `T` in the [`Scene`](super::Scene)'s array of `T`.
///
/// A typed `u32`, without a reference to its scene.
pub struct Id<T> {
    index: u32,
    of: PhantomData<fn() -> T>,
}

impl<T> Id<T> {
    /// Returns the id of the element at `index`.
    ///
    /// # Panics
    ///
    /// If `index` does not fit in 32 bits; importers reject such files.
    #[must_use]
    pub fn new(index: usize) -> Self {
        let index = u32::try_from(index).expect("a scene holds fewer than 2^32 of anything");
        Self { index, of: PhantomData }
    }

    /// Returns the position in the scene's array.
    #[must_use]
    pub fn index(self) -> usize {
        self.index as usize
    }
}

// Implemented by hand, since a derive would require each trait of `T`.
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
