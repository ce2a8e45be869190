//! Truncated graphs, for inspecting the contents of a texture in the middle of a frame.
//!
//! The contents of a texture after a pass are computed by a second plan. It runs everything up to that pass, and its
//! only output is the texture. In the second plan, memoryless and inlined textures get memory; the first plan is not
//! affected.

use crate::access::Range;
use crate::graph::{Graph, PassFlags, Tables};
use crate::handle::ReadOnly;
use crate::id::{PassId, ResourceId, VersionId};
use crate::resource::Kind;

impl Graph {
    /// Returns the versions of a resource, oldest first: the initial version, then one for each write access.
    pub fn versions_of(&self, resource: ResourceId) -> impl DoubleEndedIterator<Item = VersionId> {
        let rows = self.versions.iter().enumerate();
        rows.filter(move |(_, v)| v.resource == resource).map(|(index, _)| VersionId::at(index))
    }

    /// Returns a copy of the graph that ends right after `version` was written, and the handle of `version` in it.
    ///
    /// Later passes and all exports are removed. Handles, tokens and recorders of the remaining passes stay valid.
    ///
    /// The copy can be executed without disturbing the original frame: imports with undefined initial contents become
    /// transient textures, and side effects do not keep passes. Imports with defined contents stay imported, so the
    /// caller should bind copies to protect them from writes.
    ///
    /// Returns `None` if the version does not exist, belongs to a buffer, or is an initial version with undefined
    /// contents.
    pub fn ending_with(&self, version: VersionId) -> Option<(Self, ReadOnly)> {
        let row = *self.versions.get(version.index())?;
        let kind = self.resources[row.resource.index()].kind;
        let holds = row.writer.some().is_some() || kind.defined_on_entry();
        if !holds || self.resources[row.resource.index()].desc.texture().is_none() {
            return None;
        }
        // The initial contents of a resource exist from its declaration on, which may come after some passes.
        let writers = self.versions[..=version.index()].iter().filter_map(|v| v.writer.some());
        let last = row.writer.some().or_else(|| writers.max()).unwrap_or_default();
        let mut cut = self.clone();
        let (tables, _) = cut.tables_mut();
        tables.cut_after(last);
        for resource in &mut tables.resources {
            resource.kind = match resource.kind {
                Kind::Imported { entry, .. } if !entry.is_defined() => Kind::Transient,
                other => other,
            };
        }
        tables.contents_uncertain = true;
        Some((cut, ReadOnly { tag: self.tag, version, range: Range::ALL }))
    }
}

impl Tables {
    /// Removes every pass after `last`, which may be none, and everything that only they declared.
    fn cut_after(&mut self, last: PassId) {
        let passes = last.some().map_or(0, |last| last.index() + 1);
        let accesses = self.passes.get(passes).map_or(self.accesses.len(), |next| next.accesses.start as usize);
        let later = |writer: PassId| writer.some().is_some_and(|writer| writer.index() >= passes);
        let versions = self.versions.iter().position(|v| later(v.writer)).unwrap_or(self.versions.len());
        self.take_versions_back(versions);
        self.drop_accesses(accesses);
        self.passes.truncate(passes);
        self.exports.clear();
        self.passes.iter_mut().for_each(|pass| pass.flags.unset(PassFlags::SIDE_EFFECT));
        // Passes over imports that may alias keep their order.
        self.mark_aliased();
    }
}
