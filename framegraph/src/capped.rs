//! The first hundred errors, and how many more there are: a wrong loop in a program or file can make as many as there are
//! passes, and each costs a search for what to say.

/// So many errors are kept.
const MOST: usize = 100;

/// Errors as they are found.
#[derive(Clone, Debug)]
pub(crate) struct Capped<E> {
    pub(crate) listed: Vec<E>,
    /// How many were found beside those that are listed.
    pub(crate) more: usize,
}

impl<E> Default for Capped<E> {
    fn default() -> Self {
        Self { listed: Vec::new(), more: 0 }
    }
}

impl<E> Capped<E> {
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

    /// Whether nothing was found.
    pub(crate) const fn is_empty(&self) -> bool {
        self.listed.is_empty()
    }

    /// How many were found.
    #[cfg(feature = "files")]
    pub(crate) const fn count(&self) -> usize {
        self.listed.len() + self.more
    }
}

/// A line for each error, and one for those that are not listed.
pub(crate) fn lines<E: ToString>(listed: &[E], more: usize) -> String {
    let mut lines: Vec<String> = listed.iter().map(E::to_string).collect();
    if more != 0 {
        lines.push(format!("and {more} more errors, not listed"));
    }
    lines.join("\n")
}
