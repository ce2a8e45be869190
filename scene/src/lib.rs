//! Renderer-independent 3D scenes: glTF import, materials, lights, cameras, environments and built-in test scenes.
//!
//! This crate turns files into plain arrays that a renderer uploads. It has no GPU types and no drawing code.
//!
//! ```text
//! glTF, GLB ──> import ──┐
//! built-in name ─────────┼──> Scene (plain arrays, ids are positions)
//! .hdr, .exr, .ktx, sky ─┘         └──> bounds, culling, draw lists, levels of detail: pure functions
//! ```
//!
//! # When to use it
//!
//! Use it to load glTF scenes and HDR environments for a renderer of your own, or for
//! [`framegraph-passes`](https://crates.io/crates/framegraph-passes), which uploads and draws them. Untrusted files
//! are safe to load: an invalid file returns a one-line error with the file, the place and the reason. Memory use has
//! a limit ([`LoadOptions::memory`]), and files outside of the scene's folder are not read by default.
//!
//! Do not use it as a general glTF library: it keeps only what rendering needs, cannot write files, and discards
//! `extras` except its own member. It has no scene editing, physics or streaming. For lossless access to documents, use
//! the crate `gltf`.
//!
//! # Example
//!
//! Opening a built-in scene and listing the visible instances, front to back:
//!
//! ```
//! use framegraph_scene::{DrawLists, Scene, SceneError, progress::silent};
//!
//! fn main() -> Result<(), SceneError> {
//!     let scene = Scene::open("spheres", &mut silent)?; // or a path to a .gltf or .glb file
//!     let camera = scene.default_camera(16.0 / 9.0);
//!     let lists = DrawLists::for_camera(&scene, &camera, 16.0 / 9.0);
//!     println!("{} triangles, {} opaque instances in view", scene.triangle_count(), lists.opaque.len());
//!     Ok(())
//! }
//! ```
//!
//! # Conventions
//!
//! Lengths are in meters, light is in lux, candela and nits, and colors are linear Rec.709. Axes are right-handed with
//! y up; cameras look along −z. Transforms are `f64`, so that scenes far from the origin do not jitter. Loaders
//! validate their input: a loaded [`Scene`] has finite numbers and valid ids, and [`Scene::check`] verifies this for
//! scenes built in code.
//!
//! # Features
//!
//! All features except `serde` are on by default.
//!
//! | Feature | Adds |
//! | --- | --- |
//! | `gltf` | Import of glTF 2.0 and GLB |
//! | `draco` | `KHR_draco_mesh_compression` in glTF |
//! | `meshopt` | `EXT_meshopt_compression` and `KHR_meshopt_compression` in glTF |
//! | `png` | PNG textures; reading and writing PNG images |
//! | `jpeg` | JPEG textures and images |
//! | `webp` | WebP textures and images |
//! | `basisu` | KTX2 textures: Basis Universal (ETC1S, UASTC) or eight bits a channel |
//! | `exr` | OpenEXR environments; writing OpenEXR images |
//! | `serde` | Serialization of settings |
//!
//! Without any feature the data types, built-in scenes, cameras, the procedural sky, and Radiance `.hdr` and
//! floating-point KTX environments remain.
//!
//! # Modules
//!
//! | Modules | Content |
//! | --- | --- |
//! | `import` | glTF import and its table of supported extensions; feature `gltf` |
//! | [`mod@builtin`] | Scenes generated in code |
//! | [`mesh`], [`material`], [`texture`], [`instance`], [`light`], [`camera`], [`id`] | Parts of a [`Scene`] |
//! | [`motion`] | Node hierarchy, animations, skins and morph targets |
//! | [`environment`] | Environment maps, spherical harmonics, procedural sky, sun extraction |
//! | [`geometry`], [`levels`], [`mips`] | Shapes, levels of detail, triangle order, mip levels |
//! | [`bounds`], [`boxes`], [`frustum`] | Bounding boxes and frustum culling |
//! | [`renderables`], [`draw_list`], [`draw_options`], [`batch`] | Sorted draw lists and batches |
//! | [`color`], [`color_table`], [`picture`] | Color conversions, `.cube` tables, image files |
//! | [`memory`], [`progress`], [`parallel`], [`error`] | Memory budget, progress reports, threads, errors |

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod batch;
mod blocks;
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

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
