//! WGSL shaders and what keeps them honest.
//!
//! - `wgsl/lib/` holds pure functions, one idea a file; `wgsl/interface/` the structs and
//!   bindings that passes share; `wgsl/effect/` point-wise effects; `wgsl/pass/` the entry
//!   points, one file a pass.
//! - [`resolve()`] joins a pass with what it imports into one plain WGSL text, from sources
//!   embedded in the program, and hands it back validated and [reflected](reflect).
//! - [`layout`] mirrors every uniform and storage struct; a test compares sizes and offsets.
//! - [`reference`](mod@reference) mirrors every function of `wgsl/lib/` in f64: same file
//!   name, same function name.
//!
//! ```
//! use framegraph_shaders::{Effect, Features, Module, Shader, library, resolve};
//!
//! // Paths of constants are checked when they are compiled.
//! const POST: Module<'_> = library::pass("pass/post.wgsl").unwrap();
//! const EXPOSE: Effect<'_> = Effect { name: "expose", wgsl: library::text("effect/expose.wgsl").unwrap() };
//! const TONE: Effect<'_> = Effect { name: "tone", wgsl: library::text("effect/tone.wgsl").unwrap() };
//!
//! let post: Shader = resolve(&POST, &Features::NONE, &[EXPOSE, TONE])?;
//! let fragment = post.reflection.entry_point("fs_main").unwrap();
//! let names: Vec<&str> = fragment.bindings.iter().map(|b| b.name.as_str()).collect();
//! assert_eq!(names, ["hdr", "exposing"]);
//!
//! // A shader of one's own may import the embedded files under `package::`.
//! let own = "import package::lib::luminance::luminance;
//! @group(0) @binding(0) var picture: texture_2d<f32>;
//! @fragment fn fs_main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
//!     return vec4<f32>(luminance(textureLoad(picture, vec2<i32>(at.xy), 0).rgb));
//! }";
//! let grey = resolve(&Module::new("grey.wgsl", own), &Features::NONE, &[])?;
//! assert_eq!(grey.reflection.entry_points.len(), 1);
//! # Ok::<(), framegraph_shaders::ShaderError>(())
//! ```

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
