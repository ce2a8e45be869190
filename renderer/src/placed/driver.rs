//! Vulkan calls that wgpu does not make: images and buffers in shared memory blocks, and aliasing barriers.

#![allow(unsafe_code, reason = "wgpu has no safe call to bind external memory or record a barrier")]

use crate::device::format::{both_forms, texture_format};
use crate::device::gpu::Gpu;
use crate::placed::not_placed::NotPlaced;
use crate::placed::resting_usage::{buffer_uses, resting_usage, texture_uses};
use crate::placed::shape::{MemoryRequirements, Shape};
use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};
use ash::vk;
use framegraph::Dimension;
use std::sync::Arc;
use wgpu::hal::api::Vulkan;
use wgpu::hal::vulkan::{Buffer as HalBuffer, TextureMemory, conv};
use wgpu::{Buffer, CommandBuffer, Extent3d, Texture, TextureDimension, TextureUses};

/// A placed texture or buffer.
#[derive(Debug)]
pub(crate) enum Object {
    Texture(PlacedTexture),
    Buffer(Buffer),
}

/// A placed texture.
#[derive(Debug)]
pub(crate) struct PlacedTexture {
    texture: Texture,
    resting_usage: TextureUses,
    /// Handle of the image, valid as long as `texture`.
    raw: vk::Image,
    /// Layout and planes in the resting usage.
    layout: vk::ImageLayout,
    planes: vk::ImageAspectFlags,
}

impl PlacedTexture {
    /// Returns the wgpu texture.
    pub(crate) fn texture(&self) -> &Texture {
        &self.texture
    }

    /// Returns the usage between the last step of a frame and the first step of the next.
    pub(crate) fn resting_usage(&self) -> TextureUses {
        self.resting_usage
    }
}

/// Vulkan functions of the device that wgpu opened.
pub(crate) struct Driver {
    /// Keeps the device open.
    gpu: Gpu,
    device: ash::Device,
    memory: vk::PhysicalDeviceMemoryProperties,
}

impl std::fmt::Debug for Driver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Driver").field("memory_types", &self.memory.memory_type_count).finish_non_exhaustive()
    }
}

/// A memory allocation, freed when the last resource in it is destroyed.
struct Block {
    device: ash::Device,
    raw: vk::DeviceMemory,
}

impl Drop for Block {
    fn drop(&mut self) {
        // SAFETY: only images and buffers bound to the memory hold it (`Image`, `Bytes`). Each is destroyed before it
        // releases the memory, and wgpu drops one only when the GPU has finished with it. The device is still open,
        // since wgpu drops textures and buffers first.
        unsafe { self.device.free_memory(self.raw, None) };
    }
}

/// An image that is destroyed on drop.
struct Image {
    device: ash::Device,
    raw: vk::Image,
    /// Memory that the image is bound to.
    _block: Option<Arc<Block>>,
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: the image was created by `Driver::image` and is destroyed nowhere else. The wgpu callback that drops
        // this value runs when no command uses the image anymore.
        unsafe { self.device.destroy_image(self.raw, None) };
    }
}

/// A buffer that is destroyed on drop.
struct Bytes {
    device: ash::Device,
    raw: vk::Buffer,
    /// Memory that the buffer is bound to.
    _block: Option<Arc<Block>>,
}

impl Drop for Bytes {
    fn drop(&mut self) {
        // SAFETY: see `Image`.
        unsafe { self.device.destroy_buffer(self.raw, None) };
    }
}

fn refused(call: &'static str) -> impl Fn(vk::Result) -> NotPlaced {
    move |result| NotPlaced::Driver { call, why: result.to_string() }
}

impl Driver {
    /// Returns the driver of a Vulkan device.
    ///
    /// # Errors
    /// Fails if the device uses another graphics API.
    pub(crate) fn of(gpu: &Gpu) -> Result<Self, NotPlaced> {
        let other = || NotPlaced::Backend(gpu.info().backend);
        // SAFETY: wgpu's device is read and not destroyed; `gpu` keeps it open.
        let hal = unsafe { gpu.device.as_hal::<Vulkan>() }.ok_or_else(other)?;
        let (device, physical) = (hal.raw_device().clone(), hal.raw_physical_device());
        // SAFETY: the handle belongs to the open device.
        let memory = unsafe { hal.shared_instance().raw_instance().get_physical_device_memory_properties(physical) };
        drop(hal);
        Ok(Self { gpu: gpu.clone(), device, memory })
    }

