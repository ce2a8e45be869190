//! Notes on rows of the log: those that are not true, and those that are missing or too many.

use crate::decision::Reason;
use crate::id::PassId;
use crate::testing::check::case::Case;
use crate::testing::check::finding::{Place, Rule};

/// Notes a row that is not true.
pub(super) fn judge(case: &Case<'_>, place: impl Into<Place>, reason: Reason, holds: bool) {
    if !holds {
        let why = format_args!("the log says: {}; that is not so", reason.sentence(case.graph));
        case.report.violation(Rule::Decision, place, why);
    }
}

/// Notes how many rows of a kind there are, when it is not the number that there should be.
pub(super) fn number(case: &Case<'_>, place: impl Into<Place>, what: &str, found: usize, expected: usize) {
    let why = format_args!("the log has {found} rows on {what}, should have {expected}");
    case.report.require(found == expected, Rule::Decision, place, why);
}

/// The pass that runs before `pass`, if any.
pub(super) fn predecessor(case: &Case<'_>, pass: PassId) -> Option<PassId> {
    let position = case.position[pass.index()]?;
    position.checked_sub(1).map(|p| case.order[p])
}
