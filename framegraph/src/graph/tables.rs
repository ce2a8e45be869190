//! The flat arrays of a graph, filled by declaring and read by everything else.

use super::rows::{Declared, Export, Note, Version};
use crate::access::{Access, ByteRange, ClearValue, Range};
use crate::error::{DeclareError, Named};
use crate::handle::Tag;
use crate::id::{PassId, ResourceId, VersionId};
use crate::resource::{Desc, Resource};

/// Everything declared for a frame, as flat arrays. A [`Graph`](super::Graph) dereferences to it.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    pub(crate) tag: Tag,
    pub(crate) names: String,
    pub(crate) passes: Vec<Declared>,
    pub(crate) accesses: Vec<Access>,
    pub(crate) resources: Vec<Resource>,
    pub(crate) versions: Vec<Version>,
    pub(crate) clears: Vec<ClearValue>,
    pub(crate) byte_ranges: Vec<ByteRange>,
    pub(crate) exports: Vec<Export>,
    pub(crate) notes: Vec<Note>,
    /// Pairs of a forwarded texture, which no longer exists, and the texture it was forwarded to.
    pub(crate) forwards: Vec<(ResourceId, ResourceId)>,
    /// Pairs of imports that may be bound to one texture or buffer.
    pub(crate) aliases: Vec<(ResourceId, ResourceId)>,
    /// Errors of methods that do not return a `Result`. The compiler reports them.
    pub(crate) errors: Vec<DeclareError>,
    /// An access names part of a resource, or reads contents that no pass of this frame wrote. The validation phase
    /// then has to check reads of undefined contents.
    pub(crate) contents_uncertain: bool,
    /// At least one pass resolves multisampled attachments.
    pub(crate) resolves: bool,
}

impl Tables {
    /// Clears every array and keeps its memory.
    pub(super) fn clear(&mut self) {
        let Self {
            tag: _,
            names,
            passes,
            accesses,
            resources,
            versions,
            clears,
            byte_ranges,
            exports,
            notes,
            forwards,
            aliases,
            errors,
            contents_uncertain,
            resolves,
        } = self;
        names.clear();
        passes.clear();
        accesses.clear();
        resources.clear();
        versions.clear();
        clears.clear();
        byte_ranges.clear();
        exports.clear();
        notes.clear();
        forwards.clear();
        aliases.clear();
        errors.clear();
        *contents_uncertain = false;
        *resolves = false;
    }

    /// Copies the tables that later phases read: all except names, notes, clear values and errors. Reuses the memory of
    /// `self`.
    pub(crate) fn copy_work(&mut self, source: &Self) {
        self.passes.clone_from(&source.passes);
        self.accesses.clone_from(&source.accesses);
        self.resources.clone_from(&source.resources);
        self.versions.clone_from(&source.versions);
        self.byte_ranges.clone_from(&source.byte_ranges);
        self.exports.clone_from(&source.exports);
        self.forwards.clone_from(&source.forwards);
        self.aliases.clone_from(&source.aliases);
        self.resolves = source.resolves;
    }

    /// The declared passes, in declaration order.
    pub fn passes(&self) -> &[Declared] {
        &self.passes
    }

    /// The accesses of all passes; each pass owns a span.
    pub fn accesses(&self) -> &[Access] {
        &self.accesses
    }

    /// The accesses of one pass.
    ///
    /// # Panics
    /// Panics if `pass` does not belong to this graph.
    pub fn accesses_of(&self, pass: PassId) -> &[Access] {
        self.passes[pass.index()].accesses.of(&self.accesses)
    }

    /// The declared resources.
    pub fn resources(&self) -> &[Resource] {
        &self.resources
    }

    /// All versions of all resources, in the order of their creation.
    pub fn versions(&self) -> &[Version] {
        &self.versions
    }

    /// The clear values that accesses refer to.
    pub fn clears(&self) -> &[ClearValue] {
        &self.clears
    }

    /// The buffer ranges that accesses refer to.
    pub fn byte_ranges(&self) -> &[ByteRange] {
        &self.byte_ranges
    }

