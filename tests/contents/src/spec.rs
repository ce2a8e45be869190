//! Work of the passes of a random graph, derived from their declarations only. The recorder runs it on the device, the
//! oracle on the CPU.
//!
//! A shader pass combines its inputs to one number, its *digest*. It samples [`LOOKS`](super::code::LOOKS) texels of
//! every level, layer and plane, words of every buffer, and indirect arguments. Each texel that it writes is a hash of
//! digest, output, position, and of the texels that it reads at the same pixel.
//!
//! Writes that keep older contents (`Modify`), or start from a clear value, write one texel in four. Read-only depth
//! selects between two values. Copy passes copy.

use super::code::{Numeric, coding, mix, planes};
use framegraph::{Access, AccessKind, Aspect, Desc, Format, Graph, Mode, PassId, ResourceId};

/// Kind of a shader input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// A plane of a texture with all levels and layers; multisampled or not.
    Texture(Numeric, bool),
    /// One level of a storage texture.
    Storage(Format),
    /// A storage buffer.
    Buffer,
    /// 64 bytes of a uniform buffer.
    Uniform,
    /// A plane of a texture that is read at the pixel of the fragment; multisampled or not. No part of the digest.
    SamePixel(Numeric, bool),
    /// A same-pixel read that stays in the tile. The shader reads an input attachment.
    InTile(Numeric, bool),
}

/// One shader input of a pass.
#[derive(Clone, Copy, Debug)]
pub struct Input {
    /// Row in the pass's accesses.
    pub access: usize,
    pub class: Class,
    /// Plane of a texture.
    pub plane: Aspect,
    /// Mip level of a storage texture.
    pub mip: u8,
    /// Offset of a uniform in bytes.
    pub offset: u64,
}

/// Size of a uniform binding in bytes.
pub const UNIFORM_BYTES: u64 = 64;
/// Largest offset alignment that WebGPU allows.
const UNIFORM_ALIGNMENT: u64 = 256;

/// Returns the shader inputs of a pass, in the order of its digest. With `pixelwise`, same-pixel reads are no part of the
/// digest, and each texel depends on the texels below it; otherwise they are read as sampled textures.
pub fn inputs(graph: &Graph, pass: PassId, pixelwise: bool) -> Vec<Input> {
    let mut inputs = Vec::new();
    for (access, row) in graph.accesses_of(pass).iter().enumerate() {
        let input = |class, plane, mip, offset| Input { access, class, plane, mip, offset };
        match (row.kind, graph.resources()[row.resource.index()].desc) {
            (AccessKind::Sampled | AccessKind::SamePixel, Desc::Texture(desc)) => {
                for plane in planes_of(desc.format, row.range.aspect) {
                    let numeric = coding(desc.format, plane).numeric;
                    let pixelwise = pixelwise && row.kind == AccessKind::SamePixel;
                    let class = if pixelwise { Class::SamePixel } else { Class::Texture };
                    inputs.push(input(class(numeric, desc.samples > 1), plane, 0, 0));
                }
            }
            (AccessKind::StorageRead, Desc::Texture(desc)) => {
                for mip in mips(graph, row) {
                    inputs.push(input(Class::Storage(desc.format), Aspect::All, mip, 0));
                }
            }
            (AccessKind::StorageRead, Desc::Buffer(_)) => inputs.push(input(Class::Buffer, Aspect::All, 0, 0)),
            (AccessKind::Uniform, Desc::Buffer(desc)) => {
                let last = (desc.bytes(super::FRAME) - UNIFORM_BYTES) / UNIFORM_ALIGNMENT * UNIFORM_ALIGNMENT;
                inputs.push(input(Class::Uniform, Aspect::All, 0, 0));
                if last > 0 {
                    inputs.push(input(Class::Uniform, Aspect::All, 0, last));
                }
            }
            _ => {}
        }
    }
    inputs.sort_by_key(|i| i.class);
    inputs
}

/// Returns the row of the access with indirect arguments.
pub fn indirect(graph: &Graph, pass: PassId) -> Option<usize> {
    graph.accesses_of(pass).iter().position(|a| a.kind == AccessKind::Indirect)
}

