//! Recording of barriers, render passes, timestamps and labels.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use super::Driver;
use crate::features::Synchronization;
use ash::vk;
use std::ffi::CString;

/// Source and destination of a barrier: stages, accesses and queue families.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Scope {
    pub(crate) from: vk::PipelineStageFlags2,
    pub(crate) to: vk::PipelineStageFlags2,
    pub(crate) from_access: vk::AccessFlags2,
    pub(crate) to_access: vk::AccessFlags2,
    /// Families of an ownership transfer.
    pub(crate) families: Option<[u32; 2]>,
}

/// Barrier of a range of an image.
#[derive(Clone, Copy)]
pub(crate) struct ImageBarrier {
    pub(crate) scope: Scope,
    pub(crate) image: vk::Image,
    pub(crate) range: vk::ImageSubresourceRange,
    pub(crate) layouts: [vk::ImageLayout; 2],
}

/// Barrier of a whole buffer.
#[derive(Clone, Copy)]
pub(crate) struct BufferBarrier {
    pub(crate) scope: Scope,
    pub(crate) buffer: vk::Buffer,
}

/// Barriers recorded by one command.
#[derive(Clone, Default)]
pub(crate) struct Dependencies {
    pub(crate) memory: Vec<Scope>,
    pub(crate) images: Vec<ImageBarrier>,
    pub(crate) buffers: Vec<BufferBarrier>,
}

impl Scope {
    /// All earlier work before all later work.
    pub(crate) const ALL: Self = Self {
        from: vk::PipelineStageFlags2::ALL_COMMANDS,
        to: vk::PipelineStageFlags2::ALL_COMMANDS,
        from_access: vk::AccessFlags2::MEMORY_WRITE,
        to_access: vk::AccessFlags2::from_raw(
            vk::AccessFlags2::MEMORY_READ.as_raw() | vk::AccessFlags2::MEMORY_WRITE.as_raw(),
        ),
        families: None,
    };

    /// All earlier work before reads of mapped memory by the CPU, once it has waited for the GPU.
    pub(crate) const TO_HOST: Self =
        Self { to: vk::PipelineStageFlags2::HOST, to_access: vk::AccessFlags2::HOST_READ, ..Self::ALL };

    fn families(&self) -> [u32; 2] {
        self.families.unwrap_or([vk::QUEUE_FAMILY_IGNORED; 2])
    }
}

/// Returns flags of Vulkan 1.0. The crate uses only flags that both versions have, with equal values.
const fn stages1(stages: vk::PipelineStageFlags2) -> vk::PipelineStageFlags {
    vk::PipelineStageFlags::from_raw(stages.as_raw() as u32)
}

/// Returns flags of Vulkan 1.0, as [`stages1`] does.
const fn accesses1(accesses: vk::AccessFlags2) -> vk::AccessFlags {
    vk::AccessFlags::from_raw(accesses.as_raw() as u32)
}

