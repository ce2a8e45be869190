//! In the place of [`workers`](super) where the program was built without the feature `threads`.

/// No value.
#[derive(Debug)]
pub(crate) enum Workers {}

impl Workers {
    pub(crate) fn threads(&self) -> usize {
        match *self {}
    }

    pub(crate) fn for_each<T: Send>(&self, _: &mut [T], _: impl Fn(&mut T) + Sync) {
        match *self {}
    }
}
