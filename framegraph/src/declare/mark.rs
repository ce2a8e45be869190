//! Rollback of declarations, for rejected passes and truncated graphs.

use crate::access::{Kinds, Mode};
use crate::graph::Tables;
use crate::id::Span;

impl Tables {
    /// Removes the pass named `name`, which was not finished. Its accesses and versions begin at the given indices.
    #[cold]
    #[inline(never)]
    pub(crate) fn take_pass_back(&mut self, name: Span, accesses: usize, versions: usize) {
        let own = self.accesses[accesses..].iter();
        if let Some(clear) = own.filter(|a| a.mode == Mode::Clear).map(|a| a.clear).next() {
            self.clears.truncate(clear as usize);
        }
        self.take_versions_back(versions);
        self.drop_accesses(accesses);
        self.names.truncate(name.start as usize);
    }

    /// Removes the accesses from `first` on, and their byte ranges.
    pub(crate) fn drop_accesses(&mut self, first: usize) {
        if let Some(bytes) = self.accesses[first..].iter().find_map(|a| a.range.bytes.some()) {
            self.byte_ranges.truncate(bytes.index());
        }
        self.accesses.truncate(first);
    }

    /// Removes the versions from `first` on, and resources created with one of them. The replaced versions become
    /// current again.
    pub(crate) fn take_versions_back(&mut self, first: usize) {
        while self.versions.len() > first {
            let Some(version) = self.versions.pop() else { return };
            let Some(row) = self.versions.get_mut(version.previous.index()) else {
                self.resources.truncate(version.resource.index());
                continue;
            };
            let resource = &mut self.resources[version.resource.index()];
            resource.current = version.previous;
            let defined = row.writer.some().is_some() || resource.kind.defined_on_entry();
            row.allowed = if defined { version.allowed } else { version.allowed.without(Kinds::DEFINED) };
        }
    }
}
