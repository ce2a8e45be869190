//! Phase 3: in which order the surviving passes run.

use crate::id::PassId;

/// Declaration order: the surviving passes as they stand. Nothing moves, so nothing is logged.
pub(crate) fn declared(live: &[bool], order: &mut Vec<PassId>) {
    order.clear();
    order.extend(live.iter().enumerate().filter(|(_, live)| **live).map(|(index, _)| PassId::at(index)));
}
