//! What a single access can be refused for.

use super::Request;
use crate::access::{Access, AccessKind, Range};
use crate::error::DeclareReason;
use crate::format::Format;
use crate::graph::{PassKind, Tables};
use crate::resource::{Desc, Kind, Resource, TextureDesc};

/// Two accesses of one pass to one resource exclude each other when they overlap and one of them writes.
pub(super) fn conflicts(row: &Resource, earlier: &Access, later: &Request) -> bool {
    if !earlier.mode.writes() && !later.mode.writes() {
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
    (!fits).then(|| DeclareReason::WrongPassKind { kind: kind.word(), access: access.word() })
}

/// Copies are a pass of their own, whether its kind is named or not: neither can follow the other's accesses.
pub(super) fn mixed(tables: &Tables, own: &[Access], used: u16, access: AccessKind) -> Option<DeclareReason> {
    let others = if COPIES & access.bit() != 0 { !COPIES } else { COPIES };
    if used & others == 0 {
        return None;
    }
    let earlier = own.iter().find(|a| others & a.kind.bit() != 0)?;
    Some(DeclareReason::MixedKinds {
        earlier: earlier.kind.word(),
        of: tables.resource_name(earlier.resource).to_owned(),
        later: access.word(),
    })
}

/// The kind of a pass that makes accesses of the kinds in `used`, a bit each.
pub(super) const fn inferred_kind(used: u16) -> PassKind {
    if used & RASTER != 0 {
        PassKind::Raster
    } else if used != 0 && used & !COPIES == 0 {
        PassKind::Copy
    } else {
        PassKind::Compute
    }
}

const fn bits(kinds: &[AccessKind]) -> u16 {
    let (mut set, mut at) = (0, 0);
    while at < kinds.len() {
        set |= kinds[at].bit();
        at += 1;
    }
    set
}

/// The kinds that attach.
pub(super) const ATTACHMENTS: u16 = {
    use AccessKind::*;
    bits(&[Color, Depth, DepthReadOnly, Resolve])
};
/// The kinds that only a raster pass can make.
const RASTER: u16 = ATTACHMENTS | bits(&[AccessKind::SamePixel, AccessKind::Vertex, AccessKind::Index]);
/// The kinds that must name one level.
const ONE_LEVEL: u16 = ATTACHMENTS | AccessKind::SamePixel.bit();
/// The kinds that make a depth attachment.
pub(super) const DEPTHS: u16 = bits(&[AccessKind::Depth, AccessKind::DepthReadOnly]);
/// The kinds that only a copy pass can make.
pub(super) const COPIES: u16 = bits(&[AccessKind::CopySource, AccessKind::CopyTarget]);
/// The kinds that read.
pub(super) const READS: u16 = {
    use AccessKind::*;
    bits(&[DepthReadOnly, SamePixel, Sampled, StorageRead, Uniform, Vertex, Index, Indirect, CopySource])
};
/// Beside the kinds that a resource allows: it has one part.
pub(super) const ONE_PART: u16 = 1 << 15;
/// The kinds of access that a buffer allows.
const OF_BUFFERS: u16 = {
    use AccessKind::*;
    bits(&[StorageRead, StorageWrite, Uniform, Vertex, Index, Indirect, CopySource, CopyTarget])
};

/// The kinds of access that each format allows.
const OF_FORMATS: [u16; Format::ALL.len()] = {
    let mut table = [0; Format::ALL.len()];
    let mut at = 0;
    while at < table.len() {
        table[at] = kinds_of(Format::ALL[at]);
        at += 1;
    }
    table
};

const fn kinds_of(format: Format) -> u16 {
    use AccessKind::*;
    let mut kinds = bits(&[SamePixel, Sampled, CopySource, CopyTarget]);
    if format.is_color_renderable() {
        kinds |= Color.bit();
    }
    if format.is_resolvable() {
        kinds |= Resolve.bit();
    }
    if format.is_depth_stencil() {
        kinds |= bits(&[Depth, DepthReadOnly]);
    }
    if storable(format) {
        kinds |= bits(&[StorageRead, StorageWrite]);
    }
    kinds
}

/// The kinds of access to the whole of a resource that nothing in its shape or kind rules out, a bit each. A kind that is
/// left out may still be sound. [`ONE_PART`] is added where the resource has one part whatever the frame's size.
pub(crate) const fn plain_kinds(desc: &Desc, kind: Kind) -> u16 {
    let kinds = match desc {
        Desc::Buffer(_) => OF_BUFFERS,
        Desc::Texture(t) if t.layers == 0 => 0,
        Desc::Texture(t) if t.mips == 1 => {
            let kinds = OF_FORMATS[t.format as usize];
            if t.tracked_layers() == 1 && t.format.planes() == 1 { kinds | ONE_PART } else { kinds }
        }
        Desc::Texture(t) => OF_FORMATS[t.format as usize] & !ONE_LEVEL,
    };
    match kind {
        Kind::HistoryPrevious { .. } => kinds & (READS | ONE_PART),
        _ => kinds,
    }
}

/// What the resource's shape or kind rules out.
pub(super) fn incapable(row: &Resource, r: &Request) -> Option<DeclareReason> {
    let access = r.kind.word();
    if let (Kind::HistoryPrevious { .. }, true) = (row.kind, r.mode.writes()) {
        return Some(DeclareReason::Conflict { earlier: "an earlier frame's image", later: access });
    }
    if (READS & r.kind.bit() != 0) == r.mode.writes() {
        return Some(DeclareReason::Conflict { earlier: r.mode.word(), later: access });
    }
    match &row.desc {
        Desc::Buffer(_) => {
            let fits = OF_BUFFERS & r.kind.bit() != 0;
            (!fits).then(|| DeclareReason::Shape { detail: format!("a buffer cannot be used as `{access}`") })
        }
        Desc::Texture(t) => texture_incapable(t, r),
    }
}

fn texture_incapable(t: &TextureDesc, r: &Request) -> Option<DeclareReason> {
    let access = r.kind.word();
    let Range { mip, mips, layer, layers, aspect } = r.range;
    let outside = |first: u32, count: u32, all: bool, has: u32| {
        if all { first >= has } else { count == 0 || first + count > has }
    };
    let has_mips = if t.mips == TextureDesc::ALL_MIPS { 32 } else { u32::from(t.mips) };
    if outside(mip.into(), mips.into(), mips == u8::MAX, has_mips)
        || outside(layer.into(), layers.into(), layers == u16::MAX, t.tracked_layers())
        || !aspect.exists_in(t.format)
    {
        let detail =
            format!("{} was asked of {} levels, {} layers, {:?}", described(&r.range), t.mips, t.layers, t.format);
        return Some(DeclareReason::OutOfRange { detail });
    }
    let one_level = mips == 1 || (mips == u8::MAX && mip == 0 && t.mips == 1);
    if (r.kind.is_attachment() || r.kind == AccessKind::SamePixel) && !one_level {
        return Some(DeclareReason::NotOneLevel { access });
    }
    let capable = OF_FORMATS[t.format as usize] & r.kind.bit() != 0;
    (!capable).then_some(DeclareReason::Format { format: t.format, access })
}

/// Whether a storage texture of this format exists (WebGPU's list, and what common adapters add to it).
const fn storable(format: Format) -> bool {
    !format.is_depth_stencil()
        && !format.is_compressed()
        && !format.is_srgb()
        && !matches!(format, Format::Rgb9e5Ufloat)
}

fn described(range: &Range) -> String {
    let count = |first: u32, count: u32, all: bool| {
        if all { format!("{first}..") } else { format!("{first}..{}", first + count) }
    };
    let mips = count(range.mip.into(), range.mips.into(), range.mips == u8::MAX);
    let layers = count(range.layer.into(), range.layers.into(), range.layers == u16::MAX);
    format!("levels {mips}, layers {layers}, aspect {:?}", range.aspect)
}
