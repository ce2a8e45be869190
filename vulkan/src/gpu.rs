//! The engine's device, with its queues and enabled features.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use crate::driver::Driver;
use crate::features::DeviceFeatures;
use ash::vk;
use framegraph::{Caps, ResolveMode, ResolveModes};
use framegraph_queues::{Queue, QueueLayout};
use std::sync::Arc;

/// A queue of the engine's device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceQueue {
    /// The queue.
    pub raw: vk::Queue,
    /// Index of its family.
    pub family: u32,
}

/// The objects of the engine that a [`Gpu`] refers to.
#[derive(Clone, Copy)]
pub struct GpuDesc<'a> {
    /// The instance.
    pub instance: &'a ash::Instance,
    /// The physical device.
    pub physical: vk::PhysicalDevice,
    /// The device.
    pub device: &'a ash::Device,
    /// The queues. The first one must support graphics and compute; the others run what their families support.
    pub queues: &'a [DeviceQueue],
    /// Enabled features.
    pub features: DeviceFeatures,
}

impl std::fmt::Debug for GpuDesc<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("GpuDesc")
            .field("queues", &self.queues)
            .field("features", &self.features)
            .finish_non_exhaustive()
    }
}

/// The engine's device. Clones refer to the same device.
#[derive(Clone)]
pub struct Gpu {
    pub(crate) shared: Arc<Shared>,
}

pub(crate) struct Shared {
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    pub(crate) driver: Driver,
    pub(crate) queues: Vec<DeviceQueue>,
    pub(crate) families: Vec<vk::QueueFamilyProperties>,
    pub(crate) features: DeviceFeatures,
    pub(crate) properties: vk::PhysicalDeviceProperties,
    depth_resolves: vk::ResolveModeFlags,
    /// Number of views of multiview that a render pass may have; its masks have 32 bits.
    pub(crate) max_views: u32,
    /// Owner of the device, if it is to be kept open.
    #[cfg(feature = "testing")]
    keep: Option<Arc<dyn std::any::Any + Send + Sync>>,
}

impl std::fmt::Debug for Gpu {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gpu").field("name", &self.name()).field("queues", &self.shared.queues).finish_non_exhaustive()
    }
}

impl Gpu {
    /// Wraps the device of an engine.
    ///
    /// # Safety
    /// - The instance and the device stay alive until the last clone of the `Gpu` and every executor made from it are
    ///   dropped.
    /// - The device supports Vulkan 1.2 and has timeline semaphores enabled, and everything in `desc.features`.
    /// - The queues belong to the device, and the first one supports graphics and compute.
    /// - While a method of an executor runs, no other thread uses these queues.
    ///
    /// # Panics
    /// Panics if there are no queues.
    #[must_use]
    pub unsafe fn new(desc: &GpuDesc<'_>) -> Self {
        assert!(!desc.queues.is_empty(), "a device needs at least one queue");
        let GpuDesc { instance, physical, device, queues, features } = *desc;
        // SAFETY: the caller promises that the physical device belongs to the instance, and both are alive.
        let (memory, families, properties, depth_resolves, max_views) = unsafe {
            let mut resolves = vk::PhysicalDeviceDepthStencilResolveProperties::default();
            let mut views = vk::PhysicalDeviceMultiviewProperties::default();
            let mut properties =
                vk::PhysicalDeviceProperties2::default().push_next(&mut resolves).push_next(&mut views);
            instance.get_physical_device_properties2(physical, &mut properties);
            let properties = properties.properties;
            (
                instance.get_physical_device_memory_properties(physical),
                instance.get_physical_device_queue_family_properties(physical),
                properties,
                resolves.supported_depth_resolve_modes,
                views.max_multiview_view_count.min(32),
            )
        };
        let driver = Driver::new(instance, device, features, memory);
        let (instance, queues) = (instance.clone(), queues.to_vec());
        let shared = Shared {
            instance,
            physical,
            driver,
            queues,
            families,
            features,
            properties,
            depth_resolves,
            max_views,
            #[cfg(feature = "testing")]
            keep: None,
        };
        Self { shared: Arc::new(shared) }
    }

    /// Keeps the owner of the device alive as long as the device is used. Has no effect on a device with clones.
    #[cfg(feature = "testing")]
    pub(crate) fn keeping(mut self, owner: Arc<dyn std::any::Any + Send + Sync>) -> Self {
        if let Some(shared) = Arc::get_mut(&mut self.shared) {
            shared.keep = Some(owner);
        }
        self
    }

    /// Returns the name of the device.
    #[must_use]
    pub fn name(&self) -> String {
        let name = self.shared.properties.device_name_as_c_str();
        name.map_or_else(|_| String::from("?"), |name| name.to_string_lossy().into_owned())
    }

