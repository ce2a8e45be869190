//! How a pass touches a resource: kind of access, intent of a write, subresource range, and which pairs conflict.

mod kinds;
mod range;

use crate::id::{ResourceId, VersionId};
use crate::words::{bits, words};
pub(crate) use kinds::Kinds;
pub use range::{ByteRange, Range};

/// The kind of an access. The comment says what a pass of which kind may use it for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
pub enum AccessKind {
    /// Raster: a color attachment.
    Color,
    /// Raster: a depth or depth-stencil attachment that is tested and written.
    Depth,
    /// Raster: a depth or depth-stencil attachment that is only tested; the same pass may sample it.
    DepthReadOnly,
    /// Raster: the single-sample target that a multisampled color attachment is averaged into at the end of the step.
    Resolve,
    /// Raster: the texel under the fragment itself; stays in the tile where the device can.
    SamePixel,
    /// A texture read through a sampler or by texel fetch.
    Sampled,
    /// A storage texture or buffer that is read.
    StorageRead,
    /// A storage texture or buffer that is written (and read, when the intent is `Modify`).
    StorageWrite,
    /// A uniform buffer.
    Uniform,
    /// A vertex buffer.
    Vertex,
    /// An index buffer.
    Index,
    /// Arguments of an indirect draw or dispatch.
    Indirect,
    /// The source of a copy.
    CopySource,
    /// The target of a copy.
    CopyTarget,
}

impl AccessKind {
    /// Whether the access lives in tile memory: attachments and same-pixel reads.
    #[inline]
    pub const fn is_attachment(self) -> bool {
        matches!(self, Self::Color | Self::Depth | Self::DepthReadOnly | Self::Resolve)
    }

    /// Whether it is the depth-stencil attachment, written or not.
    #[inline]
    pub const fn is_depth(self) -> bool {
        matches!(self, Self::Depth | Self::DepthReadOnly)
    }

    /// Whether it can only be made by a raster pass.
    #[inline]
    pub const fn needs_raster(self) -> bool {
        self.is_attachment() || matches!(self, Self::SamePixel | Self::Vertex | Self::Index)
    }

    /// The usage flag that the physical resource must carry for it.
    #[inline]
    pub const fn usage(self) -> Usage {
        // A table in the order of the kinds, since compiling asks once for each access.
        #[rustfmt::skip]
        const USAGES: [Usage; 14] = [
            Usage::ATTACHMENT, Usage::ATTACHMENT, Usage::ATTACHMENT, Usage::ATTACHMENT, Usage::INPUT_ATTACHMENT,
            Usage::SAMPLED, Usage::STORAGE, Usage::STORAGE, Usage::UNIFORM, Usage::VERTEX, Usage::INDEX, Usage::INDIRECT,
            Usage::COPY_SOURCE, Usage::COPY_TARGET,
        ];
        USAGES[self as usize]
    }
}

words! {
    AccessKind:
    Color "color", Depth "depth", DepthReadOnly "depth_read_only", Resolve "resolve", SamePixel "same_pixel",
    Sampled "sampled", StorageRead "storage_read", StorageWrite "storage_write", Uniform "uniform", Vertex "vertex",
    Index "index", Indirect "indirect", CopySource "copy_source", CopyTarget "copy_target"
}

/// What a write does with the contents that were there, from which loads, stores and culling follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Intent {
    /// Every texel of the range is set to this value first; old contents are dead.
    Clear(ClearValue),
    /// Every texel of the range is written by the pass; old contents are dead.
    Overwrite,
    /// Old contents matter: blending, depth testing against what is there, partial writes.
    Modify,
}

/// What a cleared attachment holds.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum ClearValue {
    /// Red, green, blue, alpha; linear, in the units of the format.
    Color([f64; 4]),
    /// Depth in 0…1 (with reversed Z, 0 is the far plane), and stencil.
    DepthStencil(f32, u32),
    /// All bytes zero: what a buffer or storage texture is cleared to.
    Zero,
}

