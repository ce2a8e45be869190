//! Forwarding: replaces a texture by another one after passes have written it.
//!
//! Corresponds to Filament's `forwardResource`. A pass draws into its own texture; later the application replaces that
//! texture by the swapchain image, or by a level of a mip chain. The declared accesses are rewritten in place, so the
//! compiler and the back end need no support for it.

use crate::access::{Access, Kinds, Range};
use crate::error::{DeclareError, DeclareReason, ForwardReason, StaleUser};
use crate::graph::{Graph, Tables};
use crate::handle::{Part, Texture};
use crate::id::{ResourceId, VersionId};
use crate::resource::{Dimension, Kind, TextureDesc, halved};
use std::panic::Location;

impl Graph {
    /// Replaces `texture` by `into` in all passes declared so far. The passes then use the size and format of `into`.
    /// Returns the newest version of `into`; `texture` no longer exists.
    ///
    /// ```
    /// use framegraph::{ClearValue, DeclareError, Entry, Exit, Extent, Format, Graph, Intent, TextureDesc};
    ///
    /// let mut graph = Graph::new();
    /// let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
    /// let screen = graph.import_texture("screen", desc, Entry::Undefined, Exit::Keep);
    /// let picture = graph.add_fn("post", |pass| {
    ///     let picture = pass.texture("picture", desc);
    ///     pass.color(picture, Intent::Clear(ClearValue::BLACK))
    /// })?;
    /// // No pass follows that filters the picture: it is what the screen shows.
    /// let screen = graph.forward(picture, screen)?;
    /// # let _ = screen;
    /// # Ok::<(), DeclareError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if
    ///
    /// - a handle is stale or belongs to another graph,
    /// - `texture` is not transient, not written or exported,
    /// - `texture` has several levels or layers, unless `into` is a whole texture of the same shape,
    /// - `into` covers several levels, layers or slices while `texture` has one,
    /// - the format of `into` does not support an access of `texture`,
    /// - `into` was declared after the first pass that wrote `texture`, or
    /// - another pass accessed `into` after the first access of `texture`.
    ///
    /// One exception to the last rule: passes may read `into` after the last access of `texture` if no pass has written
    /// `into`. They then read the forwarded contents.
    #[track_caller]
    pub fn forward(&mut self, texture: Texture, into: impl Into<Part>) -> Result<Texture, DeclareError> {
        let (into, location) = (into.into(), Location::caller());
        let (tables, _) = self.tables_mut();
        let refused = |tables: &Tables, reason, resource| DeclareError {
            reason,
            pass: None,
            resource: tables.named_resource(resource),
            location,
        };
        let newest = |tables: &Tables, t: Texture| {
            let resource = tables.lookup(t.tag, t.version);
            let resource = resource.ok_or_else(|| refused(tables, DeclareReason::Foreign, ResourceId::NONE))?;
            let current = tables.resources[resource.index()].current;
            if current == t.version {
                return Ok(resource);
            }
            let writer = tables.writer_name(current).to_owned();
            Err(refused(tables, DeclareReason::Stale { writer, user: StaleUser::Graph }, resource))
        };
        let from = newest(tables, texture)?;
        let to = newest(tables, into.texture)?;
        match tables.forwarded(from, to, into.range) {
            Ok(move_to) => {
                tables.move_accesses(from, to, move_to);
                Ok(texture)
            }
            Err(fault) => Err(refused(tables, DeclareReason::Forward(fault), from)),
        }
    }
}

/// Result of the checks: how to rewrite the accesses of a forwarded texture.
struct Move {
    /// The range that replaces that of each access; `None` to keep the ranges.
    range: Option<Range>,
    /// Passes read the target after the last access of the texture, and none before the first.
    read_behind: bool,
}