impl Driver {
    /// Records barriers.
    pub(crate) fn barriers(&self, commands: vk::CommandBuffer, barriers: &Dependencies) {
        if self.synchronization == Synchronization::Legacy {
            return self.legacy_barriers(commands, barriers);
        }
        let memory = barriers.memory.iter().map(|scope| {
            vk::MemoryBarrier2::default()
                .src_stage_mask(scope.from)
                .dst_stage_mask(scope.to)
                .src_access_mask(scope.from_access)
                .dst_access_mask(scope.to_access)
        });
        let memory = memory.collect::<Vec<_>>();
        let images = barriers.images.iter().map(|row| {
            let [from, to] = row.scope.families();
            vk::ImageMemoryBarrier2::default()
                .src_stage_mask(row.scope.from)
                .dst_stage_mask(row.scope.to)
                .src_access_mask(row.scope.from_access)
                .dst_access_mask(row.scope.to_access)
                .old_layout(row.layouts[0])
                .new_layout(row.layouts[1])
                .src_queue_family_index(from)
                .dst_queue_family_index(to)
                .image(row.image)
                .subresource_range(row.range)
        });
        let images = images.collect::<Vec<_>>();
        let buffers = barriers.buffers.iter().map(|row| {
            let [from, to] = row.scope.families();
            vk::BufferMemoryBarrier2::default()
                .src_stage_mask(row.scope.from)
                .dst_stage_mask(row.scope.to)
                .src_access_mask(row.scope.from_access)
                .dst_access_mask(row.scope.to_access)
                .src_queue_family_index(from)
                .dst_queue_family_index(to)
                .buffer(row.buffer)
                .size(vk::WHOLE_SIZE)
        });
        let buffers = buffers.collect::<Vec<_>>();
        let info = vk::DependencyInfo::default()
            .memory_barriers(&memory)
            .image_memory_barriers(&images)
            .buffer_memory_barriers(&buffers);
        // SAFETY: D1, D2, D4. The commands are being recorded, outside of a render pass: `Executor` records barriers
        // between steps only.
        unsafe {
            match &self.synchronization2 {
                Some(extension) => extension.cmd_pipeline_barrier2(commands, &info),
                None => self.raw.cmd_pipeline_barrier2(commands, &info),
            }
        }
    }

    /// Records barriers with the command of Vulkan 1.0, one for each pair of stages.
    fn legacy_barriers(&self, commands: vk::CommandBuffer, barriers: &Dependencies) {
        let record = |scope: &Scope, memory: &[vk::MemoryBarrier<'_>], buffers: &[_], images: &[_]| {
            // Vulkan 1.0 has no empty stages.
            let or = |stages: vk::PipelineStageFlags, none| if stages.is_empty() { none } else { stages };
            let from = or(stages1(scope.from), vk::PipelineStageFlags::TOP_OF_PIPE);
            let to = or(stages1(scope.to), vk::PipelineStageFlags::BOTTOM_OF_PIPE);
            let none = vk::DependencyFlags::empty();
            // SAFETY: D1, D2, D4. The commands are being recorded, outside of a render pass.
            unsafe { self.raw.cmd_pipeline_barrier(commands, from, to, none, memory, buffers, images) };
        };
        for scope in &barriers.memory {
            let row = vk::MemoryBarrier::default()
                .src_access_mask(accesses1(scope.from_access))
                .dst_access_mask(accesses1(scope.to_access));
            record(scope, &[row], &[], &[]);
        }
        for row in &barriers.buffers {
            let [from, to] = row.scope.families();
            let barrier = vk::BufferMemoryBarrier::default()
                .src_access_mask(accesses1(row.scope.from_access))
                .dst_access_mask(accesses1(row.scope.to_access))
                .src_queue_family_index(from)
                .dst_queue_family_index(to)
                .buffer(row.buffer)
                .size(vk::WHOLE_SIZE);
            record(&row.scope, &[], &[barrier], &[]);
        }
        for row in &barriers.images {
            let [from, to] = row.scope.families();
            let barrier = vk::ImageMemoryBarrier::default()
                .src_access_mask(accesses1(row.scope.from_access))
                .dst_access_mask(accesses1(row.scope.to_access))
                .old_layout(row.layouts[0])
                .new_layout(row.layouts[1])
                .src_queue_family_index(from)
                .dst_queue_family_index(to)
                .image(row.image)
                .subresource_range(row.range);
            record(&row.scope, &[], &[], &[barrier]);
        }
    }

    /// Begins a render pass with its first subpass.
    pub(crate) fn begin_render_pass(&self, commands: vk::CommandBuffer, info: &vk::RenderPassBeginInfo<'_>) {
        // SAFETY: D1, D2, D4. No render pass is open: `Executor` ends each step before the next.
        unsafe { self.raw.cmd_begin_render_pass(commands, info, vk::SubpassContents::INLINE) };
    }

    /// Begins the next subpass.
    pub(crate) fn next_subpass(&self, commands: vk::CommandBuffer) {
        // SAFETY: D4. A render pass with another subpass is open.
        unsafe { self.raw.cmd_next_subpass(commands, vk::SubpassContents::INLINE) };
    }

