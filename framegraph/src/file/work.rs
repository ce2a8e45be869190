//! Passes that are spelled out: each access through the call that code would make.

use super::declare::{Declaring, Handles, not_made};
use super::error::{FileError, FileReason};
use super::form::{AccessForm, Flag, ReadForm, WorkForm, WriteForm, range};
use super::plugin::Handle;
use super::select::PassRow;
use crate::access::{AccessKind, Intent, Range};
use crate::error::{DeclareError, DeclareReason};
use crate::graph::{Graph, PassKind};
use crate::handle::{Part, ReadOnly, Texture};
use crate::pass_builder::PassBuilder;

/// Why an access was refused: by the graph, or before it was asked.
enum Refused {
    Graph(DeclareError),
    File(FileReason),
}

impl From<DeclareError> for Refused {
    fn from(error: DeclareError) -> Self {
        Self::Graph(error)
    }
}

/// The color attachments of a pass so far, by slot.
type Colors = Vec<(u8, Texture)>;

impl<'f> Declaring<'_, 'f> {
    /// Declares a pass. When an access is refused, the whole pass is, and the error stands at the access.
    pub(super) fn work(
        &self,
        row: &PassRow<'f>,
        form: &WorkForm,
        kind: PassKind,
        handles: &mut Handles,
        graph: &mut Graph,
    ) -> Result<(), FileError> {
        let mut previous = Vec::with_capacity(row.touches.len());
        for touch in &row.touches {
            previous.push(self.previous(touch, handles, graph)?);
        }
        let before: Vec<_> = row.touches.iter().map(|t| handles[t.resource]).collect();
        let mut colors = Colors::new();
        let mut at = None;
        let mut refused_by_file = None;
        let outcome = graph.add_fn(&form.name.value, |pass| {
            form.flags.iter().for_each(|flag| set(pass, *flag));
            for (touch, previous) in row.touches.iter().zip(previous) {
                at = Some(touch);
                let access = &form.accesses[touch.index];
                let current = previous.or(handles[touch.resource]);
                let written = match current.ok_or_else(|| Refused::File(not_made())) {
                    Ok(current) => declare(pass, access, current, &mut colors),
                    Err(refused) => Err(refused),
                };
                match written {
                    Ok(None) => {}
                    Ok(written) => handles[touch.resource] = written,
                    Err(Refused::Graph(error)) => return Err(error),
                    Err(Refused::File(reason)) => {
                        refused_by_file = Some(reason);
                        return Err(pass.error("", ""));
                    }
                }
            }
            at = None;
            if pass.inferred() == kind {
                return Ok(());
            }
            pass.kind(kind)
        });
        outcome.map_err(|error| {
            for (touch, handle) in row.touches.iter().zip(before) {
                handles[touch.resource] = handle;
            }
            let resource = at.map_or(error.resource, |t| self.selected.resources[t.resource].id.into());
            let reason = refused_by_file.unwrap_or(FileReason::Declare(error.reason));
            FileError { pass: row.id.into(), resource, ..self.source.error(at.map_or(row.spot, |t| t.spot), reason) }
        })
    }
}

fn set(pass: &mut PassBuilder<'_>, flag: Flag) {
    match flag {
        Flag::SideEffect => pass.side_effect(),
        Flag::Pointwise => pass.pointwise(),
        Flag::Blends => pass.blends(),
        Flag::NeverMerge => pass.never_merge(),
        Flag::TakesEpilogue => pass.takes_epilogue(),
    }
}

/// Declares one access; returns the new version of what it writes.
fn declare(
    pass: &mut PassBuilder<'_>,
    access: &AccessForm,
    current: Handle,
    colors: &mut Colors,
) -> Result<Option<Handle>, Refused> {
    use AccessForm as A;
    match access {
        A::Color(c) => {
            let range = range((c.mip, c.mips), (c.layer, c.layers), None);
            let part = match target(pass, current, access.kind(), c.intent.into(), range)? {
                Target::Done(handle) => return Ok(Some(handle)),
                Target::Texture(part) => part,
            };
            let next = colors.iter().map(|(slot, _)| slot.saturating_add(1)).max().unwrap_or(0);
            let slot = c.slot.unwrap_or(next);
            let texture = pass.color_at(slot, part, c.intent.into())?;
            colors.push((slot, texture));
            Ok(Some(Handle::Texture(texture)))
        }
        A::Resolve(r) => {
            let range = range((r.mip, r.mips), (r.layer, r.layers), None);
            let part = match target(pass, current, access.kind(), Intent::Overwrite, range)? {
                Target::Done(handle) => return Ok(Some(handle)),
                Target::Texture(part) => part,
            };
            let averaged = colors.iter().find(|(slot, _)| *slot == r.slot);
            let Some((_, averaged)) = averaged else {
                let reason = DeclareReason::NothingToResolve;
                return Err(Refused::File(FileReason::Declare(reason)));
            };
            Ok(Some(Handle::Texture(pass.resolve(*averaged, part)?)))
        }
        A::Depth(w) | A::StorageWrite(w) | A::CopyTarget(w) => write(pass, access.kind(), w, current).map(Some),
        A::DepthReadOnly(r)
        | A::SamePixel(r)
        | A::Sampled(r)
        | A::StorageRead(r)
        | A::Uniform(r)
        | A::Vertex(r)
        | A::Index(r)
        | A::Indirect(r)
        | A::CopySource(r) => read(pass, access.kind(), r, current).map(|()| None),
    }
}

