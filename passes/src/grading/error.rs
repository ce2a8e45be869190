//! Why a choice of color grading was refused.

/// A choice of color grading cannot be made by name.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GradingError {
    /// There is no such choice.
    #[error("{key}: unknown choice; there are {}", .known.join(", "))]
    Key {
        /// The name.
        key: String,
        /// The names that there are.
        known: Vec<&'static str>,
    },
    /// The choice takes other values.
    #[error("{key}={value}: {takes} is needed")]
    Value {
        /// The name.
        key: String,
        /// The value.
        value: String,
        /// What the choice takes.
        takes: &'static str,
    },
    /// The choice takes numbers from a range.
    #[error("{key}={value}: {} from {low} to {high} {} needed", count(.needed), if *.needed == 1 { "is" } else { "are" })]
    Numbers {
        /// The name.
        key: String,
        /// The value.
        value: String,
        /// How many numbers.
        needed: usize,
        /// The least.
        low: f32,
        /// The greatest.
        high: f32,
    },
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

fn count(needed: &usize) -> String {
    if *needed == 1 { "a number".into() } else { format!("{needed} numbers separated by `:`") }
}

impl std::fmt::Debug for GradingError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
