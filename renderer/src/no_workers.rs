//! Replacement for the worker threads when the feature `threads` is off.

/// Uninhabited type: without the feature `threads` no executor has workers.
#[derive(Clone, Debug)]
pub(crate) enum Workers {}

impl Workers {
    pub(crate) fn threads(&self) -> usize {
        match *self {}
    }
}

/// Work of one thread.
pub(crate) type Job<'a, W> = &'a mut (dyn FnMut(&W) + Send);

/// Function that runs jobs on several threads.
pub(crate) type ShareWorld<W> = fn(&Workers, &mut [Job<'_, W>], &W);

pub(crate) fn share_world<W: ?Sized>(workers: &Workers, _: &mut [Job<'_, W>], _: &W) {
    match *workers {}
}
