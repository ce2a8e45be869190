//! The scene as plain data: meshes, materials, textures, instances, lights, cameras, environment.
//!
//! ```text
//! glTF, GLB ──> import ──┐
//! built-in name ─────────┼──> Scene (plain arrays, ids are positions)
//! .hdr, .exr, .ktx, sky ─┘         └──> bounds, draw lists, frustum, orbit: pure functions
//! ```
//!
//! Nothing here knows a GPU. Meters, right-handed, y up, linear Rec.709, lux, candela and nits throughout. What a file
//! says is checked once, at import; a `Scene` that was returned holds finite numbers and valid ids only.
//!
//! Features, all on by default:
//!
//! - `gltf`: import of scenes.
//! - `draco` and `meshopt`: compressed geometry in scenes.
//! - `png`, `jpeg` and `webp`: textures, and pictures in general.
//! - `basisu`: textures in KTX2 files, with texels of Basis Universal (ETC1S, UASTC) or of eight bits a channel.
//! - `exr`: environments from OpenEXR, and writing such files.
//!
//! Without any of them the plain data, the built-in scenes, cameras, the sky and Radiance `.hdr` environments remain.

pub mod batch;
pub mod bounds;
pub mod boxes;
pub mod builtin;
pub mod camera;
mod check;
mod codec;
pub mod color;
pub mod color_table;
pub mod draw_list;
pub mod draw_options;
pub mod environment;
pub mod error;
pub mod frustum;
pub mod geometry;
pub mod id;
#[cfg(feature = "gltf")]
pub mod import;
pub mod instance;
pub mod levels;
pub mod light;
pub mod material;
pub mod memory;
pub mod mesh;
#[cfg(feature = "meshopt")]
mod meshopt;
pub mod mips;
pub mod motion;
mod moves;
mod open;
mod options;
mod overlap;
pub mod parallel;
pub mod picture;
pub mod progress;
mod radix;
mod read;
pub mod renderables;
mod scene;
mod stage;
#[cfg(test)]
mod test_files;
pub mod texture;

pub use batch::{Batch, BatchOrder, Groups};
pub use bounds::Aabb;
pub use boxes::BoxArrays;
pub use builtin::builtin;
pub use camera::{Camera, CameraChoice, Projection};
pub use check::InvalidScene;
pub use color_table::ColorTable;
pub use draw_list::DrawLists;
pub use draw_options::DrawOptions;
pub use environment::Environment;
pub use error::SceneError;
pub use frustum::Frustum;
pub use id::Id;
pub use instance::Instance;
pub use levels::InstanceLevels;
pub use light::{Light, LightKind, SunHalo};
pub use material::{
    AlphaMode, Anisotropy, ClearCoat, DiffuseTransmission, EmissiveUnit, Iridescence, Lobe, Lobes, Material,
    MaterialId, Sheen, Specular, Transmission, TransparencyMode, Volume,
};
pub use memory::Memory;
pub use mesh::{Mesh, MeshError, MeshId, MeshLevel, Topology};
pub use options::LoadOptions;
pub use overlap::{SHADED_POINTS, shaded_at_points};
pub use progress::{Progress, ProgressFn, Stage};
pub use renderables::{DrawKind, Renderables};
pub use scene::Scene;
pub use texture::{
    BlockFormats, Image, ImageFormat, ImageId, Sampler, SamplerId, Texture, TextureId, TextureRole, TextureSlot,
    UvTransform,
};

/// The example of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
