//! Adds accesses: directly if a bit mask proves them valid, otherwise after the full check.
//!
//! The bit mask test is inlined into the caller, where kind, mode and range are mostly constants. Inlining halves its
//! cost. The full check is not inlined.

use super::PassBuilder;
use super::admit::{conflicts, incapable, mixed, wrong_kind};
use super::request::{AccessDesc, Request};
use crate::access::{Access, AccessKind, ByteRange, Kinds, Range};
use crate::error::{DeclareError, DeclareReason, StaleUser};
use crate::graph::Version;
use crate::handle::Tag;
use crate::id::{AccessId, BytesId, PassId, ResourceId, VersionId};
use crate::resolve::ResolveMode;
use crate::resource::{BufferSize, Desc};
use std::panic::Location;

impl PassBuilder<'_> {
    /// Adds a read of a whole resource. Returns `None` if the access needs the full check.
    #[inline(always)]
    pub(super) fn try_read_fast(&mut self, tag: Tag, version: VersionId, kind: AccessKind) -> Option<AccessId> {
        let row = self.tables.versions.get_mut(version.index())?;
        let is_allowed = row.allowed.without(self.full_check).has(Kinds::one(kind).union(Kinds::DEFINED));
        // A version that the pass itself wrote would be a conflict.
        if tag != self.tables.tag || !is_allowed || row.writer == self.pass {
            return None;
        }
        row.reader = self.pass;
        let resource = row.resource;
        Some(self.push_access(resource, version, Range::ALL, AccessDesc::read(kind), 0))
    }

    /// Adds a write of a whole resource. Returns `None` if the access needs the full check.
    #[inline(always)]
    pub(super) fn try_write_fast(
        &mut self,
        tag: Tag,
        version: VersionId,
        desc: AccessDesc,
        clear: u32,
    ) -> Option<VersionId> {
        let row = self.tables.versions.get_mut(version.index())?;
        let contents = if desc.mode.needs_contents() { Kinds::DEFINED } else { Kinds::NONE };
        let is_allowed = row.allowed.without(self.full_check).has(Kinds::one(desc.kind).union(contents));
        // A version that the pass itself reads or wrote would be a conflict.
        if tag != self.tables.tag || !is_allowed || row.writer == self.pass || row.reader == self.pass {
            return None;
        }
        let (resource, allowed) = (row.resource, row.allowed);
        row.allowed = Kinds::NONE;
        let (_, version) = self.push_write(resource, version, allowed, Range::ALL, desc, clear);
        Some(version)
    }

    /// Checks an access in full and adds it. Returns its id and, for a write, the new version.
    #[cold]
    #[inline(never)]
    pub(super) fn add_checked(
        &mut self,
        r: &Request,
        location: &'static Location<'static>,
    ) -> Result<(AccessId, VersionId), DeclareError> {
        let Some(resource) = self.tables.lookup(r.tag, r.version) else {
            return Err(self.refuse(DeclareReason::Foreign, ResourceId::NONE, location));
        };
        if let Some(reason) = self.objection(resource, r) {
            return Err(self.refuse(reason, resource, location));
        }
        let AccessDesc { kind, mode, .. } = r.desc;
        let row = &mut self.tables.versions[r.version.index()];
        let unwritten = !row.allowed.has(Kinds::DEFINED);
        self.tables.contents_uncertain |= !r.range.is_all() || (unwritten && mode.needs_contents());
        let allowed = row.allowed;
        if mode.writes() {
            row.allowed = Kinds::NONE;
        } else {
            row.reader = self.pass;
        }
        let range = match (&self.tables.resources[resource.index()].desc, r.bytes) {
            (Desc::Texture(texture), _) if !r.range.is_all() => r.range.canonical(texture),
            (Desc::Buffer(buffer), Some((offset, bytes))) if buffer.size != BufferSize::Bytes(bytes) => {
                self.tables.contents_uncertain = true;
                // Cannot overflow: at most one byte range per access.
                let named = BytesId::unchecked(self.tables.byte_ranges.len());
                self.tables.byte_ranges.push(ByteRange { resource, offset, bytes });
                Range { bytes: named, ..Range::ALL }
            }
            _ => Range::ALL,
        };
        if Kinds::COPIES.has(Kinds::one(kind)) {
            self.full_check = Kinds::ALL.without(Kinds::COPIES);
        }
        Ok(if mode.writes() {
            self.push_write(resource, r.version, allowed, range, r.desc, r.clear)
        } else {
            (self.push_access(resource, r.version, range, r.desc, r.clear), r.version)
        })
    }

    /// Adds a validated write that replaces `previous`, a version that allowed the kinds in `allowed`.
    #[inline(always)]
    fn push_write(
        &mut self,
        resource: ResourceId,
        previous: VersionId,
        allowed: Kinds,
        range: Range,
        desc: AccessDesc,
        clear: u32,
    ) -> (AccessId, VersionId) {
        let version = VersionId::unchecked(self.tables.versions.len());
        let alone = !self.used.meets(Kinds::TILE);
        let access = self.push_access(resource, version, range, desc, clear);
        if desc.kind == AccessKind::Color {
            let slot = u32::from(desc.slot);
            self.colors = self.colors.max(slot + 1);
            // Another slot than the first counts as several attachments.
            let sole = alone && slot == 0 && allowed.has(Kinds::ONE_PART) && !range.slice;
            self.sole = if sole { access } else { AccessId::NONE };
        }
        let (writer, reader, allowed) = (self.pass, PassId::NONE, allowed.union(Kinds::DEFINED));
        self.tables.resources[resource.index()].current = version;
        self.tables.versions.push(Version { resource, writer, access, previous, reader, allowed });
        (access, version)
    }

    #[inline(always)]
    fn push_access(
        &mut self,
        resource: ResourceId,
        version: VersionId,
        range: Range,
        desc: AccessDesc,
        clear: u32,
    ) -> AccessId {
        let AccessDesc { kind, mode, slot } = desc;
        self.used = self.used.union(Kinds::one(kind));
        if kind.is_depth() {
            self.full_check = self.full_check.union(Kinds::DEPTHS);
        }
        if Kinds::TILE.has(Kinds::one(kind)) {
            self.sole = AccessId::NONE;
        }
        let access = AccessId::unchecked(self.tables.accesses.len());
        self.tables.accesses.push(Access {
            resource,
            version,
            range,
            kind,
            mode,
            slot,
            resolve: ResolveMode::Average,
            clear,
        });
        access
    }

    /// Returns the reason why an access is invalid, if any.
    fn objection(&self, resource: ResourceId, r: &Request) -> Option<DeclareReason> {
        let row = &self.tables.resources[resource.index()];
        let own = self.own();
        let access = r.desc.kind;
        if let Some(earlier) = own.iter().find(|a| a.resource == resource && conflicts(self.tables, a, r)) {
            return Some(DeclareReason::Conflict {
                earlier: earlier.kind,
                later: access,
                buffer: row.desc.texture().is_none(),
            });
        }
        if row.current != r.version {
            let own = self.tables.versions.get(row.current.index()).is_some_and(|v| v.writer == self.pass);
            let (writer, user) = match own {
                true => (self.own_name(), StaleUser::SamePass),
                false => (self.tables.writer_name(row.current), StaleUser::OtherPass),
            };
            return Some(DeclareReason::Stale { writer: writer.to_owned(), user });
        }
        if access.is_depth() && self.used.meets(Kinds::DEPTHS) {
            return Some(DeclareReason::SecondDepth);
        }
        if let Some(reason) = self.kind.and_then(|kind| wrong_kind(kind, access)) {
            return Some(reason);
        }
        if let Some(reason) = mixed(self.tables, own, self.used, access) {
            return Some(reason);
        }
        incapable(row, r)
    }

    #[inline]
    pub(super) fn own(&self) -> &[Access] {
        &self.tables.accesses[self.first..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check_source::generate::{self, Entropy, Profile};
    use crate::graph::{Export, Graph, Tables};
    use crate::resource::Desc;

    /// Copies the resources of `graph` that were created before its first `versions` versions.
    fn make_resources(graph: &Graph, tables: &mut Tables, versions: usize) {
        while tables.versions.len() < versions {
            let resource = &graph.resources[tables.resources.len()];
            match resource.desc {
                Desc::Texture(desc) => drop(tables.texture("", "t", desc, resource.kind)),
                Desc::Buffer(desc) => drop(tables.buffer("", "b", desc.size, resource.kind)),
            }
        }
    }

    /// Declares the passes of `graph` again, with the full check for each access.
    fn declared_with_every_check(graph: &Graph) -> Graph {
        let mut again = Graph::new();
        for row in &graph.passes {
            let mut pass = PassBuilder::new(again.tables_mut().0, "", "pass", row.location);
            pass.flags = row.flags;
            for access in row.accesses.of(&graph.accesses) {
                let &Access { version, range, kind, mode, slot, clear, .. } = access;
                let written = graph.versions[version.index()].previous;
                let used = if mode.writes() { written } else { version };
                make_resources(graph, pass.tables, if mode.writes() { version.index() } else { version.index() + 1 });
                let desc = AccessDesc { kind, mode, slot };
                let bytes = graph.bytes_of(access).map(|b| (b.offset, b.bytes));
                let request = Request { tag: pass.tables.tag, version: used, range, bytes, desc, clear };
                let added = pass.add_checked(&request, row.location);
                pass.resolved_by(access.resolve);
                assert_eq!(
                    added.map(|(_, version)| version),
                    Ok(version),
                    "{kind:?} passes the fast check, but not the full one"
                );
            }
            pass.kind(row.kind).expect("a kind that was declared or inferred");
            pass.finish();
        }
        make_resources(graph, again.tables_mut().0, graph.versions.len());
        again
    }

    #[test]
    fn quick_and_full_checks_agree() {
        let mut written = 0;
        for seed in 0..3000 {
            let profile = Profile { sloppy: seed % 2 == 0, plain: seed % 3 == 0, ..Profile::default() };
            let quick = generate::graph(&mut Entropy::seeded(seed), &profile);
            let full = declared_with_every_check(&quick);
            assert_eq!(quick.versions, full.versions, "seed {seed}");
            assert_eq!(quick.accesses, full.accesses, "seed {seed}");
            let kinds = |g: &Graph| g.passes.iter().map(|p| (p.accesses, p.kind, p.sole_color)).collect::<Vec<_>>();
            assert_eq!(kinds(&quick), kinds(&full), "seed {seed}");
            let unwritten = |e: &Export| quick.versions[e.version.index()].writer.is_none();
            let uncertain = full.contents_uncertain || quick.exports.iter().any(unwritten);
            // A rejected pass may have set the flag too.
            assert!(quick.contents_uncertain || !uncertain, "seed {seed}");
            // Invariant of the fast check: only the newest version of each resource allows accesses.
            for (index, (version, again)) in quick.versions.iter().zip(&full.versions).enumerate() {
                let resource = &quick.resources[version.resource.index()];
                let written = if version.writer.is_none() { Kinds::NONE } else { Kinds::DEFINED };
                let allowed = Kinds::on_entry(&resource.desc, resource.kind).union(written);
                let newest = resource.current == VersionId::at(index);
                assert_eq!(version.allowed, if newest { allowed } else { Kinds::NONE }, "seed {seed}, version {index}");
                assert_eq!(version.allowed, again.allowed, "seed {seed}, version {index}");
            }
            written += quick.versions.iter().filter(|v| v.writer.some().is_some()).count();
        }
        assert!(written > 3000, "only {written} writes");
    }
}