/// Returns the row of the depth attachment whose older contents are tested when color is drawn a second time. A pass
/// that modifies depth tests before it writes.
pub fn tested(graph: &Graph, pass: PassId) -> Option<usize> {
    let tests =
        |a: &Access| a.kind == AccessKind::DepthReadOnly || (a.kind == AccessKind::Depth && a.mode == Mode::Modify);
    graph.accesses_of(pass).iter().position(tests)
}

/// Returns the number of reads that influence no output; they cannot be compared.
pub fn unobserved(graph: &Graph, pass: PassId) -> usize {
    let accesses = graph.accesses_of(pass);
    let draws_color = accesses.iter().any(|a| a.kind == AccessKind::Color);
    let spare = |kind| accesses.iter().filter(|a| a.kind == kind).count();
    let indirect = spare(AccessKind::Indirect).saturating_sub(1);
    let untested = if draws_color { 0 } else { spare(AccessKind::DepthReadOnly) };
    indirect + untested + spare(AccessKind::Vertex) + spare(AccessKind::Index)
}

/// Returns the planes of a format that an aspect selects.
pub fn planes_of(format: Format, aspect: Aspect) -> Vec<Aspect> {
    planes(format).into_iter().filter(|p| aspect == Aspect::All || *p == aspect).collect()
}

/// Returns the index of a plane among the planes of its format.
pub fn plane_index(format: Format, plane: Aspect) -> usize {
    planes(format).iter().position(|p| *p == plane).unwrap_or(0)
}

/// Returns the mip levels of an access.
pub fn mips(graph: &Graph, access: &Access) -> std::ops::Range<u8> {
    let Desc::Texture(desc) = graph.resources()[access.resource.index()].desc else { return 0..0 };
    let all = desc.mip_count(super::FRAME) as u8;
    let count = if access.range.mips == u8::MAX { all - access.range.mip } else { access.range.mips };
    access.range.mip..access.range.mip + count
}

/// Returns the layers of an access.
pub fn layers(graph: &Graph, access: &Access) -> std::ops::Range<u16> {
    let Desc::Texture(desc) = graph.resources()[access.resource.index()].desc else { return 0..0 };
    let count = if access.range.layers == u16::MAX { desc.layers - access.range.layer } else { access.range.layers };
    access.range.layer..access.range.layer + count
}

/// Returns the start value of a pass's digest, which differs between passes and frames.
pub fn salt(pass: PassId, frame: u32) -> u32 {
    mix(mix(0x00C0_FFEE, pass.index() as u32), frame)
}

/// Returns a number that identifies a level of an output within a pass; layers are added to it.
pub fn tag(access: usize, plane: usize, mip: u8) -> u32 {
    (access as u32) << 20 | (plane as u32) << 18 | u32::from(mip) << 10
}

/// Flag in the tag of color drawn where the depth test passes.
pub const DEPTH_PASSED: u32 = 1 << 30;
/// Flag in the tag of color drawn where the stencil test passes.
pub const STENCIL_PASSED: u32 = 1 << 31;
/// Depth to test against; lies between two codes.
pub const TESTED_DEPTH: f32 = 65535.0 / 131_072.0;

/// Texels that a write covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// All texels.
    All = 0,
    /// One in four, over older contents.
    Over = 1,
    /// One in four over a clear value, and the first four words of a buffer.
    Cleared = 2,
}

/// Returns the texels that an access writes.
pub fn paint(mode: Mode) -> Paint {
    match mode {
        Mode::Clear => Paint::Cleared,
        Mode::Modify => Paint::Over,
        Mode::Overwrite | Mode::Read => Paint::All,
    }
}

/// Returns the size of a texture level in texels.
pub fn texels(graph: &Graph, resource: ResourceId, mip: u8) -> [u32; 2] {
    let desc = graph.resources()[resource.index()].desc;
    desc.texture().map_or([0; 2], |t| t.mip_extent(super::FRAME, u32::from(mip)))
}
