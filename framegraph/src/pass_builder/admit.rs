//! What a single access can be refused for.

use super::request::{Manner, Request};
use crate::access::{Access, AccessKind, Kinds, Range};
use crate::error::DeclareReason;
use crate::graph::{PassKind, Tables};
use crate::resource::{Desc, Dimension, Kind, Resource, TextureDesc, halved};

/// Two accesses of one pass to one resource exclude each other when they overlap and one of them writes.
pub(super) fn conflicts(row: &Resource, earlier: &Access, later: &Request) -> bool {
    if !earlier.mode.writes() && !later.manner.mode.writes() {
        return false;
    }
    match &row.desc {
        Desc::Buffer(_) => true,
        Desc::Texture(t) => earlier.range.overlaps(&later.range, t.format),
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

/// Copies are a pass of their own, whether its kind is named or not: neither can follow the other's accesses.
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

/// The kind of a pass that makes accesses of the kinds in `used`.
pub(super) const fn inferred_kind(used: Kinds) -> PassKind {
    if used.meets(Kinds::RASTER) {
        PassKind::Raster
    } else if used.meets(Kinds::COPIES) {
        PassKind::Copy
    } else {
        PassKind::Compute
    }
}

/// The kinds that a pass of that kind cannot make, or not without every check.
pub(super) const fn barred(kind: PassKind) -> Kinds {
    match kind {
        PassKind::Raster => Kinds::COPIES,
        PassKind::Compute => Kinds::COPIES.union(Kinds::RASTER),
        PassKind::Copy => Kinds::ALL.without(Kinds::COPIES),
    }
}

/// What the resource's shape or kind rules out.
pub(super) fn incapable(row: &Resource, r: &Request) -> Option<DeclareReason> {
    let Manner { kind: access, mode, .. } = r.manner;
    if let (Kind::HistoryPrevious { .. }, true) = (row.kind, mode.writes()) {
        return Some(DeclareReason::WritesEarlierFrame { access });
    }
    if Kinds::READS.has(Kinds::one(access)) == mode.writes() {
        return Some(DeclareReason::WrongDirection { access });
    }
    match &row.desc {
        Desc::Buffer(_) => {
            let fits = Kinds::OF_BUFFERS.has(Kinds::one(access));
            (!fits).then_some(DeclareReason::Buffer { access })
        }
        Desc::Texture(t) => texture_incapable(t, r),
    }
}

fn texture_incapable(t: &TextureDesc, r: &Request) -> Option<DeclareReason> {
    let access = r.manner.kind;
    let Range { mip, mips, layer, layers, aspect } = r.range;
    let outside = |first: u32, count: u32, all: bool, has: u32| {
        if all { first >= has } else { count == 0 || first + count > has }
    };
    let has_mips = if t.mips == TextureDesc::ALL_MIPS { 32 } else { u32::from(t.mips) };
    if outside(mip.into(), mips.into(), mips == u8::MAX, has_mips)
        || outside(layer.into(), layers.into(), layers == u16::MAX, t.tracked_layers())
        || !aspect.exists_in(t.format)
    {
        return Some(DeclareReason::OutOfRange { asked: r.range, texture: *t });
    }
    let one_level = mips == 1 || (mips == u8::MAX && mip == 0 && t.mips == 1);
    let in_tile = Kinds::TILE.has(Kinds::one(access));
    if in_tile && !one_level {
        return Some(DeclareReason::NotOneLevel { access });
    }
    if in_tile && t.dimension == Dimension::D3 && halved(t.layers.into(), mip.into()) > 1 {
        return Some(DeclareReason::Slices { access });
    }
    let capable = Kinds::of_format(t.format).has(Kinds::one(access));
    (!capable).then_some(DeclareReason::Format { format: t.format, access })
}
