//! Passes with listed accesses: each access uses the same method as code.

use super::access_form::{AccessForm, ResolvedPlane};
use super::declare::{Declaring, Handles};
use super::error::{FileError, FileReason};
use super::form::{Flag, WorkForm};
use super::plugin::Handle;
use super::selected::{PassRow, Wanted};
use super::value::ValueReason;
use crate::access::{Access, AccessKind, Intent, Range};
use crate::error::{DeclareError, DeclareReason};
use crate::graph::{Graph, PassKind};
use crate::handle::{BufferPart, ReadOnly, Texture};
use crate::pass_builder::{MAX_COLORS, PassBuilder};

/// Reason why an access is invalid: reported by the graph, or found before.
enum Refused {
    Graph(DeclareError),
    File(FileReason),
}

impl From<DeclareError> for Refused {
    fn from(error: DeclareError) -> Self {
        Self::Graph(error)
    }
}

impl From<DeclareReason> for Refused {
    fn from(reason: DeclareReason) -> Self {
        Self::File(FileReason::Declare(reason))
    }
}

impl From<ValueReason> for Refused {
    fn from(fault: ValueReason) -> Self {
        Self::File(FileReason::Value(fault))
    }
}

/// The attachments of a pass so far by slot; depth as [`Access::DEPTH`].
type Attached = Vec<(u8, Texture)>;

impl<'f> Declaring<'_, 'f> {
    /// Declares a pass. An invalid access rejects the whole pass; the error has the position of the access.
    pub(super) fn work(
        &self,
        row: &PassRow<'f>,
        form: &WorkForm,
        kind: PassKind,
        handles: &mut Handles,
        graph: &mut Graph,
    ) -> Result<(), FileError> {
        let mut previous = Vec::with_capacity(row.mentions.len());
        for mention in &row.mentions {
            previous.push(self.previous(mention, handles, graph)?);
        }
        let before: Vec<_> = row.mentions.iter().map(|m| handles[m.resource]).collect();
        let mut attached = Attached::new();
        let mut current = None;
        let mut refused_by_file = None;
        let outcome = graph.add_fn(&form.name.value, |pass| {
            form.flags.iter().for_each(|flag| set(pass, *flag));
            for (mention, previous) in row.mentions.iter().zip(previous) {
                current = Some(mention);
                let access = &form.accesses[mention.index];
                let handle = previous.or(handles[mention.resource]);
                match declare(pass, access, handle, mention.version == Wanted::Entry, &mut attached) {
                    Ok(None) => {}
                    Ok(written) => handles[mention.resource] = written,
                    Err(Refused::Graph(error)) => return Err(error),
                    Err(Refused::File(reason)) => {
                        refused_by_file = Some(reason);
                        return Err(pass.error("", ""));
                    }
                }
            }
            current = None;
            if pass.inferred() == kind { Ok(()) } else { pass.kind(kind) }
        });
        outcome.map_err(|error| {
            for (mention, handle) in row.mentions.iter().zip(before) {
                handles[mention.resource] = handle;
            }
            let reason = refused_by_file.unwrap_or(FileReason::Declare(error.reason));
            let named = error.resource.map(|r| r.name);
            let resource = current.map(|m| self.selected.resources[m.resource].to_owned()).or(named);
            let refused = self.source.error(current.map_or(row.id, |m| m.at), reason).of_pass(&row.id.value);
            FileError { resource, ..refused }
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
        Flag::MainQueue => pass.main_queue(),
    }
}

/// Declares one access. Returns the new version of a written resource.
fn declare(
    pass: &mut PassBuilder<'_>,
    access: &AccessForm,
    handle: Option<Handle>,
    entry: bool,
    attached: &mut Attached,
) -> Result<Option<Handle>, Refused> {
    let AccessForm { kind, bytes, slot, samples, mode, .. } = *access;
    let (range, intent) = (access.range(), access.intent.map(Intent::from));
    let missing = || if entry { ValueReason::MadeEmpty } else { ValueReason::MadeLater };
    let (texture, intent) = match (handle.ok_or_else(missing)?, intent) {
        (Handle::Buffer(_), _) if range != Range::ALL => return Err(ValueReason::BufferRange.into()),
        (Handle::Buffer(buffer), intent) => {
            let part = BufferPart { buffer, bytes };
            return Ok(match intent {
                Some(intent) => Some(Handle::Buffer(pass.write_buffer(part, kind, intent)?)),
                None => pass.read_buffer(part, kind).map(|_| None)?,
            });
        }
        _ if bytes.is_some() => return Err(ValueReason::TextureBytes.into()),
        (Handle::Texture(texture), None) => {
            read(pass, kind, texture.range(range).read_only())?;
            attached.extend((kind == AccessKind::DepthReadOnly).then_some((Access::DEPTH, texture)));
            return Ok(None);
        }
        (Handle::ReadOnly(texture), None) => {
            read(pass, kind, ReadOnly { range, ..texture })?;
            return Ok(None);
        }
        (Handle::ReadOnly(_), Some(_)) => return Err(DeclareReason::WritesEarlierFrame { access: kind }.into()),
        (Handle::Texture(texture), Some(intent)) => (texture.range(range), intent),
    };
    let written = match kind {
        AccessKind::Color => {
            let free = |slot: &u8| attached.iter().all(|(taken, _)| taken != slot);
            let colors = attached.iter().filter(|(slot, _)| *slot != Access::DEPTH);
            let next = colors.map(|(slot, _)| slot.saturating_add(1)).max().unwrap_or(0);
            let next = if next < MAX_COLORS { Some(next) } else { (0..MAX_COLORS).find(free) };
            let slot = slot.or(next).ok_or(DeclareReason::TooManyColors)?;
            let written = pass.color_at(slot, texture, intent)?;
            attached.push((slot, written));
            written
        }
        AccessKind::Resolve => {
            let color = slot.filter(|slot| *slot < MAX_COLORS);
            let slot = samples.map_or(color, |ResolvedPlane::Depth| Some(Access::DEPTH));
            let samples = attached.iter().find(|(at, _)| Some(*at) == slot);
            let (_, samples) = samples.ok_or(DeclareReason::NothingToResolve)?;
            pass.resolve_as(mode, *samples, texture)?
        }
        AccessKind::Depth => {
            let written = pass.depth(texture, intent)?;
            attached.push((Access::DEPTH, written));
            written
        }
        AccessKind::StorageWrite => pass.storage_write(texture, intent)?,
        _ => pass.copy_target(texture, intent)?,
    };
    Ok(Some(Handle::Texture(written)))
}

/// Declares one read of a texture.
fn read(pass: &mut PassBuilder<'_>, kind: AccessKind, texture: ReadOnly) -> Result<(), Refused> {
    match kind {
        AccessKind::DepthReadOnly => pass.depth_read_only(texture)?,
        AccessKind::SamePixel => pass.same_pixel(texture)?,
        AccessKind::Sampled => pass.sampled(texture)?,
        AccessKind::StorageRead => pass.storage_read(texture)?,
        AccessKind::CopySource => pass.copy_source(texture)?,
        _ => return Err(DeclareReason::Texture { access: kind }.into()),
    };
    Ok(())
}
