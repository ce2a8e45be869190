//! Validity checks of a single access.

use super::request::{AccessDesc, Request};
use crate::access::{Access, AccessKind, Kinds, Range};
use crate::error::DeclareReason;
use crate::graph::{PassKind, Tables};
use crate::resource::{BufferDesc, BufferSize, Desc, Dimension, Kind, Resource, TextureDesc, halved};

/// Returns `true` if two accesses of one pass to one resource conflict: they overlap, and one of them writes.
///
/// A buffer has one usage during a pass (WebGPU's usage scopes). Next to a write, other bytes of the buffer may only be
/// accessed in the same way.
pub(super) fn conflicts(tables: &Tables, earlier: &Access, later: &Request) -> bool {
    if !earlier.mode.writes() && !later.desc.mode.writes() {
        return false;
    }
    match &tables.resources[earlier.resource.index()].desc {
        Desc::Texture(t) => earlier.range.overlaps(&later.range, t.format),
        Desc::Buffer(_) => {
            let bytes = tables.bytes_of(earlier).zip(later.bytes);
            let apart = bytes.is_some_and(|(earlier, (offset, bytes))| {
                offset >= earlier.end() || earlier.offset >= offset.saturating_add(bytes)
            });
            !apart || earlier.kind != later.desc.kind
        }
    }
}

pub(super) fn wrong_kind(kind: PassKind, access: AccessKind) -> Option<DeclareReason> {
    let copies = matches!(access, AccessKind::CopySource | AccessKind::CopyTarget);
    let fits = match kind {
        PassKind::Raster => !copies,
        PassKind::Compute => !copies && !access.needs_raster(),
        PassKind::Copy => copies,
    };
    (!fits).then_some(DeclareReason::WrongPassKind { kind, access })
}

/// Checks that copies do not share a pass with other accesses, even if the pass has no explicit kind.
pub(super) fn mixed(tables: &Tables, own: &[Access], used: Kinds, access: AccessKind) -> Option<DeclareReason> {
    let copy = Kinds::COPIES.has(Kinds::one(access));
    let others = if copy { Kinds::ALL.without(Kinds::COPIES) } else { Kinds::COPIES };
    if !used.meets(others) {
        return None;
    }
    let earlier = own.iter().find(|a| others.has(Kinds::one(a.kind)))?;
    Some(DeclareReason::MixedKinds {
        earlier: earlier.kind,
        of: tables.resource_name(earlier.resource).to_owned(),
        later: access,
    })
}

/// Returns the kind of a pass with accesses of the kinds in `used`.
pub(super) const fn inferred_kind(used: Kinds) -> PassKind {
    if used.meets(Kinds::RASTER) {
        PassKind::Raster
    } else if used.meets(Kinds::COPIES) {
        PassKind::Copy
    } else {
        PassKind::Compute
    }
}

/// Returns the access kinds that passes of this kind may not use, or not without the full check.
pub(super) const fn barred(kind: PassKind) -> Kinds {
    match kind {
        PassKind::Raster => Kinds::COPIES,
        PassKind::Compute => Kinds::COPIES.union(Kinds::RASTER),
        PassKind::Copy => Kinds::ALL.without(Kinds::COPIES),
    }
}

/// Returns the reason why the resource does not support the access, if any.
pub(super) fn incapable(row: &Resource, r: &Request) -> Option<DeclareReason> {
    let AccessDesc { kind: access, mode, .. } = r.desc;
    if let (Kind::HistoryPrevious { .. }, true) = (row.kind, mode.writes()) {
        return Some(DeclareReason::WritesEarlierFrame { access });
    }
    if Kinds::READS.has(Kinds::one(access)) == mode.writes() {
        return Some(DeclareReason::WrongDirection { access });
    }
    match &row.desc {
        Desc::Buffer(buffer) => {
            let fits = Kinds::OF_BUFFERS.has(Kinds::one(access));
            if fits { outside(buffer, r) } else { Some(DeclareReason::Buffer { access }) }
        }
        Desc::Texture(t) => texture_incapable(t, r),
    }
}

/// Checks that a byte range lies inside the buffer, as far as its size is known without the frame size.
fn outside(buffer: &BufferDesc, r: &Request) -> Option<DeclareReason> {
    let (offset, bytes) = r.bytes?;
    let size = match buffer.size {
        BufferSize::Bytes(size) => Some(size),
        BufferSize::PerTexel { .. } => None,
    };
    let fits = bytes != 0 && offset.checked_add(bytes).is_some_and(|end| end <= size.unwrap_or(u64::MAX));
    (!fits).then_some(DeclareReason::NoSuchBytes { offset, bytes, size })
}

fn texture_incapable(t: &TextureDesc, r: &Request) -> Option<DeclareReason> {
    let access = r.desc.kind;
    let Range { mip, mips, layer, layers, aspect, view, bytes: _, slice: _ } = r.range;
    let outside = |first: u32, count: u32, all: bool, has: u32| {
        if all { first >= has } else { count == 0 || first + count > has }
    };
    // Slices of three-dimensional textures are numbered like layers. Only attachments can name one.
    let volume = t.dimension == Dimension::D3;
    let slices = if volume { halved(t.layers.into(), mip.into()) } else { t.tracked_layers() };
    let names_slice = volume && (layer != 0 || layers != u16::MAX) && slices > 1;
    let has_mips = if t.mips == TextureDesc::ALL_MIPS { 32 } else { u32::from(t.mips) };
    if outside(mip.into(), mips.into(), mips == u8::MAX, has_mips)
        || outside(layer.into(), layers.into(), layers == u16::MAX, slices)
        || !aspect.exists_in(t.format)
    {
        return Some(DeclareReason::OutOfRange { asked: r.range, texture: *t });
    }
    let one_level = mips == 1 || (mips == u8::MAX && mip == 0 && t.mips == 1);
    let in_tile = Kinds::TILE.has(Kinds::one(access));
    if in_tile && !one_level {
        return Some(DeclareReason::NotOneLevel { access });
    }
    let one_slice = access == AccessKind::Color && layers == 1;
    if volume && slices > 1 && !one_slice && (in_tile || names_slice) {
        return Some(DeclareReason::Slices { access });
    }
    let seen = view.unwrap_or(t.format);
    if seen.without_srgb() != t.format.without_srgb() {
        return Some(DeclareReason::NoTwin { format: t.format, view: seen });
    }
    let incapable = [t.format, seen].into_iter().find(|f| !Kinds::of_format(*f).has(Kinds::one(access)));
    incapable.map(|format| DeclareReason::Format { format, access })
}
