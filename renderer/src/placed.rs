//! Textures and buffers at offsets of one block of memory: what [`framegraph::Alias::Heap`] plans, executed on Vulkan.
//!
//! wgpu gives each texture memory of its own. Here the images are made beside wgpu, bound to one block at the plan's
//! offsets, and handed to wgpu as textures; their sizes are asked of the driver and become part of the plan
//! ([`Executor::compile`](crate::Executor::compile)). wgpu knows nothing of the sharing, so three things are said for it:
//!
//! - Before a texture is first used in a frame, a barrier written past wgpu waits for everything before it, and puts the
//!   image into the layout in which wgpu believes it to be (its *home*). Its old contents are dropped.
//! - After its last use, wgpu puts it back into its home.
//! - wgpu hoists the transition of a texture's first use in a command buffer to before that buffer. So a command buffer ends
//!   wherever memory changes hands ([`activations`](activation::activations)), and the barriers stand between.
//!
//! What is placed is never zero-filled by wgpu, so such a texture is not discarded where wgpu would fill it afterwards
//! (`execute/attachments.rs`), and one that takes wgpu's own clear is not placed (`resources/requests.rs`).

pub(crate) mod activation;
pub(crate) mod arenas;
#[cfg(all(feature = "vulkan", any(windows, target_os = "linux", target_os = "android", target_os = "freebsd")))]
pub(crate) mod driver;
#[cfg(not(all(feature = "vulkan", any(windows, target_os = "linux", target_os = "android", target_os = "freebsd"))))]
#[path = "placed/no_driver.rs"]
pub(crate) mod driver;
pub(crate) mod home;
pub(crate) mod not_placed;
pub(crate) mod shape;
pub(crate) mod submission;
