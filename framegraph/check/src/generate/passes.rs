//! Random passes of each kind.

use super::accesses::{Draft, Shape, What, intent, shape};
use super::profile::FRAME;
use super::world::World;
use framegraph::access::{AccessKind, Range};
use framegraph::format::{Aspect, Format};
use framegraph::graph::PassKind;
use framegraph::resolve::ResolveMode;
use framegraph::resource::{Dimension, TextureDesc};

fn is_color(format: Format) -> bool {
    format.is_color_renderable()
}

/// Draws into attachments, usually those of the previous pass.
pub(super) fn draw(world: &mut World<'_, '_>, draft: &mut Draft) {
    draft.takes_epilogue = !world.entropy.one_in(4);
    draft.blends = world.entropy.one_in(6);
    let mut wanted: Option<Shape> = None;
    if !world.entropy.one_in(3) {
        for (texture, range) in world.last.clone() {
            if !world.entropy.one_in(4) {
                attach(world, draft, texture, range, &mut wanted);
            }
        }
    }
    for _ in 0..world.entropy.below(4) / 2 {
        let (texture, range) = some_target(world, wanted);
        attach(world, draft, texture, range, &mut wanted);
    }
    if draft.count(AccessKind::Color) + draft.count(AccessKind::Depth) == 0 {
        let (texture, range) = some_target(world, wanted);
        attach(world, draft, texture, range, &mut wanted);
    }
    if !world.entropy.one_in(4) {
        resolve_all(world, draft);
    }
    if world.entropy.one_in(3) {
        read(world, draft, AccessKind::SamePixel);
    }
    if world.entropy.one_in(2) {
        others(world, draft);
    }
    if world.entropy.one_in(24) {
        draft.accesses.retain(|a| !a.kind.is_attachment());
        draft.kind = Some(PassKind::Raster);
    }
}

/// Reads one texture at the same pixel and draws another; often point-wise.
pub(super) fn filter(world: &mut World<'_, '_>, draft: &mut Draft) {
    draft.pointwise = !world.entropy.one_in(3);
    draft.takes_epilogue = world.entropy.one_in(2);
    draft.blends = world.entropy.one_in(12);
    let drawn = world.last.clone();
    let inputs = drawn.iter().filter(|(t, r)| {
        let texture = &world.textures[*t];
        let whole = texture.desc.dimension == Dimension::D2 || r.layers != 1;
        texture.is_defined(*r) && is_color(texture.desc.format) && whole
    });
    let inputs: Vec<_> = inputs.copied().collect();
    let mut wanted = None;
    if !inputs.is_empty() {
        // The last one is a resolve target, if there is one.
        let (texture, range) =
            if world.entropy.one_in(4) { world.entropy.pick(&inputs) } else { inputs[inputs.len() - 1] };
        let (extent, layers, _) = shape(world, texture, range);
        let kind = if world.entropy.one_in(6) { AccessKind::Sampled } else { AccessKind::SamePixel };
        draft.read(What::Texture(texture, range), kind);
        wanted = Some((extent, layers, 1));
        if kind == AccessKind::Sampled && world.entropy.one_in(2) {
            wanted = None;
        }
    }
    let (texture, range) = some_target(world, wanted);
    attach(world, draft, texture, range, &mut wanted);
    if world.entropy.one_in(4) {
        others(world, draft);
    }
}

/// Returns a texture that can be an attachment with this shape: an existing or a new one.
pub(super) fn some_target(world: &mut World<'_, '_>, wanted: Option<Shape>) -> (usize, Range) {
    if !world.textures.is_empty() && world.entropy.one_in(3) {
        let count = world.textures.len() as u32;
        for _ in 0..4 {
            let texture = world.entropy.below(count) as usize;
            let range = world.range(texture, true);
            let fits = wanted.is_none_or(|w| w == shape(world, texture, range));
            if fits || world.slips() {
                return (texture, range);
            }
        }
    }
    let mut desc = world.desc();
    if let Some(([width, height], layers, samples)) = wanted {
        let extent = framegraph::resource::Extent::absolute(width, height);
        if desc.extent.texels(FRAME) != [width, height] {
            desc.extent = extent;
        }
        desc = TextureDesc { dimension: Dimension::D2, ..desc }.samples(samples).layers(layers as u16).mips(1);
    }
    let texture = world.texture(desc);
    let range = if wanted.is_some() { Range::ALL } else { world.range(texture, true) };
    (texture, one_level(desc, range))
}

/// Returns `true` if the first level of the range has several slices and the range is none of them, so that it cannot
/// be attached.
fn has_slices(desc: TextureDesc, range: Range) -> bool {
    desc.dimension == Dimension::D3 && desc.slices(range.mip.into()) > 1 && range.layers != 1
}

/// Restricts the range to one level, as an attachment requires.
fn one_level(desc: TextureDesc, range: Range) -> Range {
    if desc.mips == 1 || range.mips == 1 { range } else { Range { mips: 1, ..range } }
}

