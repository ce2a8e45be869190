//! Schedules plans on devices with several queues: assignment of steps, synchronization, and duration of the frame.
//!
//! wgpu has one queue, and a [`framegraph::Plan`] is a single sequence of steps. Vulkan, Direct3D 12 and Metal can run
//! compute and copies in parallel with raster work. [`schedule()`] assigns a queue to each step if that shortens the
//! frame, based on measured or estimated costs. Steps on one queue stay in the order of the plan.
//!
//! A [`Schedule`] contains everything a back end must do: semaphores ([`Wait`]), ownership transfers between queue
//! families ([`Transfer`]), and resources used concurrently by several queues.
//!
//! # Shared memory
//!
//! Resources that share memory depend on each other, so a plan with aliasing for one queue leaves little parallelism.
//! Compile it without aliasing ([`replan()`]), then share memory according to the schedule ([`share_memory()`]).
//!
//! [`check()`] and [`check_memory()`] verify the results independently of the scheduler. [`stream()`] returns the plan
//! and its schedule as a sequence of commands; [`PlanStream::stream_in`] does so with shared memory.
//!
//! # Example
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

#![cfg_attr(docsrs, feature(doc_cfg))]

mod aliasing;
mod assign;
mod check;
mod clocks;
mod estimate;
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
pub use memory::{SharedMemory, share_memory, share_memory_with};
pub use replan::replan;
pub use schedule::{QueueError, Schedule, Wait, schedule, schedule_with};
pub use stream::{Command, Memory, PlanStream, stream};
pub use text::{svg, text};
pub use transfers::Transfer;
