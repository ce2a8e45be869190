//! Why a look cannot be brought to a picture.

/// A look cannot be brought to a picture as it is asked for.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GradingError {
    /// What was chosen is only known to a table.
    #[error("{what} is known to a table of grading alone; choose `GradeBy::Table` (`--grade-by table`)")]
    NeedsTable {
        /// What was chosen.
        what: &'static str,
    },
    /// The tone curve of the application's own is missing.
    #[error("the tone curve is the application's own, but it gave none; call `GradingTables::set_own`")]
    NoOwnCurve,
}

impl std::fmt::Debug for GradingError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
