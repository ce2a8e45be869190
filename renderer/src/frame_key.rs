//! What tells the frames of one executor apart.

use std::sync::Arc;

/// Tells frames apart, however often each is declared anew. Clones are equal.
#[derive(Clone, Debug)]
pub(crate) struct FrameKey(Arc<()>);

impl FrameKey {
    /// Unlike every other one.
    pub(crate) fn new() -> Self {
        Self(Arc::new(()))
    }
}

impl PartialEq for FrameKey {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