enum Target {
    Texture(Part),
    Done(Handle),
}

/// The part to write; a buffer is written on the spot (or refused, since attachments are textures).
fn target(
    pass: &mut PassBuilder<'_>,
    current: Handle,
    kind: AccessKind,
    intent: Intent,
    range: Range,
) -> Result<Target, Refused> {
    match current {
        Handle::Texture(texture) => Ok(Target::Texture(texture.range(range))),
        Handle::Buffer(buffer) => {
            whole(range)?;
            let buffer = pass.write_buffer(buffer, kind, intent)?;
            Ok(Target::Done(Handle::Buffer(buffer)))
        }
        Handle::ReadOnly(_) => Err(Refused::File(FileReason::Declare(DeclareReason::Conflict {
            earlier: "an earlier frame's image",
            later: kind.word(),
        }))),
    }
}

fn whole(range: Range) -> Result<(), Refused> {
    if range.is_all() {
        return Ok(());
    }
    Err(Refused::File(FileReason::Value {
        detail: "a buffer has no levels, layers or aspects".into(),
        hint: "remove them from the access".into(),
    }))
}

fn write(pass: &mut PassBuilder<'_>, kind: AccessKind, form: &WriteForm, current: Handle) -> Result<Handle, Refused> {
    let range = range((form.mip, form.mips), (form.layer, form.layers), form.aspect);
    let intent = form.intent.into();
    let part = match target(pass, current, kind, intent, range)? {
        Target::Done(handle) => return Ok(handle),
        Target::Texture(part) => part,
    };
    let texture = match kind {
        AccessKind::Depth => pass.depth(part, intent)?,
        AccessKind::StorageWrite => pass.storage_write(part, intent)?,
        _ => pass.copy_target(part, intent)?,
    };
    Ok(Handle::Texture(texture))
}

fn read(pass: &mut PassBuilder<'_>, kind: AccessKind, form: &ReadForm, current: Handle) -> Result<(), Refused> {
    let range = range((form.mip, form.mips), (form.layer, form.layers), form.aspect);
    let texture = match current {
        Handle::Buffer(buffer) => {
            whole(range)?;
            pass.read_buffer(buffer, kind)?;
            return Ok(());
        }
        Handle::Texture(texture) => texture.range(range).read_only(),
        Handle::ReadOnly(texture) => ReadOnly { range, ..texture },
    };
    match kind {
        AccessKind::DepthReadOnly => pass.depth_read_only(texture)?,
        AccessKind::SamePixel => pass.same_pixel(texture)?,
        AccessKind::Sampled => pass.sampled(texture)?,
        AccessKind::StorageRead => pass.storage_read(texture)?,
        AccessKind::CopySource => pass.copy_source(texture)?,
        _ => {
            let format = pass.desc(texture)?.format;
            let access = kind.word();
            let reason = DeclareReason::Format { format, access };
            return Err(Refused::File(FileReason::Declare(reason)));
        }
    };
    Ok(())
}

impl AccessForm {
    /// The kind that it spells.
    pub(super) const fn kind(&self) -> AccessKind {
        match self {
            Self::Color(_) => AccessKind::Color,
            Self::Depth(_) => AccessKind::Depth,
            Self::DepthReadOnly(_) => AccessKind::DepthReadOnly,
            Self::Resolve(_) => AccessKind::Resolve,
            Self::SamePixel(_) => AccessKind::SamePixel,
            Self::Sampled(_) => AccessKind::Sampled,
            Self::StorageRead(_) => AccessKind::StorageRead,
            Self::StorageWrite(_) => AccessKind::StorageWrite,
            Self::Uniform(_) => AccessKind::Uniform,
            Self::Vertex(_) => AccessKind::Vertex,
            Self::Index(_) => AccessKind::Index,
            Self::Indirect(_) => AccessKind::Indirect,
            Self::CopySource(_) => AccessKind::CopySource,
            Self::CopyTarget(_) => AccessKind::CopyTarget,
        }
    }
}
