//! Uniform buffers for small constants of passes, uploaded once per frame.
//!
//! Recorders push bytes and get a binding at once. The bytes are uploaded before the frame's commands, with one write
//! per buffer. Pushes have the same order in every frame, so bindings stay the same and their bind groups are found in
//! the cache.

use crate::pipelines::bind_groups::Binding;
use std::num::NonZeroU64;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, Device, Queue};

/// Size of a buffer in bytes: 256 blocks at the largest alignment that WebGPU allows.
const CHUNK_BYTES: u64 = 64 << 10;

/// Uniforms of one frame. See the [module documentation](self).
#[derive(Debug)]
pub struct Uniforms {
    chunks: Vec<Chunk>,
    /// Index of the chunk that is being filled.
    current: usize,
    alignment: u64,
    created: u64,
}

#[derive(Debug)]
struct Chunk {
    buffer: Buffer,
    bytes: Vec<u8>,
}

impl Uniforms {
    /// Creates an allocator with the alignment that the device requires.
    pub fn new(device: &Device) -> Self {
        let alignment = u64::from(device.limits().min_uniform_buffer_offset_alignment.max(16)).next_power_of_two();
        Self { chunks: Vec::new(), current: 0, alignment, created: 0 }
    }

    /// Returns the number of buffers created.
    pub fn created(&self) -> u64 {
        self.created
    }

    /// Begins a frame and removes all uniforms.
    pub fn begin_frame(&mut self) {
        self.current = 0;
        self.chunks.iter_mut().for_each(|c| c.bytes.clear());
    }

    /// Adds `bytes` and returns a binding of exactly that size, so that a larger shader type is rejected. An empty
    /// slice gets 16 zero bytes, since empty bindings are not allowed.
    pub fn push(&mut self, device: &Device, bytes: &[u8]) -> Binding {
        let length = (bytes.len() as u64).max(1).next_multiple_of(16);
        // Alignment limits are powers of two.
        let mask = self.alignment - 1;
        let offset = |c: &Chunk| (c.bytes.len() as u64 + mask) & !mask;
        let fits = |c: &Chunk| offset(c) + length <= c.buffer.size();
        while self.chunks.get(self.current).is_some_and(|c| !fits(c)) {
            self.current += 1;
        }
        if self.current == self.chunks.len() {
            let size = length.max(CHUNK_BYTES);
            let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
            let buffer = device.create_buffer(&BufferDescriptor {
                label: Some("uniforms"),
                size,
                usage,
                mapped_at_creation: false,
            });
            self.chunks.push(Chunk { buffer, bytes: Vec::new() });
            self.created += 1;
        }
        let chunk = &mut self.chunks[self.current];
        let offset = offset(chunk);
        chunk.bytes.resize((offset + length) as usize, 0);
        chunk.bytes[offset as usize..][..bytes.len()].copy_from_slice(bytes);
        let bound = if bytes.is_empty() { length } else { bytes.len() as u64 };
        Binding::Buffer { buffer: chunk.buffer.clone(), offset, bytes: NonZeroU64::new(bound) }
    }

    /// Uploads all uniforms, before the next submission.
    pub fn upload(&self, queue: &Queue) {
        for chunk in self.chunks.iter().filter(|c| !c.bytes.is_empty()) {
            queue.write_buffer(&chunk.buffer, 0, &chunk.bytes);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;
    use crate::device::open_error::OpenError;

    #[test]
    fn uniforms_are_aligned_and_stable_between_frames() -> Result<(), OpenError> {
        let gpu = Gpu::noop()?;
        let mut uniforms = Uniforms::new(&gpu.device);
        let mut frame = || {
            uniforms.begin_frame();
            let parts = [4usize, 0, 300, 60_000, 20_000, 100_000].map(|n| uniforms.push(&gpu.device, &vec![1; n]));
            uniforms.upload(&gpu.queue);
            parts
        };
        let first = frame();
        assert_eq!(frame(), first);
        let place = |b: &Binding| match b {
            Binding::Buffer { offset, bytes, .. } => (*offset, bytes.map_or(0, NonZeroU64::get)),
            _ => (u64::MAX, 0),
        };
        assert_eq!(first.each_ref().map(place)[..3], [(0, 4), (256, 16), (512, 300)]);
        assert_eq!(place(&first[4]).0, 0, "60 000 and 20 000 bytes do not share a buffer");
        assert_eq!(place(&first[5]), (0, 100_000));
        assert_eq!(uniforms.created(), 3);
        Ok(())
    }
}
