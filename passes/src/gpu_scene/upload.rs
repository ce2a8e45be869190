//! The scene on the GPU: buffers, textures and samplers, in the layout of `framegraph_shaders::layout`.
//!
//! One buffer holds the positions of all meshes, one their other attributes, one their indices, one
//! the factors of all materials; draws say where in them. Images are uploaded once for each role
//! they play, with their own mip levels or levels made here, on all cores. Bind groups are the passes' business:
//! [`GpuScene::material_binding`] says what goes into the material's.

mod bodies;
mod buffers;
mod environment;
mod error;
mod instances;
mod material;
pub(crate) mod mesh_range;
pub mod pack;
mod scene;
mod stencil;
mod textures;

pub use environment::GpuEnvironment;
pub use error::UploadError;
pub use instances::InstanceDraw;
pub use material::{MATERIAL_BINDINGS, TEXTURE_TRAITS, features_of, material_traits};
pub use mesh_range::MeshRange;
pub use scene::GpuScene;
pub use textures::block_formats;

#[cfg(test)]
mod tests;
