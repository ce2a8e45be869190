//! A device with validation layers that collects their messages.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use crate::features::{DeviceFeatures, Synchronization};
use crate::gpu::{DeviceQueue, Gpu, GpuDesc};
use ash::vk;
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, PoisonError};

/// Messages of the layers.
type Messages = Mutex<Vec<String>>;

/// Reason that no device can be opened.
pub type OpenError = Box<dyn std::error::Error + Send + Sync>;

/// Properties of the device to open.
#[derive(Clone, Copy, Debug)]
pub struct DeviceRequest {
    /// Enables the validation layers with synchronization validation; opening fails without them.
    pub layers: bool,
    /// Commands for barriers.
    pub synchronization: Synchronization,
    /// Number of queues. If the device has fewer, queues of the layout share one queue of the device.
    pub queues: usize,
}

impl Default for DeviceRequest {
    fn default() -> Self {
        Self { layers: true, synchronization: Synchronization::Core, queues: 2 }
    }
}

/// A device that is closed when the last [`Gpu`] made from it is dropped.
///
/// # Panics
/// Closing the device panics if the layers reported errors that [`TestDevice::messages`] has not returned, for example
/// objects that were not destroyed.
pub struct TestDevice {
    opened: Arc<Opened>,
    gpu: Gpu,
    /// Number of queues of the device that differ from each other.
    pub distinct_queues: usize,
}

struct Opened {
    _entry: ash::Entry,
    instance: ash::Instance,
    device: ash::Device,
    messenger: Option<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// Box to which the messenger points.
    messages: *mut Messages,
}

// SAFETY: the pointer leads to a mutex, and Vulkan's instance and device functions used in `drop` are called by one thread.
unsafe impl Send for Opened {}
// SAFETY: shared references give access to the mutex only.
unsafe impl Sync for Opened {}

const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Stores error messages.
unsafe extern "system" fn store_message(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the loader passes a message that lives until this function returns, and the pointer given at creation of
    // the messenger, which is destroyed before the box.
    let (message, messages) = unsafe { ((*data).message_as_c_str(), &*messages.cast::<Messages>()) };
    let message = message.map_or_else(String::new, |text| text.to_string_lossy().into_owned());
    messages.lock().unwrap_or_else(PoisonError::into_inner).push(message);
    vk::FALSE
}

impl TestDevice {
    /// Opens the first suitable device, hardware before software.
    ///
    /// # Errors
    /// Returns the reason that no device is suitable.
    pub fn open(request: DeviceRequest) -> Result<Self, OpenError> {
        // SAFETY: the Vulkan loader of the system may be loaded, and every structure lives as long as the call that
        // reads it. `Opened` destroys what is created, also if a later call fails.
        unsafe {
            let entry = ash::Entry::load()?;
            let known = entry.enumerate_instance_layer_properties()?;
            if request.layers && !known.iter().any(|layer| layer.layer_name_as_c_str() == Ok(LAYER)) {
                return Err("there are no validation layers; install vulkan-validationlayers".into());
            }
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
            let mut validation = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
            let (layers, extensions) = ([LAYER.as_ptr()], [vk::EXT_DEBUG_UTILS_NAME.as_ptr()]);
            let mut info = vk::InstanceCreateInfo::default().application_info(&application);
            if request.layers {
                info =
                    info.enabled_layer_names(&layers).enabled_extension_names(&extensions).push_next(&mut validation);
            }
            let instance = entry.create_instance(&info, None)?;
            let messages = Box::into_raw(Box::<Messages>::default());
            match device(&instance, request) {
                Ok((device, queues, physical)) => {
                    let opened = Opened::new(entry, instance, device, request.layers.then_some(messages), messages)?;
                    Self::of(opened, request, &queues, physical)
                }
                Err(error) => {
                    instance.destroy_instance(None);
                    drop(Box::from_raw(messages));
                    Err(error)
                }
            }
        }
    }

    fn of(
        opened: Opened,
        request: DeviceRequest,
        queues: &[DeviceQueue],
        physical: vk::PhysicalDevice,
    ) -> Result<Self, OpenError> {
        let features = DeviceFeatures {
            synchronization: request.synchronization,
            separate_depth_stencil_layouts: true,
            store_op_none: true,
            debug_utils: request.layers,
        };
        let desc = GpuDesc { instance: &opened.instance, physical, device: &opened.device, queues, features };
        // SAFETY: the features are enabled in `device`, and `keeping` keeps the device open as long as the `Gpu`.
        // Queues are used through executors and kits of one thread at a time.
        let gpu = unsafe { Gpu::new(&desc) };
        let mut distinct: Vec<vk::Queue> = queues.iter().map(|queue| queue.raw).collect();
        distinct.sort_unstable();
        distinct.dedup();
        let opened = Arc::new(opened);
        Ok(Self { gpu: gpu.keeping(opened.clone()), opened, distinct_queues: distinct.len() })
    }

