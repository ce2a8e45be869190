//! Why a way to find lights was refused.

/// A way to find lights cannot be chosen by name.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LightSearchError {
    /// There is no such way.
    #[error("{way}: `auto`, `froxels` or `all` is needed")]
    Way {
        /// What was asked for.
        way: String,
    },
    /// There is no such choice.
    #[error("{key}: unknown choice; `auto` and `froxels` have {}, `all` has none", .known.join(", "))]
    Key {
        /// The name.
        key: String,
        /// The names that there are.
        known: &'static [&'static str],
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
    /// The first slice does not end before the last.
    #[error("near={near_m}, far={far_m}: the first slice must end before the last; choose near below far")]
    Ends {
        /// Where the first ends.
        near_m: f32,
        /// Where the last ends.
        far_m: f32,
    },
}

impl std::fmt::Debug for LightSearchError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