    /// Returns the buffer range of an access; `None` for a whole buffer or a texture.
    pub fn bytes_of(&self, access: &Access) -> Option<ByteRange> {
        self.byte_ranges.get(access.range.bytes.index()).copied()
    }

    /// Returns `true` if two ranges of a resource share a subresource or a byte.
    pub fn overlap(&self, resource: ResourceId, a: &Range, b: &Range) -> bool {
        match &self.resources[resource.index()].desc {
            Desc::Texture(texture) => a.overlaps(b, texture.format),
            Desc::Buffer(_) => {
                let bytes = |range: &Range| self.byte_ranges.get(range.bytes.index());
                bytes(a).zip(bytes(b)).is_none_or(|(a, b)| a.overlaps(b))
            }
        }
    }

    /// The exported resources.
    pub fn exports(&self) -> &[Export] {
        &self.exports
    }

    /// The notes of [`Graph::note`](super::Graph::note), as pairs of subject and text.
    pub fn notes(&self) -> impl ExactSizeIterator<Item = (&str, &str)> {
        self.notes.iter().map(|note| (&self.names[note.about.range()], &self.names[note.text.range()]))
    }

    /// Returns the full name of a pass, including its scopes: `effect/pass`.
    ///
    /// # Panics
    /// Panics if `pass` does not belong to this graph.
    pub fn pass_name(&self, pass: PassId) -> &str {
        &self.names[self.passes[pass.index()].name.range()]
    }

    /// Returns the full name of a resource, including its scopes.
    ///
    /// # Panics
    /// Panics if `resource` does not belong to this graph.
    pub fn resource_name(&self, resource: ResourceId) -> &str {
        &self.names[self.resources[resource.index()].name.range()]
    }

    /// Returns the id and name of a pass for an error; `None` if `pass` is none.
    pub(crate) fn named_pass(&self, pass: PassId) -> Option<Named<PassId>> {
        pass.some().map(|id| Named { id, name: self.pass_name(id).to_owned() })
    }

    /// Returns the id and name of a resource for an error; `None` if `resource` is none.
    pub(crate) fn named_resource(&self, resource: ResourceId) -> Option<Named<ResourceId>> {
        resource.some().map(|id| Named { id, name: self.resource_name(id).to_owned() })
    }

    /// The ids of all passes.
    pub fn pass_ids(&self) -> impl DoubleEndedIterator<Item = PassId> + ExactSizeIterator + use<> {
        (0..self.passes.len()).map(PassId::at)
    }

    /// The ids of all resources.
    pub fn resource_ids(&self) -> impl DoubleEndedIterator<Item = ResourceId> + ExactSizeIterator + use<> {
        (0..self.resources.len()).map(ResourceId::at)
    }

    /// Returns the first pass with this full name.
    pub fn find_pass(&self, name: &str) -> Option<PassId> {
        self.pass_ids().find(|p| self.pass_name(*p) == name)
    }

    /// Returns the first resource with this full name.
    pub fn find_resource(&self, name: &str) -> Option<ResourceId> {
        self.resource_ids().find(|r| self.resource_name(*r) == name)
    }

    /// Returns the resource of a version; `None` if the handle belongs to another graph.
    pub(crate) fn lookup(&self, tag: Tag, version: VersionId) -> Option<ResourceId> {
        (tag == self.tag).then(|| self.versions.get(version.index()).map(|v| v.resource)).flatten()
    }

    /// Implements [`Graph::same_as`](super::Graph::same_as).
    pub(super) fn same_as(&self, other: &Self) -> bool {
        self.passes == other.passes
            && self.accesses == other.accesses
            && self.resources == other.resources
            && self.exports == other.exports
            && self.notes == other.notes
            && self.forwards == other.forwards
            && self.aliases == other.aliases
            && self.versions == other.versions
            && self.names == other.names
            && self.clears == other.clears
            && self.byte_ranges == other.byte_ranges
    }
}
