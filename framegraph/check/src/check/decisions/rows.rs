//! Findings about rows of the log: incorrect, missing or superfluous.

use crate::check::finding::{Place, Rule};
use crate::check::rule_input::RuleInput;
use framegraph::decision::Reason;
use framegraph::id::PassId;

/// Reports a row that is not correct.
pub(super) fn judge(ctx: &RuleInput<'_>, place: impl Into<Place>, reason: Reason, holds: bool) {
    if !holds {
        let why = format_args!("incorrect row in the log: {}", reason.sentence(ctx.graph));
        ctx.report.violation(Rule::Decision, place, why);
    }
}

/// Reports a wrong number of rows of a kind.
pub(super) fn number(ctx: &RuleInput<'_>, place: impl Into<Place>, what: &str, found: usize, expected: usize) {
    let why = format_args!("the log has {found} rows about {what}, expected {expected}");
    ctx.report.require(found == expected, Rule::Decision, place, why);
}

/// Returns the pass that runs before `pass`, if any.
pub(super) fn predecessor(ctx: &RuleInput<'_>, pass: PassId) -> Option<PassId> {
    let position = ctx.position[pass.index()]?;
    position.checked_sub(1).map(|p| ctx.order[p])
}
