//! Plans on devices with several queues: which step runs on which, what waits for what, and how long a frame takes then.
//!
//! wgpu has one queue, and so has a [`framegraph::Plan`]: its steps follow each other. Vulkan, Direct3D 12 and Metal run compute and
//! copies beside raster work. [`schedule()`] gives each step of a plan a queue, where that shortens the frame by what steps are
//! measured or said to cost; the order within a queue stays that of the plan. What a back end has to say is in the [`Schedule`]:
//! semaphores ([`Wait`]), transfers of ownership between queue families ([`Transfer`]), and the resources that several queues read
//! at once. Memory that resources share counts as a dependency: who gets it waits for all who had it.
//! So a plan whose memory is shared for one queue leaves little to run side by side: [`replan()`] it without, and
//! [`share_memory()`] by the schedule. [`check()`] and [`check_memory()`] judge both without the analysis that
//! made them.
//!
//! [`stream()`] is all of it, and the plan, as commands in order; with memory that is shared by the schedule
//! [`PlanStream::stream_in`].
//!
//! ```
//! use framegraph::{Caps, Extent, Format, Graph, Intent, Options, Plan, Scratch, TextureDesc, compile};
//! use framegraph_queues::{QueueLayout, schedule};
//!
//! let mut graph = Graph::new();
//! let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
//! let [map, fog, picture] = ["map", "fog", "picture"].map(|name| graph.texture(name, desc));
//! let map = graph.add_fn("shadow", |p| p.color(map, Intent::Overwrite))?;
//! let fog = graph.add_fn("fog", |p| p.storage_write(fog, Intent::Overwrite))?; // Compute, beside the map.
//! let picture = graph.add_fn("color", |p| {
//!     p.sampled(map)?;
//!     p.sampled(fog)?;
//!     p.color(picture, Intent::Overwrite)
//! })?;
//! graph.export(picture)?;
//! let mut plan = Plan::new();
//! compile(&graph, &Caps::wgpu(), &Options::for_frame(64, 64), &mut Scratch::new(), &mut plan)?;
//!
//! let costs_us = [400.0, 300.0, 900.0];
//! let scheduled = schedule(&plan, &QueueLayout::async_compute(), &costs_us)?;
//! assert_eq!(scheduled.alone_us, 1600.0);
//! assert_eq!(scheduled.total_us, 1300.0); // Fog is done while the map is drawn.
//! assert_eq!(scheduled.waits.len(), 1); // Color waits for fog.
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assign;
mod check;
mod clocks;
mod estimate;
mod hand_over;
mod hazards;
mod layout;
mod memory;
mod replan;
mod schedule;
mod simulate;
mod stream;
mod text;
mod transfers;

pub use check::{Violation, check, check_memory};
pub use estimate::estimate_us;
pub use layout::{Queue, QueueId, QueueLayout};
pub use memory::{SharedMemory, share_memory};
pub use replan::replan;
pub use schedule::{QueueError, Schedule, Wait, schedule, schedule_with};
pub use stream::{Command, Memory, PlanStream, stream};
pub use text::{svg, text};
pub use transfers::Transfer;
