//! Queries for back ends: the access of a handle or token, and scopes that outlive a call.

use crate::access::Access;
use crate::graph::Graph;
use crate::handle::{Buffer, BufferView, Previous, Tag, Texture, View};
use crate::id::{AccessId, ResourceId, VersionId};

/// An open name scope, to be passed to [`Graph::close_scope`].
#[derive(Debug)]
#[must_use = "a scope stays open until it is closed"]
pub struct Scope {
    prefix: usize,
}

impl Graph {
    /// Returns the access of a texture read; `None` if the token belongs to another graph or an earlier declaration.
    pub fn access_of(&self, view: View) -> Option<&Access> {
        self.access_at(view.tag, view.access)
    }

    /// Returns the access of a buffer read; `None` if the token belongs to another graph or an earlier declaration.
    pub fn access_of_buffer(&self, view: BufferView) -> Option<&Access> {
        self.access_at(view.tag, view.access)
    }

    /// Returns the access that wrote this version of a texture; `None` for the initial version, or a handle of another
    /// graph.
    pub fn writer_of(&self, texture: Texture) -> Option<&Access> {
        self.writer_at(texture.tag, texture.version)
    }

    /// Returns the access that wrote this version of a buffer; `None` for the initial version, or a handle of another
    /// graph.
    pub fn writer_of_buffer(&self, buffer: Buffer) -> Option<&Access> {
        self.writer_at(buffer.tag, buffer.version)
    }

    /// Returns the resource of an earlier history image; `None` for a handle of another graph.
    pub fn resource_of_previous(&self, previous: Previous) -> Option<ResourceId> {
        self.lookup(previous.tag, previous.version)
    }

    /// Opens a scope: names declared until [`Graph::close_scope`] get the prefix `name/`. [`Graph::scope`] opens and
    /// closes a scope in one call.
    pub fn open_scope(&mut self, name: &str) -> Scope {
        let prefix = self.prefix.len();
        self.prefix.push_str(name);
        self.prefix.push('/');
        Scope { prefix }
    }

    /// Closes a scope and all scopes opened inside it.
    pub fn close_scope(&mut self, scope: Scope) {
        self.prefix.truncate(scope.prefix);
    }

    fn access_at(&self, tag: Tag, access: AccessId) -> Option<&Access> {
        if tag == self.tag { self.accesses.get(access.index()) } else { None }
    }

    fn writer_at(&self, tag: Tag, version: VersionId) -> Option<&Access> {
        self.lookup(tag, version)?;
        self.access_at(tag, self.versions[version.index()].access)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AccessKind, ClearValue, DeclareError, Extent, Format, Intent, TextureDesc};

    #[test]
    fn tokens_lead_to_their_accesses() -> Result<(), DeclareError> {
        let mut graph = Graph::new();
        let desc = TextureDesc::new(Extent::absolute(8, 8), Format::Rgba8Unorm).mips(2);
        let entry = graph.texture("pyramid", desc);
        assert_eq!(graph.writer_of(entry), None, "no pass wrote the initial version");
        let written = graph.add_fn("fill", |p| p.color(entry.mip(1), Intent::Clear(ClearValue::BLACK)))?;
        let made = graph.writer_of(written).copied();
        assert_eq!(made.map(|a| (a.kind, a.range.mip, a.range.mips)), Some((AccessKind::Color, 1, 1)));
        let view = graph.add_fn("read", |p| p.sampled(written.mip(1)))?;
        assert_eq!(graph.access_of(view).map(|a| a.kind), Some(AccessKind::Sampled));
        let history = graph.history("taa", desc, 1);
        let previous = graph.previous(history, 1)?;
        assert!(graph.resource_of_previous(previous).is_some());
        graph.reset();
        assert_eq!(graph.access_of(view), None, "the token was issued before the reset");
        assert_eq!(graph.writer_of(written), None);
        assert_eq!(graph.resource_of_previous(previous), None);
        Ok(())
    }

    #[test]
    fn closing_a_scope_closes_those_inside() {
        let mut graph = Graph::new();
        let outer = graph.open_scope("a");
        let _inner = graph.open_scope("b");
        let deep = graph.texture("t", TextureDesc::new(Extent::FRAME, Format::R8Unorm));
        graph.close_scope(outer);
        let flat = graph.texture("t", TextureDesc::new(Extent::FRAME, Format::R8Unorm));
        let name = |t| graph.resource_of(t).map(|r| graph.resource_name(r).to_owned());
        assert_eq!((name(deep).as_deref(), name(flat).as_deref()), (Some("a/b/t"), Some("t")));
    }
}
