//! A Vulkan device with validation layers, and the objects created on it.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use ash::vk;
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

/// Error of a Vulkan call; messages of the layers are separate.
pub type Trouble = Box<dyn std::error::Error>;

/// Error messages of the layers.
type Told = Mutex<Vec<String>>;

/// An object that is destroyed with the device, in reverse order of creation.
#[derive(Clone, Copy, Debug)]
pub enum Object {
    Memory(vk::DeviceMemory),
    Image(vk::Image),
    View(vk::ImageView),
    Buffer(vk::Buffer),
    RenderPass(vk::RenderPass),
    Framebuffer(vk::Framebuffer),
    SetLayout(vk::DescriptorSetLayout),
    Descriptors(vk::DescriptorPool),
    Layout(vk::PipelineLayout),
    Module(vk::ShaderModule),
    Pipeline(vk::Pipeline),
    Commands(vk::CommandPool),
    Semaphore(vk::Semaphore),
}

/// An open device with one queue, and the layers.
pub struct Device {
    _entry: ash::Entry,
    instance: ash::Instance,
    debug: ash::ext::debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    pub raw: ash::Device,
    pub queue: vk::Queue,
    pub family: u32,
    pub memory: vk::PhysicalDeviceMemoryProperties,
    pub name: String,
    pub formats: Box<dyn Fn(vk::Format) -> vk::FormatFeatureFlags>,
    /// A leaked box to which the messenger points.
    told: *mut Told,
    made: Mutex<Vec<Object>>,
}

const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Stores error messages.
unsafe extern "system" fn keep(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    told: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the loader hands over a message that lives until this returns, and the pointer that `Device::open` gave it, which
    // is freed behind the instance.
    let (message, told) = unsafe { ((*data).message_as_c_str(), &*told.cast::<Told>()) };
    let message = message.map_or_else(String::new, |text| text.to_string_lossy().into_owned());
    if let Ok(mut told) = told.lock() {
        told.push(message);
    }
    vk::FALSE
}

impl Device {
    /// Opens the first suitable device, hardware before software.
    ///
    /// # Errors
    /// Reason that no device is suitable, for a skip.
    pub fn open() -> Result<Self, Trouble> {
        // SAFETY: the loader of the system is a library that may be loaded; everything made is destroyed in `drop`, in an order
        // that Vulkan allows, and every structure lives as long as the call that reads it.
        unsafe {
            let entry = ash::Entry::load()?;
            let layers = entry.enumerate_instance_layer_properties()?;
            if !layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(LAYER)) {
                return Err("there are no validation layers".into());
            }
            let info = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
            let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
            let (layers, extensions) = ([LAYER.as_ptr()], [vk::EXT_DEBUG_UTILS_NAME.as_ptr()]);
            let info = vk::InstanceCreateInfo::default()
                .application_info(&info)
                .enabled_layer_names(&layers)
                .enabled_extension_names(&extensions)
                .push_next(&mut features);
            let instance = entry.create_instance(&info, None)?;
            let debug = ash::ext::debug_utils::Instance::new(&entry, &instance);
            let told = Box::into_raw(Box::<Told>::default());
            let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
                .message_severity(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR)
                .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
                .pfn_user_callback(Some(keep))
                .user_data(told.cast());
            let messenger = debug.create_debug_utils_messenger(&info, None)?;
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
            let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
            let families = instance.get_physical_device_queue_family_properties(physical);
            let family = families.iter().position(|family| family.queue_flags.contains(wanted));
            let family = family.ok_or("no queue both draws and computes")? as u32;
            let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
            let features = instance.get_physical_device_features(physical);
            let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_features(&features);
            let raw = instance.create_device(physical, &info, None)?;
            let properties = instance.get_physical_device_properties(physical);
            let formats = {
                let instance = instance.clone();
                move |format| instance.get_physical_device_format_properties(physical, format).optimal_tiling_features
            };
            Ok(Self {
                queue: raw.get_device_queue(family, 0),
                memory: instance.get_physical_device_memory_properties(physical),
                name: properties.device_name_as_c_str()?.to_string_lossy().into_owned(),
                _entry: entry,
                formats: Box::new(formats),
                instance,
                debug,
                messenger,
                raw,
                family,
                told,
                made: Mutex::default(),
            })
        }
    }

    /// Destroys `object` with the device, or on `clear`.
    pub fn keep(&self, object: Object) {
        self.made.lock().expect("nothing panics with it").push(object);
    }

    /// Waits for the queue, and destroys all objects created so far.
    pub fn clear(&self) {
        let mut made = self.made.lock().expect("nothing panics with it");
        // SAFETY: each object is of this device and here once, no command uses it, and what was made of others goes first.
        unsafe {
            let done = self.raw.device_wait_idle();
            assert!(done.is_ok(), "{done:?}");
            for object in made.drain(..).rev() {
                match object {
                    Object::Memory(it) => self.raw.free_memory(it, None),
                    Object::Image(it) => self.raw.destroy_image(it, None),
                    Object::View(it) => self.raw.destroy_image_view(it, None),
                    Object::Buffer(it) => self.raw.destroy_buffer(it, None),
                    Object::RenderPass(it) => self.raw.destroy_render_pass(it, None),
                    Object::Framebuffer(it) => self.raw.destroy_framebuffer(it, None),
                    Object::SetLayout(it) => self.raw.destroy_descriptor_set_layout(it, None),
                    Object::Descriptors(it) => self.raw.destroy_descriptor_pool(it, None),
                    Object::Layout(it) => self.raw.destroy_pipeline_layout(it, None),
                    Object::Module(it) => self.raw.destroy_shader_module(it, None),
                    Object::Pipeline(it) => self.raw.destroy_pipeline(it, None),
                    Object::Commands(it) => self.raw.destroy_command_pool(it, None),
                    Object::Semaphore(it) => self.raw.destroy_semaphore(it, None),
                }
            }
        }
    }

    /// Returns the layers' messages since the last call.
    pub fn told(&self) -> Vec<String> {
        // SAFETY: it is freed in `drop` alone.
        let told = unsafe { &*self.told };
        std::mem::take(&mut *told.lock().expect("nothing panics with it"))
    }

    /// Allocates device memory of one of these types.
    pub fn allocate(&self, bytes: u64, types: u32) -> Result<vk::DeviceMemory, Trouble> {
        let known = self.memory.memory_types_as_slice().iter().enumerate();
        let own = |flags: vk::MemoryPropertyFlags| {
            flags.contains(vk::MemoryPropertyFlags::DEVICE_LOCAL)
                && !flags.intersects(vk::MemoryPropertyFlags::LAZILY_ALLOCATED | vk::MemoryPropertyFlags::PROTECTED)
        };
        let mut fitting = known.filter(|(at, kind)| types & (1 << at) != 0 && own(kind.property_flags));
        let (at, _) = fitting.next().ok_or("no type of memory suits all that is in it")?;
        let info = vk::MemoryAllocateInfo::default().allocation_size(bytes).memory_type_index(at as u32);
        // SAFETY: the type is one of the device's.
        let memory = unsafe { self.raw.allocate_memory(&info, None)? };
        self.keep(Object::Memory(memory));
        Ok(memory)
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        self.clear();
        // SAFETY: everything made of the device is destroyed, and the messenger, which points to `told`, goes before it.
        unsafe {
            self.raw.destroy_device(None);
            self.debug.destroy_debug_utils_messenger(self.messenger, None);
            self.instance.destroy_instance(None);
            drop(Box::from_raw(self.told));
        }
    }
}