/// Adds an attachment if it fits the pass's shape, the limits of the device and the other accesses.
pub(super) fn attach(
    world: &mut World<'_, '_>,
    draft: &mut Draft,
    texture: usize,
    range: Range,
    wanted: &mut Option<Shape>,
) {
    let desc = world.textures[texture].desc;
    let what = What::Texture(texture, range);
    let slips = world.slips();
    if desc.format.is_compressed() || has_slices(desc, range) && !slips {
        return;
    }
    let own = shape(world, texture, range);
    let fits = wanted.is_none_or(|w| w == own) && world.textures[texture].writable;
    if is_color(desc.format) {
        let bytes = draft.color_bytes(world) + desc.format.tile_bytes();
        let room = draft.count(AccessKind::Color) < 8 && bytes <= 32;
        if slips || fits && room && draft.admits(world, what, true) {
            let intent = intent(world, what, AccessKind::Color);
            draft.write(what, AccessKind::Color, intent);
            *wanted = Some(own);
        }
        return;
    }
    let depth = draft.count(AccessKind::Depth) + draft.count(AccessKind::DepthReadOnly);
    if !(slips || fits && depth == 0) {
        return;
    }
    let defined = world.textures[texture].is_defined(range);
    if defined && world.entropy.one_in(3) && draft.admits(world, what, false) {
        draft.read(what, AccessKind::DepthReadOnly);
        *wanted = Some(own);
        if world.entropy.one_in(3) {
            draft.read(what, AccessKind::Sampled);
        }
    } else if draft.admits(world, what, true) {
        let intent = intent(world, what, AccessKind::Depth);
        draft.write(what, AccessKind::Depth, intent);
        *wanted = Some(own);
    }
}

/// Adds a read of a texture with defined contents, or of an earlier history image.
fn read(world: &mut World<'_, '_>, draft: &mut Draft, kind: AccessKind) {
    if !world.previous.is_empty() && world.entropy.one_in(6) {
        let index = world.entropy.below(world.previous.len() as u32) as usize;
        let desc = world.previous[index].1;
        let same_size = desc.mips == 1 && desc.extent.texels(FRAME) == extent_of(world, draft);
        let capable = match kind {
            AccessKind::StorageRead => is_storable(desc),
            AccessKind::SamePixel => same_size && !has_slices(desc, Range::ALL),
            _ => true,
        };
        if capable || world.slips() {
            draft.read(What::Previous(index), kind);
        }
        return;
    }
    if world.textures.is_empty() {
        return;
    }
    let recent = world.last.clone();
    let same_pixel = kind == AccessKind::SamePixel;
    let (texture, mut range) = if !recent.is_empty() && world.entropy.one_in(2) {
        world.entropy.pick(&recent)
    } else {
        let texture = world.entropy.below(world.textures.len() as u32) as usize;
        (texture, world.range(texture, same_pixel))
    };
    if kind == AccessKind::StorageRead {
        range.view = None;
    }
    if world.textures[texture].desc.dimension == Dimension::D3 {
        (range.layer, range.layers) = (0, u16::MAX); // only attachments select a slice
    }
    let what = What::Texture(texture, range);
    let known = &world.textures[texture];
    let same_size = shape(world, texture, range).0 == extent_of(world, draft);
    let capable = match kind {
        AccessKind::StorageRead => is_storable(known.desc),
        AccessKind::SamePixel => same_size && !has_slices(known.desc, range),
        _ => true,
    };
    let defined = known.is_defined(range);
    let fits = capable && defined && draft.admits(world, what, false);
    if fits || world.slips() {
        draft.read(what, kind);
    }
}

/// Width and height of the attachments so far; 0 without attachments.
fn extent_of(world: &World<'_, '_>, draft: &Draft) -> [u32; 2] {
    let first = draft.accesses.iter().find(|a| a.kind.is_attachment());
    match first.map(|a| a.what) {
        Some(What::Texture(texture, range)) => shape(world, texture, range).0,
        _ => [0; 2],
    }
}

fn is_storable(desc: TextureDesc) -> bool {
    let format = desc.format;
    let shape = desc.samples == 1 && !format.is_depth_stencil() && !format.is_compressed();
    shape && !format.is_srgb() && format != Format::Rgb9e5Ufloat
}

/// Adds reads and storage writes.
pub(super) fn others(world: &mut World<'_, '_>, draft: &mut Draft) {
    if world.profile.plain {
        if world.entropy.one_in(2) {
            read(world, draft, AccessKind::Sampled);
        }
        return;
    }
    for _ in 0..world.entropy.below(3) {
        match world.entropy.below(8) {
            0..4 => read(world, draft, AccessKind::Sampled),
            4 => read(world, draft, AccessKind::StorageRead),
            5 => read_buffer(world, draft),
            6 => write_buffer(world, draft, AccessKind::StorageWrite),
            _ => store_texture(world, draft, AccessKind::StorageWrite),
        }
    }
}

