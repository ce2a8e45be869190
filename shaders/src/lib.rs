//! This crate provides the WGSL shaders of the standard frame, a resolver for their imports, and Rust types that match
//! them. It depends on naga but not on wgpu: it returns shader text and plain data, and never needs a device.
//!
//! # Overview
//!
//! The shaders are files embedded in the program:
//!
//! - `wgsl/lib/` holds pure functions, one topic per file.
//! - `wgsl/interface/` holds the structs and bindings that several passes share.
//! - `wgsl/shading/` assembles the library into the lighting of the color pass.
//! - `wgsl/effect/` holds point-wise effects, such as exposure and tone mapping.
//! - `wgsl/pass/` holds the entry points, one file per pass.
//!
//! The Rust side has four parts:
//!
//! - [`resolve()`] combines a pass with its imports into one plain WGSL text, validates it with naga and
//!   [reflects](reflect) it.
//! - [`Features`] are compile-time switches of a shader, tested in WGSL by `@if(NAME)`.
//! - [`layout`] mirrors every uniform and storage struct; a test compares sizes and offsets.
//! - [`reference`](mod@reference) has the functions of `wgsl/lib/` in f64 that programs need on the CPU, such as tone curves.
//!
//! # Example
//!
//! ```
//! use framegraph_shaders::{Effect, Features, Module, Shader, library, resolve};
//!
//! // Paths in constants are checked at compile time.
//! const POST: Module<'_> = library::pass("pass/post.wgsl").unwrap();
//! const EXPOSE: Effect<'_> = Effect { name: "expose", wgsl: library::text("effect/expose.wgsl").unwrap() };
//! const TONE: Effect<'_> = Effect { name: "tone", wgsl: library::text("effect/tone.wgsl").unwrap() };
//!
//! let post: Shader = resolve(&POST, &Features::NONE, &[EXPOSE, TONE])?;
//! let fragment = post.reflection.entry_point("fs_main").unwrap();
//! let names: Vec<&str> = fragment.bindings.iter().map(|b| b.name.as_str()).collect();
//! assert_eq!(names, ["hdr", "exposing"]);
//!
//! // Shaders of an application may import the embedded files under `package::`.
//! let own = "import package::lib::luminance::luminance;
//! @group(0) @binding(0) var picture: texture_2d<f32>;
//! @fragment fn fs_main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
//!     return vec4<f32>(luminance(textureLoad(picture, vec2<i32>(at.xy), 0).rgb));
//! }";
//! let grey = resolve(&Module::new("grey.wgsl", own), &Features::NONE, &[])?;
//! assert_eq!(grey.reflection.entry_points.len(), 1);
//! # Ok::<(), framegraph_shaders::ShaderError>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]

mod effect;
mod error;
pub mod feature;
pub mod layout;
pub mod library;
pub mod reference;
pub mod reflect;
#[cfg(feature = "replaced")]
mod replaced;
mod resolve;

pub use effect::Effect;
pub use error::ShaderError;
pub use feature::{Feature, Features};
pub use library::{Module, Source};
pub use reflect::Reflection;
pub use resolve::{Shader, resolve};
