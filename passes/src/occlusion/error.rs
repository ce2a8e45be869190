//! Why a choice of ambient occlusion was refused.

/// A choice of ambient occlusion cannot be made by name.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OcclusionError {
    /// There is no such method.
    #[error("{method}: `off`, `sao` or `gtao` is needed")]
    Method {
        /// What was asked for.
        method: String,
    },
    /// There is no such choice.
    #[error("{key}: unknown choice; there are {}", .known.join(", "))]
    Key {
        /// The name.
        key: String,
        /// The names that there are.
        known: &'static [&'static str],
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
    /// The choice takes a number from a range.
    #[error("{key}={value}: a number from {low} to {high} is needed")]
    Number {
        /// The name.
        key: String,
        /// The value.
        value: String,
        /// The least number.
        low: f32,
        /// The greatest number.
        high: f32,
    },
    /// The method has no such choice.
    #[error("{key}: only `{method}` has it")]
    Other {
        /// The name.
        key: String,
        /// The method that has it.
        method: &'static str,
    },
}

impl std::fmt::Debug for OcclusionError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
