//! Number of layers that one render pass can draw into (multiview).
//!
//! Mesa's llvmpipe offers multiview. Up to version 22.3 at least, it clears all layers but draws only into the first,
//! without an error. Two layers are therefore drawn and read back before multiview is used.

use crate::device::draw_texel::draw_texel;
use crate::device::error::DeviceError;
use crate::device::gpu::Gpu;
use crate::device::readback::{Readback, ReadbackError, Subresource};
use wgpu::{Backend, Features, TextureFormat};

impl Gpu {
    /// Returns the number of layers that can be attached and drawn into at once.
    ///
    /// Returns 1 if the device has no multiview, or offers it but draws only into the first layer. The first call draws
    /// two texels and waits for them.
    ///
    /// # Errors
    /// Fails if the device is lost or the test cannot be drawn.
    pub fn max_attached_layers(&self) -> Result<u32, DeviceError> {
        if let Some(&known) = self.attached_layers.get() {
            return Ok(known);
        }
        let measured = measure(self)?;
        Ok(*self.attached_layers.get_or_init(|| measured))
    }

    /// Skips the test of [`Gpu::max_attached_layers`] and trusts the driver from now on. For applications that know
    /// their drivers, and for tests that only compare operations. Has no effect after the test ran.
    pub fn trust_attached_layers(&self) {
        self.attached_layers.get_or_init(|| offered(self));
    }
}

/// Returns the number of layers that the driver reports; 1 without multiview.
fn offered(gpu: &Gpu) -> u32 {
    let several = gpu.device.features().contains(Features::MULTIVIEW);
    if several { gpu.device.limits().max_multiview_view_count.clamp(1, u32::BITS) } else { 1 }
}

/// Returns the number of layers that a render pass really draws into; 1 without multiview. Waits for the device.
///
/// # Errors
/// Fails if the device is lost or the test cannot be drawn.
fn measure(gpu: &Gpu) -> Result<u32, DeviceError> {
    let offered = offered(gpu);
    // The noop device draws nothing that could be read back.
    if offered < 2 || gpu.info().backend == Backend::Noop {
        return Ok(offered);
    }
    match draw_two(gpu) {
        Ok(read) => Ok(confirmed(offered, &read)),
        Err(ReadbackError::Device(error)) => Err(error),
        // Without a readback the driver's claim cannot be confirmed.
        Err(_) => Ok(1),
    }
}

/// Draws into two layers at once and returns the first byte of each. Correct values are 51 and 102.
fn draw_two(gpu: &Gpu) -> Result<[Option<u8>; 2], ReadbackError> {
    let fragment = "
        @fragment fn fs_main(@builtin(view_index) view: u32) -> @location(0) vec4f {
            return vec4f(0.2 * f32(view + 1));
        }";
    let texture = gpu.guard("measuring how many layers are drawn into", || {
        draw_texel(gpu, fragment, TextureFormat::Rgba8Unorm, 2)
    })?;
    let first_byte = |layer| -> Result<_, ReadbackError> {
        let part = Subresource { layer, ..Subresource::FIRST };
        Ok(Readback::start(gpu, &texture, part)?.wait(gpu)?.bytes.first().copied())
    };
    Ok([first_byte(0)?, first_byte(1)?])
}

/// Returns `offered` if both layers have the expected values, otherwise 1.
fn confirmed(offered: u32, read: &[Option<u8>; 2]) -> u32 {
    if *read == [Some(51), Some(102)] { offered } else { 1 }
}

#[cfg(test)]
mod tests {
    use super::confirmed;

    #[test]
    fn multiview_is_used_if_both_layers_are_correct() {
        assert_eq!(confirmed(6, &[Some(51), Some(102)]), 6);
        for wrong in [[Some(51), Some(0)], [Some(51), Some(51)], [Some(102), Some(51)], [None, None]] {
            assert_eq!(confirmed(6, &wrong), 1, "{wrong:?}");
        }
    }
}
