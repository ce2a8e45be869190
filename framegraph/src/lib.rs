//! A render graph compiler: virtual resources, culling, lifetimes, tile operations and aliasing, with no GPU types.
//!
//! Passes declare what they read and write, and with which intent ([`Intent`]: clear, overwrite, modify). From that alone
//! [`compile()`] derives a [`Plan`]: which passes run, which of them share a step, what is loaded into tile memory and what
//! is stored back, what takes no memory at all, and which resources share memory. Each decision carries its reason
//! ([`Plan::decisions`]).
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
//! # Features
//!
//! Without any, the crate depends on its packer of memory ([`pack`], a package of its own) and on an `Arc` without weak counts.
//! `files` (on by default): graphs and devices as RON (the module `file`), and
//! serde for formats, shapes, caps, options and counts. `petgraph`: the graph as a `petgraph` graph (the
//! module `dump::graph`); comes with `files`, which finds cycles with it. `testing`: the independent
//! oracle of plans, random graphs and mutants of plans.
//!
//! The phases, in order: validate, cull, order, merge, lifetimes, ops, usage, alias. Each is a free function over flat
//! arrays in a file of its own under `compile/`.

pub mod access;
mod backend;
pub mod barrier;
mod capped;
pub mod caps;
pub mod compile;
pub mod counts;
pub mod decision;
pub mod declare;
pub mod diff;
pub mod dump;
pub mod error;
mod faults;
#[cfg(feature = "files")]
pub mod file;
pub mod format;
pub mod graph;
pub mod handle;
mod hint;
pub mod id;
mod inspect;
pub mod options;
pub mod pass_builder;
pub mod plain;
pub mod plan;
pub mod resolve;
pub mod resource;
#[cfg(feature = "testing")]
pub mod testing;
mod warning;
mod words;

pub use access::{Access, AccessKind, ByteRange, ClearValue, Intent, Mode, Range, Usage};
pub use backend::Scope;
pub use barrier::{Barrier, Stages, State};
pub use capped::Errors;
pub use caps::Caps;
pub use compile::{CompileError, CompileErrors, CompileReason, Scratch, ShapeFault, compile, compile_after, recompile};
pub use counts::{Counts, Traffic};
pub use decision::{Decision, MemoryNeed, Reason, Refusal, Subject};
pub use declare::Pass;
pub use diff::{Diff, diff};
pub use error::{DeclareError, DeclareReason, ForwardFault, Named, StaleUser};
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
#[cfg(feature = "testing")]
pub use testing::check::{self, check};
pub use warning::Warning;