    /// Queries the memory requirements of a resource, by creating and destroying it.
    ///
    /// # Errors
    /// Fails if the driver cannot create the resource.
    pub(crate) fn memory_requirements(&self, shape: &Shape) -> Result<MemoryRequirements, NotPlaced> {
        let required = match shape {
            Shape::Texture(shape) => {
                let image = self.image(shape, None)?;
                // SAFETY: the image was created above by this device.
                unsafe { self.device.get_image_memory_requirements(image.raw) }
            }
            Shape::Buffer(shape) => {
                let buffer = self.bytes(shape, None)?;
                // SAFETY: the buffer was created above by this device.
                unsafe { self.device.get_buffer_memory_requirements(buffer.raw) }
            }
        };
        Ok(MemoryRequirements {
            bytes: required.size,
            alignment: required.alignment.max(1),
            memory_types: required.memory_type_bits,
        })
    }

    /// Creates all objects at their offsets, textures in one block and buffers in another. Returns the objects and the
    /// number of allocated bytes.
    ///
    /// An item is a description, an offset and a label. `needs` are the memory requirements of the items, which the
    /// offsets must satisfy.
    ///
    /// # Errors
    /// Fails if no memory type fits, or the device is out of memory.
    pub(crate) fn place(
        &self,
        items: &[(Shape, u64, &str)],
        needs: &[MemoryRequirements],
    ) -> Result<(Vec<Object>, u64), NotPlaced> {
        let (mut blocks, mut allocated) = ([None, None], 0);
        for (heap, block) in blocks.iter_mut().enumerate() {
            let own = || items.iter().zip(needs).filter(|((shape, ..), _)| heap_of(shape) == heap);
            let bytes = own().map(|((_, offset, _), needs)| offset + needs.bytes).max().unwrap_or(0);
            if bytes > 0 {
                *block = Some(self.block(bytes, own().fold(u32::MAX, |types, (_, n)| types & n.memory_types))?);
                allocated += bytes;
            }
        }
        let made = items.iter().map(|(shape, offset, name)| {
            let block = blocks[heap_of(shape)].as_ref().ok_or(NotPlaced::UnstableSizes)?;
            match shape {
                Shape::Texture(shape) => self.texture(shape, block, *offset, name).map(Object::Texture),
                Shape::Buffer(shape) => self.buffer(shape, block, *offset, name).map(Object::Buffer),
            }
        });
        Ok((made.collect::<Result<_, _>>()?, allocated))
    }

