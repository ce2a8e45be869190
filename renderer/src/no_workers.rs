//! Replacement for the worker threads when the feature `threads` is off.

/// Uninhabited type: without the feature `threads` no executor has workers.
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
