//! Readback of textures and buffers to the CPU, with and without waiting.

use crate::device::error::DeviceError;
use crate::device::format::{format_of, texture_aspect};
use crate::device::gpu::Gpu;
use crate::device::pixels::Pixels;
use framegraph::{Aspect, Format};
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use wgpu::{Buffer, BufferDescriptor, BufferUsages, MapMode, Texture, TextureUsages};

const WAITING: u8 = 0;
const READY: u8 = 1;
const FAILED: u8 = 2;

/// Part of a texture to read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subresource {
    /// Mip level.
    pub mip: u32,
    /// Array layer, or slice of a 3D texture.
    pub layer: u32,
    /// Plane. `All` for color; formats with depth and stencil need one of the two.
    pub aspect: Aspect,
}

impl Subresource {
    /// First mip level of the first layer.
    pub const FIRST: Self = Self { mip: 0, layer: 0, aspect: Aspect::All };
}

/// Error: a texture or buffer cannot be read back.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReadbackError {
    /// The format cannot be copied, or is not known to this crate.
    #[error(
        "a texture of format {format:?} cannot be read back{}; copy it to a color or 32-bit depth texture first",
        match .aspect { Aspect::All => "", Aspect::Depth => " (depth plane)", Aspect::Stencil => " (stencil plane)" }
    )]
    Format {
        /// Format of the texture.
        format: wgpu::TextureFormat,
        /// Requested plane.
        aspect: Aspect,
    },
    /// The texture is multisampled.
    #[error("a texture with {samples} samples cannot be read back; resolve it first")]
    Multisampled {
        /// Samples per texel.
        samples: u32,
    },
    /// The texture lacks the usage `COPY_SRC`.
    #[error("the texture lacks the usage COPY_SRC; declare it with `Graph::readback`, or create it with COPY_SRC")]
    Usage,
    /// Mip level or layer is out of range.
    #[error("level {mip}, layer {layer} is out of range; the texture has {mips} levels and {layers} layers")]
    OutOfRange {
        /// Requested mip level.
        mip: u32,
        /// Requested layer.
        layer: u32,
        /// Number of mip levels of the texture.
        mips: u32,
        /// Number of layers of the texture.
        layers: u32,
    },
    /// The device is lost, or rejected the copy.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl std::fmt::Debug for ReadbackError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// A readback in progress.
#[derive(Debug)]
pub struct Readback {
    buffer: Buffer,
    state: Arc<AtomicU8>,
    pixels: Pixels,
    row_bytes: usize,
    padded_bytes: usize,
}

impl Readback {
    /// Starts a copy of a part of `texture`, after all work submitted so far.
    ///
    /// # Errors
    /// Fails with [`ReadbackError`] if the texture cannot be copied or the device reports an error.
    pub fn start(gpu: &Gpu, texture: &Texture, part: Subresource) -> Result<Self, ReadbackError> {
        let Subresource { mip, layer, aspect } = part;
        let (format, aspect, texel_bytes) = readable(texture, aspect)?;
        let (mips, size) = (texture.mip_level_count(), texture.size());
        if mip >= mips || layer >= size.depth_or_array_layers {
            return Err(ReadbackError::OutOfRange { mip, layer, mips, layers: size.depth_or_array_layers });
        }
        let [width, height] = [size.width, size.height].map(|side| (side >> mip).max(1));
        let row_bytes = width * texel_bytes;
        let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(padded_bytes) * u64::from(height);
        let state = Arc::new(AtomicU8::new(WAITING));
        let buffer = gpu.guard("a readback", || {
            let buffer = mappable(gpu, size);
            let mut encoder =
                gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("readback") });
            let source = wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: mip,
                origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
                aspect: texture_aspect(aspect),
            };
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded_bytes),
                rows_per_image: Some(height),
            };
            let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
            encoder.copy_texture_to_buffer(source, wgpu::TexelCopyBufferInfo { buffer: &buffer, layout }, extent);
            gpu.queue.submit([encoder.finish()]);
            map(&buffer, &state);
            buffer
        })?;
        let pixels = Pixels { format, aspect, texels: [width, height], bytes: Vec::new() };
        Ok(Self { buffer, state, pixels, row_bytes: row_bytes as usize, padded_bytes: padded_bytes as usize })
    }

    /// Returns the pixels if they have arrived, otherwise the readback itself for a later call. Never waits.
    ///
    /// # Errors
    /// Fails if the device is lost or the buffer could not be mapped.
    pub fn try_take(self, gpu: &Gpu) -> Result<Result<Pixels, Self>, ReadbackError> {
        gpu.poll()?;
        match self.state.load(Ordering::Acquire) {
            WAITING => Ok(Err(self)),
            _ => self.take().map(Ok),
        }
    }

    /// Waits for the pixels. Browsers cannot wait: use [`Readback::try_take`] there.
    ///
    /// # Errors
    /// Fails if the device is lost or the buffer could not be mapped.
    pub fn wait(self, gpu: &Gpu) -> Result<Pixels, ReadbackError> {
        gpu.wait()?;
        self.take()
    }

    fn take(self) -> Result<Pixels, ReadbackError> {
        let Self { buffer, state, mut pixels, row_bytes, padded_bytes } = self;
        let mapped = mapped(&buffer, &state)?;
        pixels.bytes.reserve_exact(row_bytes * pixels.texels[1] as usize);
        mapped.chunks_exact(padded_bytes).for_each(|row| pixels.bytes.extend_from_slice(&row[..row_bytes]));
        Ok(pixels)
    }
}

