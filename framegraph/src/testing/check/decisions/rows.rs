//! Findings about rows of the log: incorrect, missing or superfluous.

use crate::decision::Reason;
use crate::id::PassId;
use crate::testing::check::case::Case;
use crate::testing::check::finding::{Place, Rule};

/// Reports a row that is not correct.
pub(super) fn judge(case: &Case<'_>, place: impl Into<Place>, reason: Reason, holds: bool) {
    if !holds {
        let why = format_args!("incorrect row in the log: {}", reason.sentence(case.graph));
        case.report.violation(Rule::Decision, place, why);
    }
}

/// Reports a wrong number of rows of a kind.
pub(super) fn number(case: &Case<'_>, place: impl Into<Place>, what: &str, found: usize, expected: usize) {
    let why = format_args!("the log has {found} rows about {what}, expected {expected}");
    case.report.require(found == expected, Rule::Decision, place, why);
}

/// Returns the pass that runs before `pass`, if any.
pub(super) fn predecessor(case: &Case<'_>, pass: PassId) -> Option<PassId> {
    let position = case.position[pass.index()]?;
    position.checked_sub(1).map(|p| case.order[p])
}
