//! What threads that record one frame share.

use super::*;
use crate::execute::cx::Cx;

fn needs_send<T: Send>() {}
fn needs_sync<T: Sync>() {}

/// A recorder's context goes to another thread, and what contexts share is shared by reference.
#[test]
fn contexts_of_one_frame_may_live_on_several_threads() {
    needs_send::<Cx<'_>>();
    needs_send::<Recording>();
    needs_sync::<Prepared<'_>>();
    needs_sync::<Passes<'_, ()>>();
}