/// Reads the first mip level and layer of a texture and waits for it. Intended for tools and tests.
///
/// # Errors
/// Fails like [`Readback::start`] and [`Readback::wait`].
pub fn read_texture(gpu: &Gpu, texture: &Texture) -> Result<Pixels, ReadbackError> {
    Readback::start(gpu, texture, Subresource::FIRST)?.wait(gpu)
}

/// Reads the first `bytes` bytes of a buffer, rounded up to a multiple of 4, and waits for them. Intended for tools and
/// tests.
///
/// # Errors
/// Fails if the buffer is shorter or lacks the usage `COPY_SRC`, or if the device reports an error.
pub fn read_buffer(gpu: &Gpu, buffer: &Buffer, bytes: u64) -> Result<Vec<u8>, ReadbackError> {
    let state = Arc::new(AtomicU8::new(WAITING));
    let size = bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
    let copy = gpu.guard("a readback of a buffer", || {
        let copy = mappable(gpu, size);
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("readback") });
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, size);
        gpu.queue.submit([encoder.finish()]);
        map(&copy, &state);
        copy
    })?;
    gpu.wait()?;
    Ok(mapped(&copy, &state)?.to_vec())
}

fn mappable(gpu: &Gpu, size: u64) -> Buffer {
    let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
    gpu.device.create_buffer(&BufferDescriptor { label: Some("readback"), size, usage, mapped_at_creation: false })
}

fn map(buffer: &Buffer, state: &Arc<AtomicU8>) {
    let state = state.clone();
    buffer.map_async(MapMode::Read, .., move |done| {
        state.store(if done.is_ok() { READY } else { FAILED }, Ordering::Release);
    });
}

fn mapped(buffer: &Buffer, state: &AtomicU8) -> Result<wgpu::BufferView, ReadbackError> {
    let failed = |message: String| DeviceError::Internal { doing: "mapping a readback", message };
    match state.load(Ordering::Acquire) {
        READY => Ok(buffer.get_mapped_range(..).map_err(|e| failed(e.to_string()))?),
        _ => Err(failed("the buffer was not mapped".into()).into()),
    }
}

/// Returns format, plane and bytes per texel if the texture can be copied.
fn readable(texture: &Texture, aspect: Aspect) -> Result<(Format, Aspect, u32), ReadbackError> {
    let refuse = || ReadbackError::Format { format: texture.format(), aspect };
    if texture.sample_count() != 1 {
        return Err(ReadbackError::Multisampled { samples: texture.sample_count() });
    }
    if !texture.usage().contains(TextureUsages::COPY_SRC) {
        return Err(ReadbackError::Usage);
    }
    let format = format_of(texture.format()).filter(|f| !f.is_compressed()).ok_or_else(refuse)?;
    if !aspect.exists_in(format) {
        return Err(refuse());
    }
    // wgpu copies depth and stencil one at a time.
    let texel_bytes = texture.format().block_copy_size(Some(texture_aspect(aspect))).ok_or_else(refuse)?;
    Ok((format, aspect, texel_bytes))
}