impl Tables {
    /// Checks a forward and returns how to rewrite the accesses.
    fn forwarded(&self, from: ResourceId, to: ResourceId, range: Range) -> Result<Move, ForwardReason> {
        let row = &self.resources[from.index()];
        let (Some(own), Some(target)) = (row.desc.texture(), self.resources[to.index()].desc.texture()) else {
            return Err(ForwardReason::NotTransient);
        };
        let written = self.versions[row.current.index()].writer.some().is_some();
        if from == to || row.kind != Kind::Transient || self.exports.iter().any(|e| e.resource == from) {
            return Err(ForwardReason::NotTransient);
        }
        if !written {
            return Err(ForwardReason::Unwritten);
        }
        let range = place(own, target, range)?;
        let of = |resource| move |(_, a): &(usize, &Access)| a.resource == resource;
        let uses = |resource| self.accesses.iter().enumerate().filter(of(resource)).map(|(index, _)| index);
        let (first, last) = (uses(from).next().unwrap_or_default(), uses(from).next_back().unwrap_or_default());
        let declared = self.resources[to.index()].current;
        let newer = uses(from).any(|index| self.accesses[index].version < declared);
        if newer {
            return Err(ForwardReason::TargetLater);
        }
        let of_pass = |index: usize| self.passes.partition_point(|p| (p.accesses.start as usize) <= index) - 1;
        let before = uses(to).all(|index| of_pass(index) < of_pass(first));
        let unwritten = self.versions[declared.index()].writer.is_none();
        let open = unwritten && !self.resources[to.index()].kind.defined_on_entry();
        let behind = open && uses(to).all(|index| of_pass(index) > of_pass(last));
        if !before && !behind {
            return Err(ForwardReason::Interleaved);
        }
        for index in uses(from) {
            let access = &self.accesses[index];
            let seen = access.range.view.unwrap_or(target.format);
            let fits = seen.without_srgb() == target.format.without_srgb();
            let capable = Kinds::of_format(target.format).has(Kinds::one(access.kind));
            if !fits || !capable {
                return Err(ForwardReason::Format { format: target.format, access: access.kind });
            }
        }
        Ok(Move { range, read_behind: !before })
    }

    /// Rewrites the accesses of `from` to access `to`.
    fn move_accesses(&mut self, from: ResourceId, to: ResourceId, Move { range, read_behind }: Move) {
        let (newest, target) = (self.resources[from.index()].current, self.resources[to.index()].current);
        let desc = self.resources[to.index()].desc;
        // The initial contents of the forwarded texture become those of the target.
        let entry = |v: VersionId, versions: &[crate::graph::Version]| versions[v.index()].writer.is_none();
        for access in &mut self.accesses {
            if access.resource == to && read_behind {
                access.version = newest;
            }
            if access.resource != from {
                continue;
            }
            access.resource = to;
            if entry(access.version, &self.versions) {
                access.version = target;
            }
            if let Some(range) = range {
                access.range = Range { view: access.range.view, aspect: access.range.aspect, ..range };
            }
            if let Some(texture) = desc.texture() {
                access.range = access.range.canonical(texture);
            }
        }
        for version in 0..self.versions.len() {
            let row = self.versions[version];
            if row.resource == from && row.writer.some().is_some() {
                self.versions[version].resource = to;
                if entry(row.previous, &self.versions) {
                    self.versions[version].previous = target;
                }
            }
        }
        self.versions[target.index()].allowed = Kinds::NONE;
        self.versions[newest.index()].allowed =
            Kinds::on_entry(&desc, self.resources[to.index()].kind).union(Kinds::DEFINED);
        self.resources[to.index()].current = newest;
        // Every handle of the forwarded texture is stale now.
        self.resources[from.index()].current = VersionId::NONE;
        self.forwards.push((from, to));
        self.contents_uncertain = true;
        self.mark_aliased();
        for pass in &mut self.passes {
            let sole = self.accesses.get(pass.sole_color.index());
            if sole.is_some_and(|a| a.resource == to) {
                pass.sole_color = crate::id::AccessId::NONE;
            }
        }
    }

    /// Returns the texture that a resource was forwarded to, if any.
    pub fn forward_of(&self, resource: ResourceId) -> Option<ResourceId> {
        self.forwards.iter().find(|(from, _)| *from == resource).map(|(_, to)| *to)
    }
}

/// Returns the range for accesses to a texture of shape `own`; `None` to keep their ranges.
fn place(own: &TextureDesc, target: &TextureDesc, range: Range) -> Result<Option<Range>, ForwardReason> {
    let shape = |t: &TextureDesc| (t.mips, t.layers, t.dimension);
    if range.canonical(target).is_all() && shape(own) == shape(target) {
        return Ok(None);
    }
    let (mips, layers) = (range.mip_range(target.mips.into()), range.layer_range(target.tracked_layers()));
    let one = mips.len() == 1 && layers.len() == 1 && range.view.is_none();
    let inside = mips.end <= u32::from(target.mips) && layers.end <= target.tracked_layers();
    if target.dimension == Dimension::D3 && halved(target.layers.into(), range.mip.into()) != u32::from(own.layers) {
        return Err(ForwardReason::Slices);
    }
    let flat = own.mips == 1 && own.layers == 1 && own.dimension == target.dimension;
    let all_levels = target.mips == TextureDesc::ALL_MIPS && range.mips == 1;
    if flat && (one && inside || all_levels && layers.len() == 1 && range.view.is_none()) {
        let (mip, layer) = (range.mip, range.layer);
        return Ok(Some(Range { mip, mips: 1, layer, layers: 1, ..Range::ALL }));
    }
    Err(ForwardReason::Parts)
}