fn read_buffer(world: &mut World<'_, '_>, draft: &mut Draft) {
    let copies = draft.kind == Some(PassKind::Copy);
    let kind = if copies {
        AccessKind::CopySource
    } else {
        let kinds = [AccessKind::Uniform, AccessKind::StorageRead, AccessKind::Indirect];
        world.entropy.pick(&kinds)
    };
    if world.buffers.is_empty() {
        return;
    }
    let index = world.entropy.below(world.buffers.len() as u32) as usize;
    let pieces = world.pieces(index);
    let what = What::Buffer(index, pieces);
    if world.buffers[index].is_defined(pieces) && draft.admits(world, what, false) || world.slips() {
        draft.read(what, kind);
    }
}

fn write_buffer(world: &mut World<'_, '_>, draft: &mut Draft, kind: AccessKind) {
    let index = if world.buffers.is_empty() || world.entropy.one_in(2) {
        world.buffer()
    } else {
        world.entropy.below(world.buffers.len() as u32) as usize
    };
    let what = What::Buffer(index, world.pieces(index));
    if draft.admits(world, what, true) {
        let intent = intent(world, what, kind);
        draft.write(what, kind, intent);
    }
}

fn store_texture(world: &mut World<'_, '_>, draft: &mut Draft, kind: AccessKind) {
    let texture = if world.textures.is_empty() || world.entropy.one_in(2) {
        let desc = world.desc();
        world.texture(desc)
    } else {
        world.entropy.below(world.textures.len() as u32) as usize
    };
    let range = world.range(texture, false);
    let what = What::Texture(texture, range);
    let desc = world.textures[texture].desc;
    let capable = kind == AccessKind::CopyTarget || is_storable(desc);
    if capable && draft.admits(world, what, true) || world.slips() {
        let intent = intent(world, what, kind);
        draft.write(what, kind, intent);
    }
}

pub(super) fn compute(world: &mut World<'_, '_>, draft: &mut Draft) {
    draft.kind = world.entropy.one_in(2).then_some(PassKind::Compute);
    for _ in 0..1 + world.entropy.below(2) {
        if world.profile.plain || world.entropy.one_in(2) {
            store_texture(world, draft, AccessKind::StorageWrite);
        } else {
            write_buffer(world, draft, AccessKind::StorageWrite);
        }
    }
    for _ in 0..world.entropy.below(4) {
        match world.entropy.below(3) {
            0 => read(world, draft, AccessKind::Sampled),
            1 => read(world, draft, AccessKind::StorageRead),
            _ => read_buffer(world, draft),
        }
    }
}

pub(super) fn copy(world: &mut World<'_, '_>, draft: &mut Draft) {
    draft.kind = Some(PassKind::Copy);
    read(world, draft, AccessKind::CopySource);
    if world.profile.plain || world.entropy.one_in(2) {
        store_texture(world, draft, AccessKind::CopyTarget);
    } else {
        read_buffer(world, draft);
        write_buffer(world, draft, AccessKind::CopyTarget);
    }
}

/// Adds resolve targets for some multisampled attachments.
pub(super) fn resolve_all(world: &mut World<'_, '_>, draft: &mut Draft) {
    for index in 0..draft.accesses.len() {
        let attached = draft.accesses[index];
        let What::Texture(texture, range) = attached.what else {
            continue;
        };
        let desc = world.textures[texture].desc;
        let depth = attached.kind.is_depth() && range.aspect != Aspect::Stencil;
        // WebGPU cannot copy 24-bit depth without stencil, which later passes may do.
        let copied = desc.format.depth_alone() != Format::Depth24Plus;
        if attached.kind != AccessKind::Color && !(depth && copied) {
            continue;
        }
        let resolve = if desc.format.is_resolvable() && !world.entropy.one_in(4) {
            ResolveMode::Average
        } else {
            world.entropy.pick(&[ResolveMode::Sample0, ResolveMode::Min, ResolveMode::Max])
        };
        let resolvable = desc.samples > 1 && resolve.fits(desc.format) && range.view.is_none();
        if !(resolvable || world.slips()) {
            continue;
        }
        let desc = desc.format(desc.format.depth_alone());
        let (extent, layers, _) = shape(world, texture, range);
        let old = world.textures.iter().position(|t| {
            t.desc.format == desc.format
                && t.desc.samples == 1
                && t.desc.mips == 1
                && t.desc.extent.texels(FRAME) == extent
                && t.desc.layers == layers as u16
                && t.desc.dimension == Dimension::D2
        });
        let target = match old {
            Some(old) if world.entropy.one_in(3) => old,
            _ => world.texture(desc.samples(1).layers(layers as u16)),
        };
        let what = What::Texture(target, Range::ALL);
        if draft.admits(world, what, true) {
            draft.write(what, AccessKind::Resolve, framegraph::access::Intent::Overwrite);
            let last = draft.accesses.len() - 1;
            (draft.accesses[last].averages, draft.accesses[last].resolve) = (index, resolve);
        }
    }
}
