//! What passes hold: typed, versioned names of textures and buffers, parts of them, and the tokens of reads.
//!
//! A handle names one version. Writing through it makes a new version and a new handle; the old one is stale from then
//! on. The type says what may be done: a [`Previous`] image of a history has no method that writes.

use crate::access::Range;
use crate::format::{Aspect, Format};
use crate::id::{AccessId, VersionId};

/// Which graph, and which declaration of it, a handle belongs to.
///
/// Made from the address of an allocation that the graph owns and a count of its resets: two graphs that live at the same
/// time differ, without any global counter. Never reaches a plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Tag(pub(crate) u32);

/// A version of a texture, to be read or written next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Texture {
    pub(crate) tag: Tag,
    pub(crate) version: VersionId,
}

/// A version of a buffer, to be read or written next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Buffer {
    pub(crate) tag: Tag,
    pub(crate) version: VersionId,
}

/// A history image as an earlier frame left it; read only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Previous {
    pub(crate) tag: Tag,
    pub(crate) version: VersionId,
}

/// A texture that a pass may read and not write: `texture.read_only()`, or a [`Previous`] image. May be a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ReadOnly {
    pub(crate) tag: Tag,
    pub(crate) version: VersionId,
    pub(crate) range: Range,
}

/// Some levels, layers or planes of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Part {
    pub(crate) texture: Texture,
    pub(crate) range: Range,
}

/// Some bytes of a buffer, or all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BufferPart {
    pub(crate) buffer: Buffer,
    /// Offset and size in bytes; none for all.
    pub(crate) bytes: Option<(u64, u64)>,
}

/// The token of a read of a texture: what a recorder looks the view up with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct View {
    pub(crate) tag: Tag,
    pub(crate) access: AccessId,
}

/// The token of a read of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BufferView {
    pub(crate) tag: Tag,
    pub(crate) access: AccessId,
}

impl Texture {
    /// Level `mip`, all layers and planes.
    pub const fn mip(self, mip: u8) -> Part {
        Part { texture: self, range: Range { mip, mips: 1, ..Range::ALL } }
    }

    /// Array layer `layer`, all levels and planes.
    pub const fn layer(self, layer: u16) -> Part {
        Part { texture: self, range: Range { layer, layers: 1, ..Range::ALL } }
    }

    /// One plane of a depth-stencil texture.
    pub const fn aspect(self, aspect: Aspect) -> Part {
        Part { texture: self, range: Range { aspect, ..Range::ALL } }
    }

    /// All of it, seen through `format`: the sRGB twin of its own format, so that what is stored in `Rgba8UnormSrgb` is
    /// read or written without the transfer function, or what is stored in `Rgba8Unorm` with it. An imported texture must
    /// have been made with both formats among its views.
    pub const fn viewed_as(self, format: Format) -> Part {
        Part { texture: self, range: Range { view: Some(format), ..Range::ALL } }
    }

    /// Any range of levels, layers and planes.
    pub const fn range(self, range: Range) -> Part {
        Part { texture: self, range }
    }

    /// The same version, without the right to write it.
    pub const fn read_only(self) -> ReadOnly {
        ReadOnly { tag: self.tag, version: self.version, range: Range::ALL }
    }
}

impl Part {
    /// The texture that this is a part of.
    pub const fn texture(self) -> Texture {
        self.texture
    }

    /// The format that it is seen through, where that is another than the texture's.
    pub const fn view_format(self) -> Option<Format> {
        self.range.view
    }

    /// The same part, without the right to write it.
    pub const fn read_only(self) -> ReadOnly {
        ReadOnly { tag: self.texture.tag, version: self.texture.version, range: self.range }
    }
}

/// Gives a part the calls that narrow it down.
macro_rules! narrowed {
    ($($part:ident),+) => { $(
        impl $part {
            /// Level `mip` of these layers and planes.
            #[must_use]
            pub const fn mip(mut self, mip: u8) -> Self {
                (self.range.mip, self.range.mips) = (mip, 1);
                self
            }

            /// Layer `layer` of these levels and planes.
            #[must_use]
            pub const fn layer(mut self, layer: u16) -> Self {
                (self.range.layer, self.range.layers) = (layer, 1);
                self
            }

            /// One plane of these levels and layers.
            #[must_use]
            pub const fn aspect(mut self, aspect: Aspect) -> Self {
                self.range.aspect = aspect;
                self
            }

            /// The same part, seen through the sRGB twin of the texture's format: [`Texture::viewed_as`].
            #[must_use]
            pub const fn viewed_as(mut self, format: Format) -> Self {
                self.range.view = Some(format);
                self
            }
        }
    )+ };
}

narrowed!(Part, ReadOnly);

impl Buffer {
    /// `bytes` bytes from `offset` on. What other bytes of the buffer hold is followed apart: writing some does not
    /// touch the others, and they are read as the passes left them that wrote them. Ranges may overlap; a byte holds
    /// what the last pass wrote that named it. A range does not follow the frame: where the buffer does, work it out from the
    /// frame's size ([`Extent::texels`](crate::Extent::texels)) and declare the graph anew.
    ///
    /// A device binds a buffer at multiples of its alignment alone (wgpu: 256 bytes for uniforms and storage, 4 for the
    /// rest); nothing is rounded here.
    pub const fn bytes(self, offset: u64, bytes: u64) -> BufferPart {
        BufferPart { buffer: self, bytes: Some((offset, bytes)) }
    }
}

impl From<Buffer> for BufferPart {
    fn from(buffer: Buffer) -> Self {
        Self { buffer, bytes: None }
    }
}

impl From<Texture> for Part {
    fn from(texture: Texture) -> Self {
        Self { texture, range: Range::ALL }
    }
}

impl From<Texture> for ReadOnly {
    fn from(texture: Texture) -> Self {
        texture.read_only()
    }
}

impl From<Part> for ReadOnly {
    fn from(part: Part) -> Self {
        part.read_only()
    }
}

impl From<Previous> for ReadOnly {
    fn from(previous: Previous) -> Self {
        Self { tag: previous.tag, version: previous.version, range: Range::ALL }
    }
}

/// Where a pass puts its result: a texture of its own making, or one that it is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// The pass declares a transient of the shape it prefers.
    #[default]
    New,
    /// The pass writes here.
    Into(Part),
}

impl From<Texture> for Target {
    fn from(texture: Texture) -> Self {
        Self::Into(texture.into())
    }
}

impl From<Part> for Target {
    fn from(part: Part) -> Self {
        Self::Into(part)
    }
}