impl ClearValue {
    /// Opaque black: color 0, alpha 1.
    pub const BLACK: Self = Self::Color([0.0, 0.0, 0.0, 1.0]);
    /// Color zero in all four channels.
    pub const TRANSPARENT: Self = Self::Color([0.0; 4]);
    /// Depth 0: the far plane when Z is reversed. Stencil 0.
    pub const FAR_REVERSED: Self = Self::DepthStencil(0.0, 0);
    /// Depth 1: the far plane of a standard depth range. Stencil 0.
    pub const FAR: Self = Self::DepthStencil(1.0, 0);
}

impl PartialEq for ClearValue {
    /// Equal bit for bit, so that a NaN equals itself and −0 differs from 0.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Color(a), Self::Color(b)) => a.map(f64::to_bits) == b.map(f64::to_bits),
            (Self::DepthStencil(a, s), Self::DepthStencil(b, t)) => a.to_bits() == b.to_bits() && s == t,
            (Self::Zero, Self::Zero) => true,
            _ => false,
        }
    }
}

impl Eq for ClearValue {}

/// Read or write, without the clear value: what the phases look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Mode {
    /// Contents are needed and stay as they are.
    Read,
    /// Old contents are dead; the range holds the clear value before the pass writes.
    Clear,
    /// Old contents are dead; the pass writes every texel of the range.
    Overwrite,
    /// Old contents are needed and change.
    Modify,
}

impl Mode {
    /// Whether the contents change.
    #[inline]
    pub const fn writes(self) -> bool {
        !matches!(self, Self::Read)
    }

    /// Whether what was there is needed.
    #[inline]
    pub const fn needs_contents(self) -> bool {
        matches!(self, Self::Read | Self::Modify)
    }
}

words! { Mode: Read "read", Clear "clear", Overwrite "overwrite", Modify "modify" }

/// One row of [`Graph::accesses`](crate::graph::Tables::accesses).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// The resource that is touched.
    pub resource: ResourceId,
    /// The version that is read; for a write, the version that it makes.
    pub version: VersionId,
    /// Which levels, layers and planes, or bytes.
    pub range: Range,
    /// How it is touched: as attachment, sampled, storage, …
    pub kind: AccessKind,
    /// Read or write, and what becomes of old contents.
    pub mode: Mode,
    /// Color slot of a color attachment, or of the attachment that a resolve target averages.
    pub slot: u8,
    /// Index into [`Graph::clears`](crate::graph::Tables::clears) when the mode is `Clear`.
    pub clear: u32,
}

bits! {
    /// The uses that a physical resource must allow; a set of bits.
    Usage {
        /// Color or depth attachment, or resolve target.
        ATTACHMENT = 1 "attachment";
        /// Same-pixel reads (Vulkan's input attachment).
        INPUT_ATTACHMENT = 2 "input_attachment";
        /// Sampled in a shader.
        SAMPLED = 4 "sampled";
        /// Storage reads or writes.
        STORAGE = 8 "storage";
        /// Bound as a uniform buffer.
        UNIFORM = 16 "uniform";
        /// Bound as a vertex buffer.
        VERTEX = 32 "vertex";
        /// Bound as an index buffer.
        INDEX = 64 "index";
        /// Read as the arguments of indirect draws and dispatches.
        INDIRECT = 128 "indirect";
        /// Source of copies.
        COPY_SOURCE = 256 "copy_source";
        /// Target of copies.
        COPY_TARGET = 512 "copy_target";
    }
}

impl Usage {
    /// The uses of `self` that `other` has not.
    #[inline]
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether there is no use at all.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usage_is_a_set_with_names() {
        let u = Usage::SAMPLED.union(Usage::ATTACHMENT);
        assert_eq!(u.names().collect::<Vec<_>>(), ["attachment", "sampled"]);
        assert!(u.contains(Usage::SAMPLED) && u.without(Usage::SAMPLED) == Usage::ATTACHMENT);
    }
}
