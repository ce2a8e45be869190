//! How large things may be. Files beyond these are refused by name instead of exhausting memory or
//! leaving the range in which shaders stay finite.

/// Either side of an image, in texels.
pub const MAX_IMAGE_SIDE_TEXELS: u32 = 16384;

/// How often meshes are placed.
pub const MAX_INSTANCES: usize = 1 << 22;

pub use crate::bounds::MAX_COORDINATE_M;

/// Elements of one accessor: vertex numbers and corner numbers stay well inside 32 bits.
pub(super) const MAX_ELEMENTS: u64 = 1 << 28;

/// A GPU index must tell every vertex apart, with room for vertices that splitting adds.
pub(super) const MAX_NODES: usize = 1 << 22;
