//! The scene on the GPU: buffers, textures and samplers, in the layout of `framegraph_shaders::layout`.
//!
//! All meshes share a buffer of positions, one of other attributes and one of indices. All materials share a buffer of
//! factors. Images are uploaded once for each role, with mip levels of the file or computed on all cores. Passes
//! create the bind groups. [`GpuScene::material_binding`] returns the bindings of a material.

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
