//! Phase 2, last part: the graph without the multisample resolves that are dropped. The phases after it know nothing of
//! them, so they take no memory, stand against no merge, and cost a frame without them nothing.

use super::need::Need;
use crate::graph::Tables;
use crate::id::{AccessId, PassId};

/// Makes `trimmed` the graph without the accesses `dropped`, which are in order. What is noted `after` each access follows
/// it.
pub(crate) fn trim(graph: &Tables, dropped: &[(PassId, AccessId)], after: &mut [Need], trimmed: &mut Tables) {
    trimmed.copy_work(graph);
    for (pass, access) in dropped.iter().rev() {
        let span = &mut trimmed.passes[pass.index()].accesses;
        let rest = access.index()..span.range().end;
        trimmed.accesses[rest.clone()].rotate_left(1);
        after[rest].rotate_left(1);
        span.len -= 1;
    }
}
