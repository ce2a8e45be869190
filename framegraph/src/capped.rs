//! The first hundred errors, and how many more there are: a wrong loop in a program or file can make as many as there are
//! passes, and each costs a search for what to say.

use std::fmt;

/// So many errors are kept.
const MOST: usize = 100;

/// The first hundred errors in their order, and how many more there are. Displayed as a line each.
#[derive(Clone, PartialEq, Eq)]
pub struct Errors<E> {
    /// The first hundred at most.
    pub listed: Vec<E>,
    /// How many there are beside these.
    pub more: usize,
}

impl<E> Default for Errors<E> {
    fn default() -> Self {
        Self { listed: Vec::new(), more: 0 }
    }
}

impl<E> Errors<E> {
    /// Counts an error, and makes it as long as there is room.
    #[cold]
    pub(crate) fn push(&mut self, make: impl FnOnce() -> E) {
        if !self.is_full() {
            self.listed.push(make());
        } else {
            self.more += 1;
        }
    }

    /// Whether another one is only counted.
    pub(crate) const fn is_full(&self) -> bool {
        self.listed.len() >= MOST
    }

    /// How many were found.
    pub(crate) const fn count(&self) -> usize {
        self.listed.len() + self.more
    }

    /// `value`, unless there are errors.
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
    /// The sentences, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl<E: fmt::Display> std::error::Error for Errors<E> {}
