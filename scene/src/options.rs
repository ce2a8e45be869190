//! Options of loading.

use std::sync::Arc;

use crate::memory::Memory;
use crate::texture::BlockFormats;

/// Options of loading. Clones share the memory budget.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Memory budget; by default half of the machine's memory.
    pub memory: Arc<Memory>,
    /// Allows buffers and images outside of the scene's folder.
    pub allow_outside: bool,
    /// Keeps triangles and vertices in file order. By default, meshes that are not blended are reordered for faster
    /// drawing ([`order_for_drawing`](crate::geometry::order_for_drawing)).
    pub keep_order: bool,
    /// Name of the material variant to load (KHR_materials_variants); `None` for the default materials.
    pub variant: Option<String>,
    /// Block-compressed formats supported by the target device. Basis Universal textures are transcoded to one of them
    /// if possible. For an open device, `passes::upload::block_formats` returns them.
    pub block_formats: BlockFormats,
}
