//! Typed, versioned handles of textures and buffers, handles of parts of them, and tokens of reads.
//!
//! A handle names one version of a resource. A write returns a handle of the next version; older handles become stale.
//! Types restrict the use of a handle: a [`Previous`] image of a history cannot be written.

use crate::access::Range;
use crate::format::{Aspect, Format};
use crate::id::{AccessId, VersionId};

/// Identifies the graph, and the declaration between two resets, that a handle belongs to.
///
/// Derived from the address of an allocation owned by the graph and the number of its resets. Graphs that live at the
/// same time have different tags without a global counter. Not stored in plans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Tag(pub(crate) u32);

/// A version of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Texture {
    pub(crate) tag: Tag,
    pub(crate) version: VersionId,
}

/// A version of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Buffer {
    pub(crate) tag: Tag,
    pub(crate) version: VersionId,
}

/// An image of a history from an earlier frame; read-only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Previous {
    pub(crate) tag: Tag,
    pub(crate) version: VersionId,
}

/// A read-only texture or part of one: `texture.read_only()`, or a [`Previous`] image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ReadOnly {
    pub(crate) tag: Tag,
    pub(crate) version: VersionId,
    pub(crate) range: Range,
}

/// A range of levels, layers or planes of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Part {
    pub(crate) texture: Texture,
    pub(crate) range: Range,
}

/// A buffer, or a range of its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BufferPart {
    pub(crate) buffer: Buffer,
    /// Offset and size in bytes; `None` for the whole buffer.
    pub(crate) bytes: Option<(u64, u64)>,
}

/// Token of a texture read. A recorder uses it to look up the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct View {
    pub(crate) tag: Tag,
    pub(crate) access: AccessId,
}

/// Token of a buffer read. A recorder uses it to look up the binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BufferView {
    pub(crate) tag: Tag,
    pub(crate) access: AccessId,
}

impl Texture {
    /// Returns mip level `mip`, with all layers and planes.
    pub const fn mip(self, mip: u8) -> Part {
        Part { texture: self, range: Range { mip, mips: 1, ..Range::ALL } }
    }

    /// Returns array layer `layer`, with all levels and planes.
    pub const fn layer(self, layer: u16) -> Part {
        Part { texture: self, range: Range { layer, layers: 1, ..Range::ALL } }
    }

    /// Returns one plane of a depth-stencil texture.
    pub const fn aspect(self, aspect: Aspect) -> Part {
        Part { texture: self, range: Range { aspect, ..Range::ALL } }
    }

    /// Returns the whole texture viewed in `format`, which must be its own format or the sRGB twin of it.
    ///
    /// A view of `Rgba8UnormSrgb` as `Rgba8Unorm` reads and writes without the transfer function, and vice versa.
    /// Imported textures must be created with both view formats.
    pub const fn viewed_as(self, format: Format) -> Part {
        Part { texture: self, range: Range { view: Some(format), ..Range::ALL } }
    }

    /// Returns a range of levels, layers and planes.
    pub const fn range(self, range: Range) -> Part {
        Part { texture: self, range }
    }

    /// Returns a read-only handle of the texture.
    pub const fn read_only(self) -> ReadOnly {
        ReadOnly { tag: self.tag, version: self.version, range: Range::ALL }
    }
}

impl Part {
    /// The texture that this is a part of.
    pub const fn texture(self) -> Texture {
        self.texture
    }

    /// The format of the view if it differs from that of the texture.
    pub const fn view_format(self) -> Option<Format> {
        self.range.view
    }

    /// Returns a read-only handle of this part.
    pub const fn read_only(self) -> ReadOnly {
        ReadOnly { tag: self.texture.tag, version: self.texture.version, range: self.range }
    }
}

/// Implements the methods that narrow a part.
macro_rules! narrowed {
    ($($part:ident),+) => { $(
        impl $part {
            /// Restricts the part to mip level `mip`.
            #[must_use]
            pub const fn mip(mut self, mip: u8) -> Self {
                (self.range.mip, self.range.mips) = (mip, 1);
                self
            }

            /// Restricts the part to array layer `layer`.
            #[must_use]
            pub const fn layer(mut self, layer: u16) -> Self {
                (self.range.layer, self.range.layers) = (layer, 1);
                self
            }

            /// Restricts the part to one plane.
            #[must_use]
            pub const fn aspect(mut self, aspect: Aspect) -> Self {
                self.range.aspect = aspect;
                self
            }

            /// Views the part in the sRGB twin of the texture's format; see [`Texture::viewed_as`].
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
    /// Returns the range of `bytes` bytes from `offset` on.
    ///
    /// The compiler tracks the contents of ranges separately: a write to one range does not affect other bytes. Ranges
    /// may overlap; each byte holds the value of the last pass that wrote it.
    ///
    /// A range does not follow the frame size. For a buffer with a relative size, compute the range with
    /// [`Extent::texels`](crate::Extent::texels) and declare the graph again after a resize.
    ///
    /// Devices require offsets to be multiples of an alignment (wgpu: up to 256 bytes for uniform and storage buffers,
    /// 4 for others). Offsets are not rounded.
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

/// The destination of a pass's result: a new texture, or one chosen by the caller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// The pass creates a transient texture with its preferred descriptor.
    #[default]
    New,
    /// The pass writes to this texture.
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
