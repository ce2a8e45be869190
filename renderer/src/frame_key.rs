//! What tells the frames of one executor apart.

use std::sync::{Arc, Weak};

/// Tells frames apart, however often each is declared anew.
#[derive(Debug)]
pub(crate) struct FrameKey(Arc<()>);

/// Names the frame of a key, and does not keep it. By default that of no frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrameTag(Weak<()>);

impl FrameKey {
    /// Unlike every other one.
    pub(crate) fn new() -> Self {
        Self(Arc::new(()))
    }

    /// The name of its frame.
    pub(crate) fn tag(&self) -> FrameTag {
        FrameTag(Arc::downgrade(&self.0))
    }
}

impl FrameTag {
    /// Whether it names the frame of that key.
    pub(crate) fn is_of(&self, key: &FrameKey) -> bool {
        std::ptr::eq(self.0.as_ptr(), Arc::as_ptr(&key.0))
    }

    /// Whether its frame was dropped.
    pub(crate) fn is_gone(&self) -> bool {
        self.0.strong_count() == 0
    }
}

impl PartialEq for FrameTag {
    fn eq(&self, other: &Self) -> bool {
        self.0.ptr_eq(&other.0)
    }
}
