//! Size limits of the importer. Larger files are rejected with an error instead of exhausting memory or exceeding the
//! f32 range of shaders.

/// Maximum width and height of an image, in texels.
pub const MAX_IMAGE_SIDE_TEXELS: u32 = 16384;

/// Maximum number of instances.
pub const MAX_INSTANCES: usize = 1 << 22;

pub use crate::bounds::MAX_COORDINATE_M;

/// Maximum number of elements of an accessor; vertex and corner numbers stay well within 32 bits.
pub(super) const MAX_ELEMENTS: u64 = 1 << 28;

/// Maximum number of nodes.
pub(super) const MAX_NODES: usize = 1 << 22;
