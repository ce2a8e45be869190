//! Creation and destruction of objects.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use super::{Driver, Object, Thing};
use crate::error::Error;
use ash::vk;
use ash::vk::Handle;
use std::ffi::CString;

impl Driver {
    /// Creates an image without memory.
    pub(crate) fn image(&self, info: &vk::ImageCreateInfo<'_>) -> Result<vk::Image, Error> {
        // SAFETY: D2. The caller checked format and usage with the device, and takes sizes from a plan within its limits.
        unsafe { self.raw.create_image(info, None) }.map_err(Error::of("an image"))
    }

    /// Creates a buffer without memory.
    pub(crate) fn buffer(&self, info: &vk::BufferCreateInfo<'_>) -> Result<vk::Buffer, Error> {
        // SAFETY: D2. Size and usage are not empty: `Shape::buffer_info` sets both.
        unsafe { self.raw.create_buffer(info, None) }.map_err(Error::of("a buffer"))
    }

    /// Returns the memory requirements of an object.
    pub(crate) fn requirements(&self, thing: Thing) -> vk::MemoryRequirements {
        // SAFETY: D1.
        unsafe {
            match thing {
                Thing::Image(image) => self.raw.get_image_memory_requirements(image),
                Thing::Buffer(buffer) => self.raw.get_buffer_memory_requirements(buffer),
            }
        }
    }

    /// Returns the index of a memory type with all of `wanted` and none of `unwanted`, among the bits of `types`.
    pub(crate) fn memory_type(
        &self,
        types: u32,
        wanted: vk::MemoryPropertyFlags,
        unwanted: vk::MemoryPropertyFlags,
    ) -> Option<u32> {
        let kinds = self.memory.memory_types_as_slice().iter();
        let fits = |(at, kind): &(u32, &vk::MemoryType)| {
            types & (1 << at) != 0 && kind.property_flags.contains(wanted) && !kind.property_flags.intersects(unwanted)
        };
        (0..).zip(kinds).find(fits).map(|(at, _)| at)
    }

    /// Allocates memory of a type.
    pub(crate) fn allocate(&self, bytes: u64, memory_type: u32) -> Result<vk::DeviceMemory, Error> {
        let info = vk::MemoryAllocateInfo::default().allocation_size(bytes).memory_type_index(memory_type);
        // SAFETY: D2. The type is one of the device's, from `memory_type`.
        unsafe { self.raw.allocate_memory(&info, None) }.map_err(Error::of("an allocation of memory"))
    }

    /// Binds memory to a new object.
    pub(crate) fn bind(&self, thing: Thing, memory: vk::DeviceMemory, offset: u64) -> Result<(), Error> {
        // SAFETY: D1. The object is new. The caller compared type and alignment with the requirements, and allocated enough bytes.
        unsafe {
            match thing {
                Thing::Image(image) => self.raw.bind_image_memory(image, memory, offset),
                Thing::Buffer(buffer) => self.raw.bind_buffer_memory(buffer, memory, offset),
            }
        }
        .map_err(Error::of("memory of a resource"))
    }

    /// Returns the bytes that back lazily allocated memory at the moment.
    pub(crate) fn committed_bytes(&self, memory: vk::DeviceMemory) -> u64 {
        // SAFETY: D1. The caller passes memory of a lazily allocated type only.
        unsafe { self.raw.get_device_memory_commitment(memory) }
    }

    /// Creates a view.
    pub(crate) fn view(&self, info: &vk::ImageViewCreateInfo<'_>) -> Result<vk::ImageView, Error> {
        // SAFETY: D1, D2. The range is one of an access, which the compiler checked against the texture.
        unsafe { self.raw.create_image_view(info, None) }.map_err(Error::of("an image view"))
    }

    /// Creates a render pass.
    pub(crate) fn render_pass(&self, info: &vk::RenderPassCreateInfo2<'_>) -> Result<vk::RenderPass, Error> {
        // SAFETY: D2. Attachment indices are below the number of attachments: `subpass::subpasses` takes them from the
        // step's list.
        unsafe { self.raw.create_render_pass2(info, None) }.map_err(Error::of("a render pass"))
    }

    /// Creates a framebuffer.
    pub(crate) fn framebuffer(&self, info: &vk::FramebufferCreateInfo<'_>) -> Result<vk::Framebuffer, Error> {
        // SAFETY: D1, D2. The views are those of the step's attachments, in order.
        unsafe { self.raw.create_framebuffer(info, None) }.map_err(Error::of("a framebuffer"))
    }

    /// Creates a pool of command buffers of a queue family.
    pub(crate) fn command_pool(&self, family: u32) -> Result<vk::CommandPool, Error> {
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(family);
        // SAFETY: D2. The family is one of those given to `Gpu::new`.
        unsafe { self.raw.create_command_pool(&info, None) }.map_err(Error::of("a command pool"))
    }

    /// Creates a pool of timestamps.
    pub(crate) fn timestamps(&self, count: u32) -> Result<vk::QueryPool, Error> {
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(count.max(1));
        // SAFETY: D2. The count is not 0.
        unsafe { self.raw.create_query_pool(&info, None) }.map_err(Error::of("a query pool"))
    }

    /// Creates a timeline semaphore with value 0.
    pub(crate) fn timeline(&self) -> Result<vk::Semaphore, Error> {
        let mut kind = vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
        let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
        // SAFETY: D2. `Gpu::new` requires the feature of timeline semaphores.
        unsafe { self.raw.create_semaphore(&info, None) }.map_err(Error::of("a timeline semaphore"))
    }

    /// Destroys an object.
    pub(crate) fn destroy(&self, object: Object) {
        // SAFETY: D1, D3.
        unsafe {
            match object {
                Object::Memory(it) => self.raw.free_memory(it, None),
                Object::Image(it) => self.raw.destroy_image(it, None),
                Object::Buffer(it) => self.raw.destroy_buffer(it, None),
                Object::View(it) => self.raw.destroy_image_view(it, None),
                Object::RenderPass(it) => self.raw.destroy_render_pass(it, None),
                Object::Framebuffer(it) => self.raw.destroy_framebuffer(it, None),
                Object::CommandPool(it) => self.raw.destroy_command_pool(it, None),
                Object::QueryPool(it) => self.raw.destroy_query_pool(it, None),
                Object::Semaphore(it) => self.raw.destroy_semaphore(it, None),
            }
        }
    }

    /// Names an object in debuggers and validation messages, if the extension is enabled.
    pub(crate) fn name(&self, thing: Thing, name: &str) {
        let (Some(debug), Ok(name)) = (&self.debug, CString::new(name)) else { return };
        let (kind, handle) = match thing {
            Thing::Image(image) => (vk::ObjectType::IMAGE, image.as_raw()),
            Thing::Buffer(buffer) => (vk::ObjectType::BUFFER, buffer.as_raw()),
        };
        let mut info = vk::DebugUtilsObjectNameInfoEXT::default().object_name(&name);
        (info.object_type, info.object_handle) = (kind, handle);
        // SAFETY: D1, D2. A name is only information: a failure changes nothing.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }
}
