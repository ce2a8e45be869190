//! Errors of color grading.

/// Error of evaluating a look.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GradingError {
    /// The look has a part that requires a table.
    #[error("{what} requires a grading table; choose `GradeBy::Table` (`--grade-by table`)")]
    NeedsTable {
        /// The part that requires a table.
        what: &'static str,
    },
    /// The tone curve is [`ToneMap::Own`](framegraph_shaders::layout::ToneMap::Own), but no curve is set.
    #[error("the look selects `ToneMap::Own`, but no curve is set; call `GradingTables::set_own`")]
    NoOwnCurve,
}

impl std::fmt::Debug for GradingError {
    /// Writes the message, since `unwrap` shows it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
