//! Accesses of passes to resources: kind, intent of a write, and range.

mod kinds;
mod range;

use crate::enum_names::{bits, enum_names};
use crate::id::{ResourceId, VersionId};
use crate::resolve::ResolveMode;
pub(crate) use kinds::Kinds;
pub use range::{ByteRange, Range};

/// The kind of an access. Kinds marked *Raster* require a raster pass.
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
    /// Raster: the single-sample target of a multisampled color or depth attachment at the end of the step.
    Resolve,
    /// Raster: a read of the texel under the fragment; stays in the tile if the device supports it.
    SamePixel,
    /// A texture read through a sampler or by texel fetch.
    Sampled,
    /// A storage texture or buffer that is read.
    StorageRead,
    /// A storage texture or buffer that is written, or read and written with `Modify`.
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
    /// Returns `true` for attachments and resolve targets.
    #[inline]
    pub const fn is_attachment(self) -> bool {
        matches!(self, Self::Color | Self::Depth | Self::DepthReadOnly | Self::Resolve)
    }

    /// Returns `true` for depth-stencil attachments, read-only or not.
    #[inline]
    pub const fn is_depth(self) -> bool {
        matches!(self, Self::Depth | Self::DepthReadOnly)
    }

    /// Returns `true` if the access requires a raster pass.
    #[inline]
    pub const fn needs_raster(self) -> bool {
        self.is_attachment() || matches!(self, Self::SamePixel | Self::Vertex | Self::Index)
    }

    /// Returns the usage flag that the physical resource needs for this access.
    #[inline]
    pub const fn usage(self) -> Usage {
        // A table in the order of the kinds, because it is used for every access.
        #[rustfmt::skip]
        const USAGES: [Usage; 14] = [
            Usage::ATTACHMENT, Usage::ATTACHMENT, Usage::ATTACHMENT, Usage::ATTACHMENT, Usage::INPUT_ATTACHMENT,
            Usage::SAMPLED, Usage::STORAGE, Usage::STORAGE, Usage::UNIFORM, Usage::VERTEX, Usage::INDEX, Usage::INDIRECT,
            Usage::COPY_SOURCE, Usage::COPY_TARGET,
        ];
        USAGES[self as usize]
    }
}

enum_names! {
    AccessKind:
    Color "color", Depth "depth", DepthReadOnly "depth_read_only", Resolve "resolve", SamePixel "same_pixel",
    Sampled "sampled", StorageRead "storage_read", StorageWrite "storage_write", Uniform "uniform", Vertex "vertex",
    Index "index", Indirect "indirect", CopySource "copy_source", CopyTarget "copy_target"
}

/// Effect of a write on the previous contents. Determines loads, stores and culling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Intent {
    /// Sets every texel of the range to this value first; the previous contents are lost.
    Clear(ClearValue),
    /// Writes every texel of the range; the previous contents are lost.
    Overwrite,
    /// Uses the previous contents: blending, depth testing, partial writes.
    Modify,
}

/// The value of a cleared resource.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum ClearValue {
    /// Red, green, blue and alpha; linear, in the range of the format.
    Color([f64; 4]),
    /// Depth from 0 to 1 (with reversed Z, 0 is the far plane), and stencil.
    DepthStencil(f32, u32),
    /// All bytes zero, for buffers and storage textures.
    Zero,
}

impl ClearValue {
    /// Opaque black: color 0, alpha 1.
    pub const BLACK: Self = Self::Color([0.0, 0.0, 0.0, 1.0]);
    /// All four channels zero.
    pub const TRANSPARENT: Self = Self::Color([0.0; 4]);
    /// Depth 0: the far plane when Z is reversed. Stencil 0.
    pub const FAR_REVERSED: Self = Self::DepthStencil(0.0, 0);
    /// Depth 1: the far plane of a standard depth range. Stencil 0.
    pub const FAR: Self = Self::DepthStencil(1.0, 0);
}

impl PartialEq for ClearValue {
    /// Compares bit by bit: a NaN equals itself, and −0 differs from 0.
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

/// The intent of an access without its clear value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Mode {
    /// Uses the contents and leaves them unchanged.
    Read,
    /// Discards the previous contents; the range holds the clear value before the pass writes.
    Clear,
    /// Discards the previous contents; the pass writes every texel of the range.
    Overwrite,
    /// Uses the previous contents and changes them.
    Modify,
}

impl Mode {
    /// Returns `true` if the contents change.
    #[inline]
    pub const fn writes(self) -> bool {
        !matches!(self, Self::Read)
    }

    /// Returns `true` if the previous contents are used.
    #[inline]
    pub const fn needs_contents(self) -> bool {
        matches!(self, Self::Read | Self::Modify)
    }
}

enum_names! { Mode: Read "read", Clear "clear", Overwrite "overwrite", Modify "modify" }

/// One row of [`Graph::accesses`](crate::graph::Tables::accesses).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// The accessed resource.
    pub resource: ResourceId,
    /// The version that is read; for a write, the version it creates.
    pub version: VersionId,
    /// Accessed levels, layers and planes, or bytes.
    pub range: Range,
    /// Kind of the access: attachment, sampled, storage and so on.
    pub kind: AccessKind,
    /// Read or write, and what happens to the previous contents.
    pub mode: Mode,
    /// Color slot of a color attachment, or of the attachment that a resolve reads; [`Access::DEPTH`] for depth.
    pub slot: u8,
    /// Mode of a resolve; unused for other accesses.
    pub resolve: ResolveMode,
    /// Index into [`Graph::clears`](crate::graph::Tables::clears) if the mode is `Clear`.
    pub clear: u32,
}

impl Access {
    /// Value of `slot` for a resolve of the depth attachment.
    pub const DEPTH: u8 = 15;

    /// Returns `true` if the access uses the previous contents, or keeps a part of them: other slices of a
    /// three-dimensional texture.
    #[inline]
    pub const fn needs_contents(&self) -> bool {
        self.mode.needs_contents() || self.range.slice
    }

    /// Returns `true` if this access attaches the samples that `resolve`, an access of the same pass, resolves.
    #[inline]
    pub const fn is_resolved_by(&self, resolve: &Self) -> bool {
        match self.kind {
            AccessKind::Color => self.slot == resolve.slot,
            AccessKind::Depth | AccessKind::DepthReadOnly => resolve.slot == Self::DEPTH,
            _ => false,
        }
    }
}

bits! {
    /// Usages of a physical resource, as a set of bits.
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
    /// Returns the usages of `self` that are not in `other`.
    #[inline]
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Returns `true` if the set is empty.
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
