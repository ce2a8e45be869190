//! All Vulkan calls of the executor. Other modules of the crate decide what to create and record; these functions only
//! make the calls.
//!
//! The functions are safe for the rest of the crate because of four rules, which the `SAFETY` comments refer to:
//!
//! - **D1.** Handles come from the device of the [`Driver`]: it created them, or the caller of an `unsafe` function
//!   promised so ([`Gpu::new`](crate::Gpu::new), [`Imports`](crate::Imports)).
//! - **D2.** Structures outlive the call that reads them, because they are built in the same scope or borrowed.
//! - **D3.** An object is destroyed once: when it leaves the list of its owner, after the GPU has finished with it.
//! - **D4.** Command buffers are recorded and submitted by one executor, which is borrowed mutably.

mod create;
mod record;
mod submit;

use crate::features::{DeviceFeatures, Synchronization};
use ash::vk;
pub(crate) use record::{BufferBarrier, Dependencies, ImageBarrier, Scope};
pub(crate) use submit::{Submission, TimelinePoint};

/// An object that an executor owns.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Object {
    Memory(vk::DeviceMemory),
    Image(vk::Image),
    Buffer(vk::Buffer),
    View(vk::ImageView),
    RenderPass(vk::RenderPass),
    Framebuffer(vk::Framebuffer),
    CommandPool(vk::CommandPool),
    QueryPool(vk::QueryPool),
    Semaphore(vk::Semaphore),
}

/// An image or a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Thing {
    Image(vk::Image),
    Buffer(vk::Buffer),
}

/// Functions of a device.
pub(crate) struct Driver {
    pub(crate) raw: ash::Device,
    synchronization: Synchronization,
    synchronization2: Option<ash::khr::synchronization2::Device>,
    debug: Option<ash::ext::debug_utils::Device>,
    pub(crate) memory: vk::PhysicalDeviceMemoryProperties,
}

impl Driver {
    pub(crate) fn new(
        instance: &ash::Instance,
        device: &ash::Device,
        features: DeviceFeatures,
        memory: vk::PhysicalDeviceMemoryProperties,
    ) -> Self {
        let extension = features.synchronization == Synchronization::Extension;
        Self {
            raw: device.clone(),
            synchronization: features.synchronization,
            synchronization2: extension.then(|| ash::khr::synchronization2::Device::new(instance, device)),
            debug: features.debug_utils.then(|| ash::ext::debug_utils::Device::new(instance, device)),
            memory,
        }
    }
}