    /// Returns the device for executors.
    #[must_use]
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Returns the layers' error messages since the last call.
    #[must_use]
    pub fn messages(&self) -> Vec<String> {
        // SAFETY: the box is freed in `drop` only.
        let messages = unsafe { &*self.opened.messages };
        std::mem::take(&mut *messages.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl std::fmt::Debug for TestDevice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TestDevice").field("gpu", &self.gpu).finish_non_exhaustive()
    }
}

/// Opens a device with its queues.
///
/// # Safety
/// The instance is alive.
unsafe fn device(
    instance: &ash::Instance,
    request: DeviceRequest,
) -> Result<(ash::Device, Vec<DeviceQueue>, vk::PhysicalDevice), OpenError> {
    // SAFETY: the instance is alive, and every structure lives as long as the call that reads it.
    unsafe {
        let mut found = instance.enumerate_physical_devices()?;
        found.retain(|one| instance.get_physical_device_properties(*one).api_version >= vk::API_VERSION_1_3);
        let order = [
            vk::PhysicalDeviceType::DISCRETE_GPU,
            vk::PhysicalDeviceType::INTEGRATED_GPU,
            vk::PhysicalDeviceType::VIRTUAL_GPU,
        ];
        found.sort_by_key(|one| {
            let kind = instance.get_physical_device_properties(*one).device_type;
            order.iter().position(|known| *known == kind).unwrap_or(order.len())
        });
        let physical = *found.first().ok_or("there is no device with Vulkan 1.3")?;
        let families = instance.get_physical_device_queue_family_properties(physical);
        let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let main = families.iter().position(|family| family.queue_flags.contains(both));
        let main = main.ok_or("no queue supports both graphics and compute")? as u32;
        let computes = |at: &u32| *at != main && families[*at as usize].queue_flags.contains(vk::QueueFlags::COMPUTE);
        let second = (0..families.len() as u32).find(computes).filter(|_| request.queues > 1);
        let priorities = [1.0];
        let queue =
            |family| vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&priorities);
        let queues: Vec<_> = [Some(main), second].into_iter().flatten().map(queue).collect();
        let features = instance.get_physical_device_features(physical);
        let mut vulkan11 = vk::PhysicalDeviceVulkan11Features::default().multiview(true);
        let mut vulkan12 =
            vk::PhysicalDeviceVulkan12Features::default().timeline_semaphore(true).separate_depth_stencil_layouts(true);
        let core = request.synchronization == Synchronization::Core;
        let mut vulkan13 = vk::PhysicalDeviceVulkan13Features::default().synchronization2(core);
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&features)
            .push_next(&mut vulkan11)
            .push_next(&mut vulkan12)
            .push_next(&mut vulkan13);
        let device = instance.create_device(physical, &info, None)?;
        let of = |family| DeviceQueue { raw: device.get_device_queue(family, 0), family };
        let mut queues = vec![of(main)];
        queues.resize(request.queues.max(1), of(second.unwrap_or(main)));
        Ok((device, queues, physical))
    }
}

impl Opened {
    /// Takes over the objects, and creates the messenger if there is a box for messages.
    fn new(
        entry: ash::Entry,
        instance: ash::Instance,
        device: ash::Device,
        to: Option<*mut Messages>,
        messages: *mut Messages,
    ) -> Result<Self, OpenError> {
        let debug = to.map(|_| ash::ext::debug_utils::Instance::new(&entry, &instance));
        let mut opened = Self { _entry: entry, instance, device, messenger: None, messages };
        if let Some(debug) = debug {
            let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
                .message_severity(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR)
                .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
                .pfn_user_callback(Some(store_message))
                .user_data(messages.cast());
            // SAFETY: the box outlives the messenger, which `drop` destroys first.
            let messenger = unsafe { debug.create_debug_utils_messenger(&info, None)? };
            opened.messenger = Some((debug, messenger));
        }
        Ok(opened)
    }
}

impl Drop for Opened {
    fn drop(&mut self) {
        // SAFETY: executors and kits hold a `Gpu`, which holds this; so nothing made from the device exists anymore.
        unsafe {
            self.device.destroy_device(None);
            if let Some((debug, messenger)) = self.messenger.take() {
                debug.destroy_debug_utils_messenger(messenger, None);
            }
            self.instance.destroy_instance(None);
            let messages = Box::from_raw(self.messages).into_inner().unwrap_or_else(PoisonError::into_inner);
            // For example, objects that were not destroyed.
            assert!(messages.is_empty() || std::thread::panicking(), "the device was closed with {messages:#?}");
        }
    }
}
