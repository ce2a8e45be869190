//! What loading may do.

use std::sync::Arc;

use crate::memory::Memory;
use crate::texture::BlockFormats;

/// What loading may do. Clones share the budget of memory.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// How much memory it may take; half of the machine's by default.
    pub memory: Arc<Memory>,
    /// Buffers and images of a scene may lie outside of the scene's folder.
    pub allow_outside: bool,
    /// Triangles and vertices stay in the order of the file; otherwise meshes that do not blend get one that is drawn faster
    /// ([`order_for_drawing`](crate::geometry::order_for_drawing)).
    pub keep_order: bool,
    /// Name of the material variant to load (KHR_materials_variants); `None` for the default materials.
    pub variant: Option<String>,
    /// Block-compressed formats of the device that the scene is uploaded to. Basis Universal textures are transcoded to one
    /// of them where possible; `passes::upload::block_formats` returns those of an opened device.
    pub block_formats: BlockFormats,
}
