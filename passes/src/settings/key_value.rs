//! Errors of options given as `key=value`.

use framegraph::suggest::nearest;

/// Error of parsing an option.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OptionError {
    /// The key is unknown.
    #[error("{key}: unknown choice; {}", hint(.key, .known))]
    Key {
        /// The key.
        key: String,
        /// The accepted keys.
        known: Vec<&'static str>,
    },
    /// The value is invalid.
    #[error("{key}={value}: expected {takes}")]
    Value {
        /// The key.
        key: String,
        /// The value.
        value: String,
        /// Description of accepted values.
        takes: String,
    },
    /// The key belongs to another method.
    #[error("{key}: only `{method}` has it")]
    Other {
        /// The key.
        key: String,
        /// The method with this key.
        method: &'static str,
    },
}

/// Returns the nearest known name, or all of them.
fn hint(key: &str, known: &[&'static str]) -> String {
    match nearest(key, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("there are {}", known.join(", ")),
    }
}

impl std::fmt::Debug for OptionError {
    /// Prints the message, as `unwrap` shows it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
