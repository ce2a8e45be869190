//! Identity of frames, for executors that execute several.

use std::sync::{Arc, Weak};

/// Identity of a frame. It survives [`Frame::reset`](crate::Frame::reset).
#[derive(Debug)]
pub(crate) struct FrameKey(Arc<()>);

/// Weak reference to a [`FrameKey`]. The default refers to no frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrameTag(Weak<()>);

impl FrameKey {
    /// Creates a key that differs from all others.
    pub(crate) fn new() -> Self {
        Self(Arc::new(()))
    }

    /// Returns a weak reference to this key.
    pub(crate) fn tag(&self) -> FrameTag {
        FrameTag(Arc::downgrade(&self.0))
    }
}

impl FrameTag {
    /// Returns whether the tag refers to `key`.
    pub(crate) fn is_of(&self, key: &FrameKey) -> bool {
        std::ptr::eq(self.0.as_ptr(), Arc::as_ptr(&key.0))
    }

    /// Returns whether the frame was dropped.
    pub(crate) fn is_gone(&self) -> bool {
        self.0.strong_count() == 0
    }
}

impl PartialEq for FrameTag {
    fn eq(&self, other: &Self) -> bool {
        self.0.ptr_eq(&other.0)
    }
}
