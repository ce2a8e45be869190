//! Tests on the available Vulkan device, with synchronization validation.

mod bench;
mod contents;
mod errors;
mod faults;
mod frames;
mod post;
mod queues;
mod shared;
mod slices;
