//! Imports that may be bound to one texture or buffer.

use crate::error::{DeclareError, DeclareReason};
use crate::graph::{Graph, Tables};
use crate::handle::{Buffer, Tag, Texture};
use crate::id::{ResourceId, Span, VersionId};
use crate::resource::{Exit, Kind};
use std::panic::Location;

impl Graph {
    /// Declares that two imported textures may be bound to one texture.
    ///
    /// Passes that access one of them count as passes with a side effect that are never merged. They run in declaration
    /// order, each in its own step, and are never culled. Attached imports of the pair are always stored, because a
    /// write of one may change the other. Passes declared before and after the call are both affected. Without this
    /// declaration, a back end refuses to bind one texture to two imports.
    ///
    /// Compilation fails on devices with [`explicit_barriers`](crate::Caps::explicit_barriers), where one texture
    /// cannot have two layouts.
    ///
    /// ```
    /// use framegraph::{DeclareError, Entry, Exit, Extent, Format, Graph, TextureDesc};
    ///
    /// let mut graph = Graph::new();
    /// let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    /// let atlas = graph.import_texture("atlas", desc, Entry::Defined, Exit::Keep);
    /// let icons = graph.import_texture("icons", desc, Entry::Defined, Exit::Keep);
    /// graph.may_alias(atlas, icons)?;
    /// # Ok::<(), DeclareError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if a handle belongs to another graph, if one is no import with [`Exit::Keep`], or if both are
    /// handles of one import.
    #[track_caller]
    pub fn may_alias(&mut self, a: Texture, b: Texture) -> Result<(), DeclareError> {
        self.alias_pair([(a.tag, a.version), (b.tag, b.version)], Location::caller())
    }

    /// Declares that two imported buffers may be bound to one buffer, with the effects of [`Graph::may_alias`].
    ///
    /// Works on every device. On devices with [`explicit_barriers`](crate::Caps::explicit_barriers), the barrier of each
    /// import also waits for uses of the other one. On devices with several queues, the passes run on the first one.
    ///
    /// # Errors
    /// Returns the errors of [`Graph::may_alias`].
    #[track_caller]
    pub fn may_alias_buffer(&mut self, a: Buffer, b: Buffer) -> Result<(), DeclareError> {
        self.alias_pair([(a.tag, a.version), (b.tag, b.version)], Location::caller())
    }

    fn alias_pair(
        &mut self,
        pair: [(Tag, VersionId); 2],
        location: &'static Location<'static>,
    ) -> Result<(), DeclareError> {
        let [a, b] = pair.map(|(tag, version)| self.kept_import(tag, version, location));
        let (a, b) = (a?, b?);
        if a == b {
            let resource = self.named_resource(a);
            return Err(DeclareError { reason: DeclareReason::NoAlias, pass: None, resource, location });
        }
        let tables = self.tables_mut().0;
        tables.aliases.push((a, b));
        tables.mark_aliased();
        Ok(())
    }
}

impl Tables {
    /// Returns the import with [`Exit::Keep`] that a version belongs to.
    fn kept_import(
        &self,
        tag: Tag,
        version: VersionId,
        location: &'static Location<'static>,
    ) -> Result<ResourceId, DeclareError> {
        let fail = |reason, resource| DeclareError { reason, pass: None, resource, location };
        let id = self.lookup(tag, version).ok_or_else(|| fail(DeclareReason::Foreign, None))?;
        match self.resources[id.index()].kind {
            Kind::Imported { exit: Exit::Keep, .. } => Ok(id),
            _ => Err(fail(DeclareReason::NoAlias, self.named_resource(id))),
        }
    }

    /// Sets the flags of declared passes that access an import with an alias.
    pub(crate) fn mark_aliased(&mut self) {
        for index in 0..self.passes.len() {
            if self.accesses_alias(self.passes[index].accesses) {
                self.passes[index].flags.alias();
            }
        }
    }

    /// Returns `true` if one of these accesses uses an import that may alias another one.
    #[inline]
    pub(crate) fn accesses_alias(&self, accesses: Span) -> bool {
        !self.aliases.is_empty() && accesses.of(&self.accesses).iter().any(|a| self.has_alias(a.resource))
    }

    /// Returns `true` if a resource is an import that [may alias](Graph::may_alias) another one.
    pub fn has_alias(&self, resource: ResourceId) -> bool {
        self.aliases.iter().any(|(a, b)| *a == resource || *b == resource)
    }

    /// Returns the imports that [may alias](Graph::may_alias) a resource.
    pub fn aliases_of(&self, resource: ResourceId) -> impl Iterator<Item = ResourceId> {
        let other = move |&(a, b)| if a == resource { Some(b) } else { (b == resource).then_some(a) };
        self.aliases.iter().filter_map(other)
    }

    /// Returns `true` if [`Graph::may_alias`] was called with these two imports, in any order.
    pub fn are_aliases(&self, a: ResourceId, b: ResourceId) -> bool {
        self.aliases.contains(&(a, b)) || self.aliases.contains(&(b, a))
    }
}
