//! What a single access can be refused for.

use super::Request;
use crate::access::{Access, AccessKind, Range};
use crate::error::DeclareReason;
use crate::format::Format;
use crate::graph::PassKind;
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
    (!fits).then(|| DeclareReason::WrongPassKind {
        kind: kind.word(),
        access: access.word(),
    })
}

pub(super) fn inferred_kind(accesses: &[Access]) -> PassKind {
    if accesses.iter().any(|a| a.kind.is_attachment()) {
        PassKind::Raster
    } else if !accesses.is_empty()
        && accesses
            .iter()
            .all(|a| matches!(a.kind, AccessKind::CopySource | AccessKind::CopyTarget))
    {
        PassKind::Copy
    } else {
        PassKind::Compute
    }
}

/// What the resource's shape or kind rules out.
pub(super) fn incapable(row: &Resource, r: &Request) -> Option<DeclareReason> {
    use AccessKind as K;
    let access = r.kind.word();
    if let (Kind::HistoryPrevious { .. }, true) = (row.kind, r.mode.writes()) {
        return Some(DeclareReason::Conflict {
            earlier: "an earlier frame's image",
            later: access,
        });
    }
    let read_kind = matches!(
        r.kind,
        K::DepthReadOnly
            | K::SamePixel
            | K::Sampled
            | K::StorageRead
            | K::Uniform
            | K::Vertex
            | K::Index
            | K::Indirect
            | K::CopySource
    );
    if read_kind == r.mode.writes() {
        return Some(DeclareReason::Conflict {
            earlier: r.mode.word(),
            later: access,
        });
    }
    match &row.desc {
        Desc::Buffer(_) => {
            let fits = matches!(
                r.kind,
                K::StorageRead
                    | K::StorageWrite
                    | K::Uniform
                    | K::Vertex
                    | K::Index
                    | K::Indirect
                    | K::CopySource
                    | K::CopyTarget
            );
            (!fits).then(|| DeclareReason::Shape {
                detail: format!("a buffer cannot be used as `{access}`"),
            })
        }
        Desc::Texture(t) => texture_incapable(t, r),
    }
}

fn texture_incapable(t: &TextureDesc, r: &Request) -> Option<DeclareReason> {
    use AccessKind as K;
    let access = r.kind.word();
    let Range {
        mip,
        mips,
        layer,
        layers,
        aspect,
    } = r.range;
    let outside = |first: u32, count: u32, all: bool, has: u32| {
        if all {
            first >= has
        } else {
            count == 0 || first + count > has
        }
    };
    let has_mips = if t.mips == TextureDesc::ALL_MIPS {
        32
    } else {
        u32::from(t.mips)
    };
    if outside(mip.into(), mips.into(), mips == u8::MAX, has_mips)
        || outside(
            layer.into(),
            layers.into(),
            layers == u16::MAX,
            t.tracked_layers(),
        )
        || !aspect.exists_in(t.format)
    {
        let detail = format!(
            "{} was asked of {} levels, {} layers, {:?}",
            described(&r.range),
            t.mips,
            t.layers,
            t.format
        );
        return Some(DeclareReason::OutOfRange { detail });
    }
    let one_level = mips == 1 || (mips == u8::MAX && mip == 0 && t.mips == 1);
    if (r.kind.is_attachment() || r.kind == K::SamePixel) && !one_level {
        return Some(DeclareReason::NotOneLevel { access });
    }
    let capable = match r.kind {
        K::Color => t.format.is_color_renderable(),
        K::Resolve => t.format.is_resolvable(),
        K::Depth | K::DepthReadOnly => t.format.is_depth_stencil(),
        K::StorageRead | K::StorageWrite => storable(t.format),
        K::Uniform | K::Vertex | K::Index | K::Indirect => false,
        K::SamePixel | K::Sampled | K::CopySource | K::CopyTarget => true,
    };
    (!capable).then_some(DeclareReason::Format {
        format: t.format,
        access,
    })
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
        if all {
            format!("{first}..")
        } else {
            format!("{first}..{}", first + count)
        }
    };
    let mips = count(range.mip.into(), range.mips.into(), range.mips == u8::MAX);
    let layers = count(
        range.layer.into(),
        range.layers.into(),
        range.layers == u16::MAX,
    );
    format!("levels {mips}, layers {layers}, aspect {:?}", range.aspect)
}
