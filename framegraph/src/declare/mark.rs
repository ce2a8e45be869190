//! Taking a refused pass back.

use crate::graph::Tables;

/// The ends of all arrays, so that a refused pass can be taken back.
pub(super) struct Mark {
    names: usize,
    passes: usize,
    accesses: usize,
    resources: usize,
    versions: usize,
    clears: usize,
    errors: usize,
}

impl Tables {
    /// Where all arrays end now.
    pub(super) fn mark(&self) -> Mark {
        Mark {
            names: self.names.len(),
            passes: self.passes.len(),
            accesses: self.accesses.len(),
            resources: self.resources.len(),
            versions: self.versions.len(),
            clears: self.clears.len(),
            errors: self.errors.len(),
        }
    }

    /// Takes everything back that was declared since `mark`.
    pub(super) fn rewind(&mut self, mark: &Mark) {
        for version in self.versions.drain(mark.versions..).rev() {
            if !version.previous.is_none() {
                self.resources[version.resource.index()].current = version.previous;
            }
        }
        self.names.truncate(mark.names);
        self.passes.truncate(mark.passes);
        self.sole_colors.truncate(mark.passes);
        self.accesses.truncate(mark.accesses);
        self.resources.truncate(mark.resources);
        self.plain_kinds.truncate(mark.resources);
        self.clears.truncate(mark.clears);
        self.errors.truncate(mark.errors);
    }
}
