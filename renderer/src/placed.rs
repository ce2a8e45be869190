//! Placed resources: textures and buffers at offsets in one block of memory. Executes [`framegraph::Alias::Heap`] on
//! Vulkan.
//!
//! wgpu allocates separate memory for each texture. This module creates the images through Vulkan directly, binds them
//! to one block at the plan's offsets, and imports them into wgpu. [`Executor::compile`](crate::Executor::compile)
//! queries their sizes from the driver and passes them to the compiler.
//!
//! wgpu does not know that the memory is shared, so this module adds the synchronization:
//!
//! - Before the first use in a frame, a Vulkan barrier waits for all earlier work. It moves the image from the
//!   undefined layout to the layout that wgpu tracks, its *resting usage*. The old contents are discarded.
//! - After the last use, wgpu moves the image back to its resting usage.
//! - wgpu inserts the first transition of a texture in a command buffer before that buffer. Command buffers are
//!   therefore split wherever memory changes its owner ([`alias_barriers`](alias_barriers::alias_barriers)), and the barriers are
//!   submitted in between.
//!
//! wgpu never zero-initializes placed resources. `execute/attachments.rs` stores attachments instead of discarding them
//! where wgpu would fill them afterwards. `resources/requests.rs` does not place textures that need wgpu's clear.

pub(crate) mod alias_barriers;
pub(crate) mod arenas;
#[cfg(all(feature = "vulkan", any(windows, target_os = "linux", target_os = "android", target_os = "freebsd")))]
pub(crate) mod driver;
#[cfg(not(all(feature = "vulkan", any(windows, target_os = "linux", target_os = "android", target_os = "freebsd"))))]
#[path = "placed/no_driver.rs"]
pub(crate) mod driver;
pub(crate) mod not_placed;
#[cfg_attr(
    not(all(feature = "vulkan", any(windows, target_os = "linux", target_os = "android", target_os = "freebsd"))),
    expect(dead_code, reason = "nothing is placed")
)]
pub(crate) mod resting_usage;
pub(crate) mod shape;
pub(crate) mod submission;
