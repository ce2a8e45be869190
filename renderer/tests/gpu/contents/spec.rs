//! What a pass of a random graph does, worked out from its declaration alone: the recorder does it on the device, the
//! oracle on the CPU.
//!
//! A shader pass folds everything that it reads into one number, its *digest*: [`LOOKS`](super::code::LOOKS) texels of
//! every level, layer and plane, words of every buffer, and the arguments of an indirect dispatch or draw. Each texel that
//! it writes is a hash of digest, output and place. A write that keeps older contents (`Modify`), or begins from a clear
//! value, paints one texel in four. Depth that is only tested decides between two values. Copies copy.

use super::code::{Numeric, coding, mix, planes};
use framegraph::{Access, AccessKind, Aspect, Desc, Format, Graph, Mode, PassId, ResourceId};

/// How a shader sees something that it reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// A plane of a texture, all levels and layers at once; multisampled or not.
    Texture(Numeric, bool),
    /// One level of a storage texture.
    Storage(Format),
    /// A buffer.
    Buffer,
    /// 64 bytes of a uniform buffer.
    Uniform,
}

/// One thing that a pass reads in its shader.
#[derive(Clone, Copy, Debug)]
pub struct Input {
    /// Row of the pass's accesses.
    pub access: usize,
    pub class: Class,
    /// Which plane of a texture.
    pub plane: Aspect,
    /// The level of a storage texture.
    pub mip: u8,
    /// First byte of a uniform.
    pub offset: u64,
}

/// Bytes that a uniform binding shows.
pub const UNIFORM_BYTES: u64 = 64;
/// No device asks for more.
const UNIFORM_ALIGNMENT: u64 = 256;

/// Everything that the shader of a pass reads, in the order of its digest.
pub fn inputs(graph: &Graph, pass: PassId) -> Vec<Input> {
    let mut inputs = Vec::new();
    for (access, row) in graph.accesses_of(pass).iter().enumerate() {
        let input = |class, plane, mip, offset| Input { access, class, plane, mip, offset };
        match (row.kind, graph.resources()[row.resource.index()].desc) {
            (AccessKind::Sampled | AccessKind::SamePixel, Desc::Texture(desc)) => {
                for plane in planes_of(desc.format, row.range.aspect) {
                    let numeric = coding(desc.format, plane).numeric;
                    inputs.push(input(Class::Texture(numeric, desc.samples > 1), plane, 0, 0));
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

/// The buffer that the work of a pass takes its arguments from, by its row of the pass's accesses.
pub fn indirect(graph: &Graph, pass: PassId) -> Option<usize> {
    graph.accesses_of(pass).iter().position(|a| a.kind == AccessKind::Indirect)
}

/// The depth attachment whose older contents decide where a pass draws color a second time, by its row. A pass that goes
/// on with depth tests before it writes.
pub fn tested(graph: &Graph, pass: PassId) -> Option<usize> {
    let tests =
        |a: &Access| a.kind == AccessKind::DepthReadOnly || (a.kind == AccessKind::Depth && a.mode == Mode::Modify);
    graph.accesses_of(pass).iter().position(tests)
}

/// Reads that nothing of a pass depends on: they cannot be compared, and are counted.
pub fn unobserved(graph: &Graph, pass: PassId) -> usize {
    let accesses = graph.accesses_of(pass);
    let draws_color = accesses.iter().any(|a| a.kind == AccessKind::Color);
    let spare = |kind| accesses.iter().filter(|a| a.kind == kind).count();
    let indirect = spare(AccessKind::Indirect).saturating_sub(1);
    let untested = if draws_color { 0 } else { spare(AccessKind::DepthReadOnly) };
    indirect + untested + spare(AccessKind::Vertex) + spare(AccessKind::Index)
}

/// The planes of a format that an aspect selects.
pub fn planes_of(format: Format, aspect: Aspect) -> Vec<Aspect> {
    planes(format).into_iter().filter(|p| aspect == Aspect::All || *p == aspect).collect()
}

/// The number of a plane among the planes of its format.
pub fn plane_index(format: Format, plane: Aspect) -> usize {
    planes(format).iter().position(|p| *p == plane).unwrap_or(0)
}

/// The levels of a texture that an access touches.
pub fn mips(graph: &Graph, access: &Access) -> std::ops::Range<u8> {
    let Desc::Texture(desc) = graph.resources()[access.resource.index()].desc else { return 0..0 };
    let all = desc.mip_count(super::FRAME) as u8;
    let count = if access.range.mips == u8::MAX { all - access.range.mip } else { access.range.mips };
    access.range.mip..access.range.mip + count
}

/// The layers of a texture that an access touches.
pub fn layers(graph: &Graph, access: &Access) -> std::ops::Range<u16> {
    let Desc::Texture(desc) = graph.resources()[access.resource.index()].desc else { return 0..0 };
    let count = if access.range.layers == u16::MAX { desc.layers - access.range.layer } else { access.range.layers };
    access.range.layer..access.range.layer + count
}

/// What makes a pass of one frame differ from every other: its digest begins with it.
pub fn salt(pass: PassId, frame: u32) -> u32 {
    mix(mix(0x00C0_FFEE, pass.index() as u32), frame)
}

/// What tells a level of an output apart from all others of a pass; layers are added to it.
pub fn tag(access: usize, plane: usize, mip: u8) -> u32 {
    (access as u32) << 20 | (plane as u32) << 18 | u32::from(mip) << 10
}

/// Set in the tag of what is drawn where tested depth lets it.
pub const DEPTH_PASSED: u32 = 1 << 30;
/// Set in the tag of what is drawn where tested stencil lets it.
pub const STENCIL_PASSED: u32 = 1 << 31;
/// The depth that is tested against: between two codes.
pub const TESTED_DEPTH: f32 = 65535.0 / 131_072.0;

/// Which texels a write paints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// All.
    All = 0,
    /// One in four, over older contents.
    Over = 1,
    /// One in four, over a clear value; and the first four words of a buffer.
    Cleared = 2,
}

/// Which texels an access that writes paints.
pub fn paint(mode: Mode) -> Paint {
    match mode {
        Mode::Clear => Paint::Cleared,
        Mode::Modify => Paint::Over,
        Mode::Overwrite | Mode::Read => Paint::All,
    }
}

/// One texture's shape in texels at a level.
pub fn texels(graph: &Graph, resource: ResourceId, mip: u8) -> [u32; 2] {
    let desc = graph.resources()[resource.index()].desc;
    desc.texture().map_or([0; 2], |t| t.mip_extent(super::FRAME, u32::from(mip)))
}