    /// Ends a render pass.
    pub(crate) fn end_render_pass(&self, commands: vk::CommandBuffer) {
        // SAFETY: D4. A render pass is open, in its last subpass.
        unsafe { self.raw.cmd_end_render_pass(commands) };
    }

    /// Sets viewport and scissor to the whole render area, since most pipelines have them as dynamic state.
    pub(crate) fn viewport(&self, commands: vk::CommandBuffer, [width, height]: [u32; 2]) {
        let viewport =
            vk::Viewport { width: width as f32, height: height as f32, max_depth: 1.0, ..Default::default() };
        let scissor = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
        // SAFETY: D2, D4. The size is that of attachments, so the limits of viewports hold.
        unsafe {
            self.raw.cmd_set_viewport(commands, 0, &[viewport]);
            self.raw.cmd_set_scissor(commands, 0, &[scissor]);
        }
    }

    /// Resets timestamps.
    pub(crate) fn reset_timestamps(&self, commands: vk::CommandBuffer, pool: vk::QueryPool, first: u32, count: u32) {
        // SAFETY: D1, D4. Outside of a render pass; the pool has two timestamps for each step.
        unsafe { self.raw.cmd_reset_query_pool(commands, pool, first, count) };
    }

    /// Writes a timestamp after all earlier commands.
    pub(crate) fn timestamp(&self, commands: vk::CommandBuffer, pool: vk::QueryPool, index: u32) {
        // SAFETY: D1, D4. The timestamp was reset in the same commands.
        unsafe { self.raw.cmd_write_timestamp(commands, vk::PipelineStageFlags::BOTTOM_OF_PIPE, pool, index) };
    }

    /// Begins a labeled region of commands, if the extension is enabled.
    pub(crate) fn begin_label(&self, commands: vk::CommandBuffer, text: &str) {
        let (Some(debug), Ok(text)) = (&self.debug, CString::new(text)) else { return };
        let label = vk::DebugUtilsLabelEXT::default().label_name(&text);
        // SAFETY: D2, D4.
        unsafe { debug.cmd_begin_debug_utils_label(commands, &label) };
    }

    /// Ends a labeled region.
    pub(crate) fn end_label(&self, commands: vk::CommandBuffer) {
        let Some(debug) = &self.debug else { return };
        // SAFETY: D4. `begin_label` began a region in the same commands, and `Executor` pairs the calls.
        unsafe { debug.cmd_end_debug_utils_label(commands) };
    }
}

impl Dependencies {
    /// Returns `true` if there are no barriers.
    pub(crate) fn is_empty(&self) -> bool {
        self.memory.is_empty() && self.images.is_empty() && self.buffers.is_empty()
    }
}

impl Driver {
    /// Clears a range of an image, which is in the layout of copy targets or the general one.
    pub(crate) fn clear_image(
        &self,
        commands: vk::CommandBuffer,
        image: vk::Image,
        layout: vk::ImageLayout,
        range: vk::ImageSubresourceRange,
        value: vk::ClearValue,
    ) {
        // SAFETY: D1, D2, D4. The image has the usage of copy targets (`Shape::cleared`); no render pass is open. Every
        // field of the union is plain data.
        unsafe {
            if range.aspect_mask == vk::ImageAspectFlags::COLOR {
                self.raw.cmd_clear_color_image(commands, image, layout, &value.color, &[range]);
            } else {
                self.raw.cmd_clear_depth_stencil_image(commands, image, layout, &value.depth_stencil, &[range]);
            }
        }
    }

    /// Fills a part of a buffer, given by offset and size in bytes, with zeros.
    pub(crate) fn fill_buffer(&self, commands: vk::CommandBuffer, buffer: vk::Buffer, (offset, bytes): (u64, u64)) {
        // SAFETY: D1, D4. The buffer has the usage of copy targets (`Shape::cleared`) and these bytes.
        unsafe { self.raw.cmd_fill_buffer(commands, buffer, offset, bytes & !3, 0) };
    }
}
