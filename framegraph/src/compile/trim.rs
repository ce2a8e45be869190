//! Phase 2, last part: removes dropped multisample resolves from the graph. Later phases do not see them, so they need
//! no memory and prevent no merges.

use super::liveness::NextUse;
use crate::graph::Tables;
use crate::id::{AccessId, PassId};

/// Writes the graph without the accesses in `dropped`, which is sorted, to `trimmed`. Updates `after` accordingly.
pub(crate) fn trim(graph: &Tables, dropped: &[(PassId, AccessId)], after: &mut [NextUse], trimmed: &mut Tables) {
    trimmed.copy_work(graph);
    for (pass, access) in dropped.iter().rev() {
        let span = &mut trimmed.passes[pass.index()].accesses;
        let rest = access.index()..span.range().end;
        trimmed.accesses[rest.clone()].rotate_left(1);
        after[rest].rotate_left(1);
        span.len -= 1;
    }
}
