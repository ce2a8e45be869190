//! A list of errors with a maximum length. A faulty loop in a program or file can produce one error per pass, and
//! formatting each one is expensive.

use std::fmt;

/// Maximum number of errors that are kept.
const MAX_LISTED: usize = 100;

/// Up to 100 errors in the order they were found, and the number of further errors. Displays one error per line.
#[derive(Clone, PartialEq, Eq)]
pub struct Errors<E> {
    /// The first errors, at most 100.
    pub listed: Vec<E>,
    /// Number of errors that are not listed.
    pub more: usize,
}

impl<E> Default for Errors<E> {
    fn default() -> Self {
        Self { listed: Vec::new(), more: 0 }
    }
}

impl<E> Errors<E> {
    /// Adds an error, or only counts it if the list is full.
    #[cold]
    pub(crate) fn push(&mut self, make: impl FnOnce() -> E) {
        if !self.is_full() {
            self.listed.push(make());
        } else {
            self.more += 1;
        }
    }

    /// Returns `true` if further errors are only counted.
    pub(crate) const fn is_full(&self) -> bool {
        self.listed.len() >= MAX_LISTED
    }

    /// Number of errors, listed or not.
    pub(crate) const fn count(&self) -> usize {
        self.listed.len() + self.more
    }

    /// Returns `value` if there are no errors.
    pub(crate) fn or<T>(self, value: T) -> Result<T, Self> {
        if self.count() == 0 { Ok(value) } else { Err(self) }
    }
}

impl<E> From<E> for Errors<E> {
    fn from(error: E) -> Self {
        Self { listed: vec![error], more: 0 }
    }
}

impl<E: fmt::Display> fmt::Display for Errors<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut lines: Vec<String> = self.listed.iter().map(E::to_string).collect();
        if self.more != 0 {
            lines.push(format!("and {} more errors, not listed", self.more));
        }
        f.write_str(&lines.join("\n"))
    }
}

impl<E: fmt::Display> fmt::Debug for Errors<E> {
    /// Shows the messages, because `unwrap` prints this.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl<E: fmt::Display> std::error::Error for Errors<E> {}
