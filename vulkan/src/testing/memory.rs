//! Buffers that the CPU writes and reads, and readback of images.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use super::kit::Kit;
use crate::cx::BoundBuffer;
use crate::driver::{Dependencies, ImageBarrier, Object, Scope, Thing};
use crate::error::Error;
use ash::vk;

/// A level, layer and plane of an image, with its size in texels.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The image, with usage `TRANSFER_SRC`.
    pub image: vk::Image,
    /// Its current layout.
    pub layout: vk::ImageLayout,
    /// The plane.
    pub aspect: vk::ImageAspectFlags,
    /// Level.
    pub mip: u32,
    /// Layer.
    pub layer: u32,
    /// Width and height of the level.
    pub extent: [u32; 2],
    /// Size of a texel of the plane in bytes.
    pub texel_bytes: u32,
}

impl Kit {
    /// Creates a buffer in memory that the CPU can access, with these bytes.
    ///
    /// # Errors
    /// Fails if the device is out of memory.
    pub fn buffer(&mut self, bytes: &[u8], usage: vk::BufferUsageFlags) -> Result<BoundBuffer, Error> {
        let size = (bytes.len() as u64).max(16);
        let info = vk::BufferCreateInfo::default()
            .size(size)
            .usage(usage | vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST);
        let driver = &self.gpu.shared.driver;
        let buffer = driver.buffer(&info)?;
        self.objects.push(Object::Buffer(buffer));
        let needs = driver.requirements(Thing::Buffer(buffer));
        let host = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        let kind = driver.memory_type(needs.memory_type_bits, host, vk::MemoryPropertyFlags::PROTECTED);
        let kind = kind.ok_or_else(|| Error::MemoryType { resource: "a buffer of the CPU".into() })?;
        let memory = driver.allocate(needs.size, kind)?;
        self.objects.push(Object::Memory(memory));
        driver.bind(Thing::Buffer(buffer), memory, 0)?;
        self.mapped.push((buffer, memory));
        let bound = BoundBuffer { buffer, offset: 0, bytes: size };
        self.write(bound, bytes)?;
        Ok(bound)
    }

    /// Writes bytes at the start of a buffer made by [`Kit::buffer`].
    ///
    /// # Errors
    /// Fails if the buffer is not one of this kit's, or is too small.
    pub fn write(&self, buffer: BoundBuffer, bytes: &[u8]) -> Result<(), Error> {
        let memory = self.memory(buffer, bytes.len() as u64)?;
        let raw = &self.gpu.shared.driver.raw;
        // SAFETY: the memory is visible to the CPU and at least as long, and no other mapping exists.
        unsafe {
            let to = raw.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty());
            let to = to.map_err(Error::of("mapping memory"))?;
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), to.cast::<u8>(), bytes.len());
            raw.unmap_memory(memory);
        }
        Ok(())
    }

    /// Reads the first bytes of a buffer made by [`Kit::buffer`]. The GPU must have finished writing.
    ///
    /// # Errors
    /// Fails if the buffer is not one of this kit's, or is too small.
    pub fn read(&self, buffer: BoundBuffer, bytes: usize) -> Result<Vec<u8>, Error> {
        let memory = self.memory(buffer, bytes as u64)?;
        let raw = &self.gpu.shared.driver.raw;
        let mut read = vec![0; bytes];
        // SAFETY: the memory is visible to the CPU and at least as long, and no other mapping exists.
        unsafe {
            let from = raw.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty());
            let from = from.map_err(Error::of("mapping memory"))?;
            std::ptr::copy_nonoverlapping(from.cast::<u8>(), read.as_mut_ptr(), bytes);
            raw.unmap_memory(memory);
        }
        Ok(read)
    }

    fn memory(&self, buffer: BoundBuffer, bytes: u64) -> Result<vk::DeviceMemory, Error> {
        let found = self.mapped.iter().find(|(known, _)| *known == buffer.buffer && bytes <= buffer.bytes);
        found.map(|(_, memory)| *memory).ok_or(Error::NotPrepared)
    }

    /// Copies the first bytes of a buffer of the device, which has usage `TRANSFER_SRC`, to the CPU and waits for it.
    ///
    /// # Errors
    /// Fails if the device is out of memory.
    pub fn read_buffer(&mut self, buffer: vk::Buffer, bytes: u64) -> Result<Vec<u8>, Error> {
        let target = self.buffer(&vec![0; bytes as usize], vk::BufferUsageFlags::empty())?;
        let region = vk::BufferCopy { size: bytes, ..Default::default() };
        self.once(|driver, commands| {
            driver.barriers(commands, &Dependencies { memory: vec![Scope::ALL], ..Dependencies::default() });
            // SAFETY: the caller passes a buffer of the device with these bytes.
            unsafe { driver.raw.cmd_copy_buffer(commands, buffer, target.buffer, &[region]) };
        })?;
        self.read(target, bytes as usize)
    }

    /// Copies a part of an image to the CPU and waits for it. The layout stays the same.
    ///
    /// # Errors
    /// Fails if the device is out of memory.
    pub fn read_image(&mut self, part: &Part) -> Result<Vec<u8>, Error> {
        let [width, height] = part.extent;
        let bytes = (width * height * part.texel_bytes) as usize;
        let target = self.buffer(&vec![0; bytes], vk::BufferUsageFlags::empty())?;
        let range = vk::ImageSubresourceRange {
            aspect_mask: part.aspect,
            base_mip_level: part.mip,
            level_count: 1,
            base_array_layer: part.layer,
            layer_count: 1,
        };
        let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let moved = |layouts| Dependencies {
            images: vec![ImageBarrier { scope: Scope::ALL, image: part.image, range, layouts }],
            memory: vec![Scope::ALL],
            ..Dependencies::default()
        };
        let region = vk::BufferImageCopy {
            image_subresource: vk::ImageSubresourceLayers {
                aspect_mask: part.aspect,
                mip_level: part.mip,
                base_array_layer: part.layer,
                layer_count: 1,
            },
            image_extent: vk::Extent3D { width, height, depth: 1 },
            ..Default::default()
        };
        self.once(|driver, commands| {
            driver.barriers(commands, &moved([part.layout, source]));
            // SAFETY: the caller passes an image of the device in this layout; the buffer is long enough.
            unsafe { driver.raw.cmd_copy_image_to_buffer(commands, part.image, source, target.buffer, &[region]) };
            driver.barriers(commands, &moved([source, part.layout]));
        })?;
        self.read(target, bytes)
    }
}