    /// Records a barrier that waits for all earlier submissions and makes the memory available to these textures (and
    /// all buffers). Moves the images to their resting layouts.
    pub(crate) fn alias_barrier(&self, textures: &[&PlacedTexture]) -> CommandBuffer {
        let images: Vec<_> = textures
            .iter()
            .map(|placed| {
                let range = vk::ImageSubresourceRange::default()
                    .aspect_mask(placed.planes)
                    .level_count(vk::REMAINING_MIP_LEVELS)
                    .layer_count(vk::REMAINING_ARRAY_LAYERS);
                vk::ImageMemoryBarrier::default()
                    .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
                    .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)
                    .old_layout(vk::ImageLayout::UNDEFINED)
                    .new_layout(placed.layout)
                    .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .image(placed.raw)
                    .subresource_range(range)
            })
            .collect();
        let memory = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
            .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)];
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("hand over") };
        let mut encoder = self.gpu.device.create_command_encoder(&descriptor);
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        // SAFETY: only this barrier is recorded into the encoder, which wgpu begins and ends. The images belong to this
        // device and live as long as `textures`. Their contents may be discarded, since the plan reuses their memory
        // here.
        unsafe {
            encoder.as_hal_mut::<Vulkan, _, _>(|hal| {
                if let Some(hal) = hal {
                    let none = vk::DependencyFlags::empty();
                    self.device.cmd_pipeline_barrier(hal.raw_handle(), all, all, none, &memory, &[], &images);
                }
            });
        }
        encoder.finish()
    }

    fn image(&self, shape: &PhysicalTextureDesc, block: Option<Arc<Block>>) -> Result<Image, NotPlaced> {
        let format = texture_format(shape.format);
        // SAFETY: wgpu's adapter is read and not destroyed.
        let adapter = unsafe { self.gpu.adapter().as_hal::<Vulkan>() };
        let adapter = adapter.ok_or(NotPlaced::Backend(self.gpu.info().backend))?;
        let raw_format = |format| adapter.texture_format_as_raw(format);
        let described = described(shape, None);
        let views: Vec<_> = described.view_formats.iter().chain([&format]).map(|f| raw_format(*f)).collect();
        let mut list = vk::ImageFormatListCreateInfo::default().view_formats(&views);
        let mut flags = vk::ImageCreateFlags::empty();
        if shape.dimension == Dimension::D3 && described.usage.contains(TextureUses::COLOR_TARGET) {
            flags |= vk::ImageCreateFlags::TYPE_2D_ARRAY_COMPATIBLE;
        }
        if described.is_cube_compatible() {
            flags |= vk::ImageCreateFlags::CUBE_COMPATIBLE;
        }
        if shape.srgb_views {
            flags |= vk::ImageCreateFlags::MUTABLE_FORMAT;
        }
        let mut info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(conv::map_texture_dimension(described.dimension))
            .format(raw_format(format))
            .extent(conv::map_copy_extent(&described.copy_extent()))
            .mip_levels(shape.mips)
            .array_layers(described.array_layer_count())
            .samples(vk::SampleCountFlags::from_raw(shape.samples))
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(conv::map_texture_usage(described.usage))
            .sharing_mode(vk::SharingMode::EXCLUSIVE)
            .initial_layout(vk::ImageLayout::UNDEFINED);
        let listed = c"VK_KHR_image_format_list";
        // SAFETY: wgpu's device is read and not destroyed.
        let device = unsafe { self.gpu.device.as_hal::<Vulkan>() };
        if shape.srgb_views && device.is_some_and(|d| d.enabled_device_extensions().contains(&listed)) {
            info = info.push_next(&mut list);
        }
        // SAFETY: the description is one that wgpu could use itself: `check_texture` has compared it with the limits
        // and formats of the device.
        let raw = unsafe { self.device.create_image(&info, None) }.map_err(refused("vkCreateImage"))?;
        Ok(Image { device: self.device.clone(), raw, _block: block })
    }

    fn bytes(&self, shape: &PhysicalBufferDesc, block: Option<Arc<Block>>) -> Result<Bytes, NotPlaced> {
        let info = vk::BufferCreateInfo::default()
            .size(shape.bytes)
            .usage(conv::map_buffer_usage(buffer_uses(shape.usage)))
            .sharing_mode(vk::SharingMode::EXCLUSIVE);
        // SAFETY: the size is not 0, and `check_buffer` has compared it with the limit of the device.
        let raw = unsafe { self.device.create_buffer(&info, None) }.map_err(refused("vkCreateBuffer"))?;
        Ok(Bytes { device: self.device.clone(), raw, _block: block })
    }

    /// Allocates device-local memory of one of these types.
    fn block(&self, bytes: u64, types: u32) -> Result<Arc<Block>, NotPlaced> {
        let unfit = vk::MemoryPropertyFlags::LAZILY_ALLOCATED | vk::MemoryPropertyFlags::PROTECTED;
        let known = self.memory.memory_types_as_slice().iter().enumerate();
        let fits = |flags: vk::MemoryPropertyFlags| {
            flags.contains(vk::MemoryPropertyFlags::DEVICE_LOCAL) && !flags.intersects(unfit)
        };
        let mut fitting = known.filter(|(at, kind)| types & (1 << at) != 0 && fits(kind.property_flags));
        let (at, _) = fitting.next().ok_or(NotPlaced::MemoryType { types })?;
        let info = vk::MemoryAllocateInfo::default().allocation_size(bytes).memory_type_index(at as u32);
        // SAFETY: the memory type belongs to the device, and the size is not 0.
        let raw = unsafe { self.device.allocate_memory(&info, None) }.map_err(refused("vkAllocateMemory"))?;
        Ok(Arc::new(Block { device: self.device.clone(), raw }))
    }

    fn texture(
        &self,
        shape: &PhysicalTextureDesc,
        block: &Arc<Block>,
        offset: u64,
        name: &str,
    ) -> Result<PlacedTexture, NotPlaced> {
        let image = self.image(shape, Some(block.clone()))?;
        let raw = image.raw;
        // SAFETY: the image is new, the offset satisfies the driver's requirements, and the image ends inside of the
        // block (`place`).
        unsafe { self.device.bind_image_memory(raw, block.raw, offset) }.map_err(refused("vkBindImageMemory"))?;
        let format = texture_format(shape.format);
        let resting_usage = resting_usage(shape.usage, format);
        let described = described(shape, Some(name));
        // SAFETY: wgpu's device is read and not destroyed.
        let hal = unsafe { self.gpu.device.as_hal::<Vulkan>() };
        let hal = hal.ok_or(NotPlaced::Backend(self.gpu.info().backend))?;
        // SAFETY: the image was created as in `described`. The image and its memory live until wgpu runs the callback,
        // which drops `image`.
        let texture = unsafe {
            hal.texture_from_raw(raw, &described, Some(Box::new(move || drop(image))), TextureMemory::External)
        };
        drop(hal);
        let descriptor = wgpu::TextureDescriptor {
            label: Some(name),
            size: described.size,
            mip_level_count: shape.mips,
            sample_count: shape.samples,
            dimension: described.dimension,
            format,
            usage: shape.usage,
            view_formats: &described.view_formats,
        };
        // SAFETY: the texture belongs to this device and was created as described. It has its resting usage whenever
        // wgpu uses it: `alias_barrier` moves it there before its first step of each frame. Its old contents are memory
        // of this device and are never read. The plan writes every part before it is read, as the compiler checks.
        let texture = unsafe { self.gpu.device.create_texture_from_hal::<Vulkan>(texture, &descriptor, resting_usage) };
        let layout = conv::derive_image_layout(resting_usage, format);
        let planes = conv::map_aspects(wgpu::hal::FormatAspects::from(format));
        Ok(PlacedTexture { texture, resting_usage, raw, layout, planes })
    }

    fn buffer(
        &self,
        shape: &PhysicalBufferDesc,
        block: &Arc<Block>,
        offset: u64,
        name: &str,
    ) -> Result<Buffer, NotPlaced> {
        let bytes = self.bytes(shape, Some(block.clone()))?;
        let raw = bytes.raw;
        // SAFETY: as for `bind_image_memory`.
        unsafe { self.device.bind_buffer_memory(raw, block.raw, offset) }.map_err(refused("vkBindBufferMemory"))?;
        // SAFETY: the buffer and its memory live until wgpu runs the callback, which drops `bytes`.
        let buffer = unsafe { HalBuffer::from_raw_externally_owned(raw, Box::new(move || drop(bytes))) };
        let descriptor = wgpu::BufferDescriptor {
            label: Some(name),
            size: shape.bytes,
            usage: shape.usage,
            mapped_at_creation: false,
        };
        // SAFETY: the buffer belongs to this device and has this size, which is not 0. Its old contents are never read,
        // as for textures.
        Ok(unsafe { self.gpu.device.create_buffer_from_hal::<Vulkan>(buffer, &descriptor) })
    }
}

fn heap_of(shape: &Shape) -> usize {
    usize::from(matches!(shape, Shape::Buffer(_)))
}

/// Returns the description for wgpu-hal.
fn described<'n>(shape: &PhysicalTextureDesc, label: Option<&'n str>) -> wgpu::hal::TextureDescriptor<'n> {
    let ([width, height, depth_or_array_layers], format) = (shape.size, texture_format(shape.format));
    wgpu::hal::TextureDescriptor {
        label,
        size: Extent3d { width, height, depth_or_array_layers },
        mip_level_count: shape.mips,
        sample_count: shape.samples,
        dimension: match shape.dimension {
            Dimension::D2 => TextureDimension::D2,
            Dimension::D3 => TextureDimension::D3,
        },
        format,
        usage: texture_uses(shape.usage, format),
        memory_flags: wgpu::hal::MemoryFlags::empty(),
        view_formats: if shape.srgb_views { both_forms(format).to_vec() } else { Vec::new() },
    }
}