    /// Returns the device's functions, for recorders.
    #[must_use]
    pub fn device(&self) -> &ash::Device {
        &self.shared.driver.raw
    }

    /// Returns `true` if the device has memory that is allocated only when a tile is spilled.
    #[must_use]
    pub fn has_lazy_memory(&self) -> bool {
        let lazy = vk::MemoryPropertyFlags::LAZILY_ALLOCATED;
        self.shared.driver.memory_type(u32::MAX, lazy, vk::MemoryPropertyFlags::PROTECTED).is_some()
    }

    /// Returns the capabilities of the device for compiling graphs.
    ///
    /// Same-pixel reads become input attachments. Attachments that never leave the tile are memoryless if the device
    /// has lazily allocated memory; otherwise they share the heap with other resources.
    #[must_use]
    pub fn caps(&self) -> Caps {
        let limits = &self.shared.properties.limits;
        let counts = limits.framebuffer_color_sample_counts & limits.framebuffer_depth_sample_counts;
        let modes = [
            (vk::ResolveModeFlags::SAMPLE_ZERO, ResolveMode::Sample0),
            (vk::ResolveModeFlags::MIN, ResolveMode::Min),
            (vk::ResolveModeFlags::MAX, ResolveMode::Max),
        ];
        let offered = modes.iter().filter(|(flag, _)| self.shared.depth_resolves.contains(*flag));
        let offered: Vec<_> = offered.map(|(_, mode)| *mode).collect();
        let lazy = self.has_lazy_memory();
        let others = || self.shared.queues.iter().skip(1).map(|queue| self.flags(queue.family));
        Caps {
            name: self.name(),
            max_color_attachments: limits.max_color_attachments.min(8) as u8,
            max_attached_layers: limits.max_framebuffer_layers,
            max_volume_texels: limits.max_image_dimension3_d,
            max_texture_texels: limits.max_image_dimension2_d,
            max_texture_layers: limits.max_image_array_layers,
            max_buffer_bytes: u64::from(limits.max_storage_buffer_range),
            max_samples: [16, 8, 4].into_iter().find(|n| counts.as_raw() & n != 0).unwrap_or(1) as u8,
            memoryless: lazy,
            memoryless_layers: lazy,
            memoryless_saves: lazy,
            same_pixel: true,
            slot_mapping: true,
            inline: false,
            separate_planes: self.shared.features.separate_depth_stencil_layouts,
            depth_resolves: ResolveModes::of(&offered),
            placed_histories: false,
            separate_heaps: true,
            explicit_barriers: true,
            compute_queue: others().any(|flags| flags.contains(vk::QueueFlags::COMPUTE)),
            copy_queue: others().any(|flags| !flags.intersects(vk::QueueFlags::COMPUTE | vk::QueueFlags::GRAPHICS)),
            ..Caps::desktop()
        }
    }

    /// Returns the queues for [`framegraph_queues::schedule`].
    #[must_use]
    pub fn queue_layout(&self) -> QueueLayout {
        let queue = |(at, queue): (usize, &DeviceQueue)| {
            let flags = self.flags(queue.family);
            Queue {
                name: format!("queue {at}"),
                raster: flags.contains(vk::QueueFlags::GRAPHICS),
                compute: flags.contains(vk::QueueFlags::COMPUTE),
                copy: true,
            }
        };
        let queues = self.shared.queues.iter().enumerate().map(queue).collect();
        QueueLayout { queues, semaphore_us: QueueLayout::SEMAPHORE_US }
    }

    fn flags(&self, family: u32) -> vk::QueueFlags {
        self.shared.families.get(family as usize).map_or(vk::QueueFlags::empty(), |row| row.queue_flags)
    }

    /// Returns `true` if the device creates images with these parameters.
    pub(crate) fn supports(&self, info: &vk::ImageCreateInfo<'_>) -> bool {
        let Shared { instance, physical, .. } = &*self.shared;
        // SAFETY: the instance is alive, by the promise to `Gpu::new`.
        let found = unsafe {
            instance.get_physical_device_image_format_properties(
                *physical,
                info.format,
                info.image_type,
                info.tiling,
                info.usage,
                info.flags,
            )
        };
        found.is_ok_and(|found| {
            let fits =
                |a: vk::Extent3D, b: vk::Extent3D| a.width <= b.width && a.height <= b.height && a.depth <= b.depth;
            fits(info.extent, found.max_extent)
                && info.mip_levels <= found.max_mip_levels
                && info.array_layers <= found.max_array_layers
                && found.sample_counts.contains(info.samples)
        })
    }
}
