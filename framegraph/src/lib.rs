//! A render graph compiler that is independent of any graphics API.
//!
//! Passes declare the textures and buffers they read and write. [`compile()`] turns the declarations into a [`Plan`]:
//! the passes that run, the render passes they are merged into, their load and store operations, and the memory layout.
//! The plan also logs the reason of every decision ([`Plan::decisions`]).
//!
//! # When to use it
//!
//! - A renderer on a tile-based GPU or on several APIs. Load and store operations, memoryless attachments, merged
//!   render passes and barriers are derived.
//! - A frame that changes with its settings: unused passes are culled, and transient resources share memory.
//! - Tools and tests: a plan is plain data. It can be compared, budgeted, dumped and checked without a GPU.
//!
//! This crate does not execute anything. `framegraph-wgpu` executes plans on wgpu; an engine with its own device reads
//! the [`Plan`] instead. A frame of two or three fixed passes gains little from a render graph.
//!
//! # Example
//!
//! The compiler culls the pass `histogram`, because no other pass reads its result. The depth attachment is cleared and
//! never stored, so it needs no memory.
//!
//! ```
//! use framegraph::{
//!     Caps, ClearValue, Entry, Exit, Extent, Format, Graph, Intent, Options, Plan, Scratch, TextureDesc, compile,
//! };
//!
//! let mut graph = Graph::new();
//! let screen = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
//! let screen = graph.import_texture("screen", screen, Entry::Undefined, Exit::Keep);
//! let (hdr, depth) = graph.add_fn("scene", |pass| {
//!     let hdr = pass.texture("hdr", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
//!     let depth = pass.texture("depth", TextureDesc::new(Extent::FRAME, Format::Depth32Float));
//!     Ok((
//!         pass.color(hdr, Intent::Clear(ClearValue::BLACK))?,
//!         pass.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))?,
//!     ))
//! })?;
//! graph.add_fn("histogram", |pass| pass.sampled(depth).map(drop))?; // not needed, so culled
//! graph.add_fn("tonemap", |pass| {
//!     pass.sampled(hdr)?;
//!     pass.color(screen, Intent::Overwrite)
//! })?;
//!
//! let mut plan = Plan::new();
//! compile(&graph, &Caps::wgpu(), &Options::default(), &mut Scratch::new(), &mut plan)?;
//! let counts = plan.counts();
//! assert_eq!((counts.unresolves, counts.resolves), (0, 2)); // hdr and screen are stored, nothing is loaded
//! assert_eq!((counts.memoryless, counts.culled), (1, 1)); // depth never leaves the tile
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Map of the crate
//!
//! | module | content |
//! | --- | --- |
//! | [`graph`], [`declare`], [`pass_builder`] | declaring passes, resources and accesses |
//! | [`resource`], [`format`](mod@format), [`access`], [`resolve`] | descriptions of textures, buffers and accesses |
//! | [`handle`], [`id`] | typed handles for declaring, and ids for reading plans |
//! | [`caps`], [`options`] | the inputs of the compiler next to the graph |
//! | [`compile`](mod@compile) | the compiler and its errors |
//! | [`plan`], [`barrier`], [`counts`] | the result, its barriers and its cost |
//! | [`decision`] | the log: what was decided, and why |
//! | [`tile_heap`] | textures kept in on-chip memory from step to step |
//! | [`diff`](mod@diff), [`dump`] | comparing plans; text, JSON, DOT, Mermaid and SVG output |
//! | `file` | graphs and devices as RON files (feature `files`) |
//! | [`pack`] | the memory packer, a crate of its own |
//!
//! # Cargo features
//!
//! | feature | default | effect |
//! | --- | --- | --- |
//! | `files` | yes | the module `file`, and serde for formats, descriptors, caps, options and counts; enables `petgraph` |
//! | `petgraph` | yes | exports the graph as a `petgraph` graph (the module `dump::graph`) |
//! | `internals` | no | write access to plans, for the plan checker `framegraph-check`; not stable |
//! | `tracing` | no | spans of the crate `tracing` for compilations and their phases, with counts and bytes |
//!
//! Without features, the crate depends only on the memory packer ([`pack`]) and on `triomphe`, an `Arc` without weak
//! counts.

#![cfg_attr(docsrs, feature(doc_cfg))]

// Unit tests that look at private arrays need random graphs of this very crate, so they compile the generator into it.
#[cfg(test)]
extern crate self as framegraph;
#[cfg(test)]
#[path = "../check/src"]
mod check_source {
    #[allow(dead_code, unreachable_pub, reason = "the unit tests use a part of the generator")]
    pub(crate) mod generate;
}

pub mod access;
mod backend;
pub mod barrier;
pub mod caps;
pub mod compile;
pub mod counts;
pub mod decision;
pub mod declare;
pub mod diff;
pub mod dump;
mod enum_names;
pub mod error;
mod error_list;
mod error_macros;
#[cfg(feature = "files")]
pub mod file;
pub mod format;
pub mod graph;
pub mod handle;
mod hint;
pub mod id;
mod inspect;
#[cfg(feature = "internals")]
pub mod internals;
pub mod options;
pub mod pass_builder;
pub mod plan;
pub mod resolve;
pub mod resource;
pub mod sanitize;
mod spans;
pub mod suggest;
pub mod tile_heap;
mod warning;

pub use access::{Access, AccessKind, ByteRange, ClearValue, Intent, Mode, Range, Usage};
pub use backend::Scope;
pub use barrier::{Barrier, Stages, State};
pub use caps::{Caps, FormatCaps, FormatTable};
pub use compile::{
    CompileError, CompileErrors, CompileReason, Scratch, ShapeReason, compile, compile_after, recompile,
};
pub use counts::{Counts, Traffic};
pub use decision::{Decision, MemoryNeed, Reason, Refusal, Subject};
pub use declare::Pass;
pub use diff::{Diff, diff};
pub use error::{DeclareError, DeclareReason, ForwardReason, Named, StaleUser};
pub use error_list::Errors;
pub use format::{Aspect, Format, Numeric};
pub use framegraph_pack as pack;
pub use graph::{Declared, Export, ExportKind, Graph, PassFlags, PassKind, Version};
pub use handle::{Buffer, BufferPart, BufferView, Part, Previous, ReadOnly, Target, Texture, View};
pub use id::{AccessId, BytesId, PassId, ResourceId, SlotId, Span, StepId, VersionId};
pub use options::{Alias, Effort, Options, Order};
pub use pass_builder::{MAX_COLORS, PassBuilder};
pub use plan::{Attachment, Join, LoadOp, Memory, Placement, Plan, Planned, Role, Slot, Step, StepPass, StoreOp};
pub use resolve::{ResolveMode, ResolveModes};
pub use resource::{BufferDesc, BufferSize, Desc, Dimension, Entry, Exit, Extent, Kind, Resource, TextureDesc};
pub use tile_heap::{Kept, TileHeap};
pub use warning::Warning;
