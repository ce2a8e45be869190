//! How many layers can be drawn into at once: what the device offers, where that is true.
//!
//! Mesa's software driver offers multiview rendering, but up to version 22.3 at least it clears all layers and draws into
//! the first alone. Frames would be wrong without an error, so two layers are drawn and read back before multiview is used.

use crate::device::draw_texel::draw_texel;
use crate::device::error::DeviceError;
use crate::device::gpu::Gpu;
use crate::device::readback::{Readback, ReadbackError, Subresource};
use wgpu::{Backend, Features, TextureFormat};

impl Gpu {
    /// How many layers can be attached and drawn into at once; 1 where the device has no multiview rendering, or offers
    /// it and draws into the first layer alone. The first call draws two texels and waits for them.
    ///
    /// # Errors
    /// When the device is lost, or fails the measurement.
    pub fn max_attached_layers(&self) -> Result<u32, DeviceError> {
        if let Some(&known) = self.attached_layers.get() {
            return Ok(known);
        }
        let measured = measure(self)?;
        Ok(*self.attached_layers.get_or_init(|| measured))
    }

    /// Trusts the driver on [`Gpu::max_attached_layers`], on this device from now on: for an engine that knows its
    /// drivers and does not want to wait, or a test that looks at operations alone. Has no effect once it was measured.
    pub fn trust_attached_layers(&self) {
        self.attached_layers.get_or_init(|| offered(self));
    }
}

/// The number of layers that the driver says a render pass can draw into; 1 without multiview rendering.
fn offered(gpu: &Gpu) -> u32 {
    let several = gpu.device.features().contains(Features::MULTIVIEW);
    if several { gpu.device.limits().max_multiview_view_count.clamp(1, u32::BITS) } else { 1 }
}

/// The number of layers that a render pass of the device really draws into; 1 without multiview rendering. Waits for the
/// device.
///
/// # Errors
/// When the device is lost, or fails the measurement.
fn measure(gpu: &Gpu) -> Result<u32, DeviceError> {
    let offered = offered(gpu);
    // A device without a driver draws nothing that could be read back.
    if offered < 2 || gpu.info().backend == Backend::Noop {
        return Ok(offered);
    }
    match draw_two(gpu) {
        Ok(read) => Ok(confirmed(offered, &read)),
        Err(ReadbackError::Device(error)) => Err(error),
        // What cannot be read back is not relied on.
        Err(_) => Ok(1),
    }
}

/// The first byte of each of two layers, drawn at once: 51 in the first and 102 in the second where that works.
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

/// What the driver offers, if two layers hold what was drawn into each; 1 otherwise.
fn confirmed(offered: u32, read: &[Option<u8>; 2]) -> u32 {
    if *read == [Some(51), Some(102)] { offered } else { 1 }
}

#[cfg(test)]
mod tests {
    use super::confirmed;

    #[test]
    fn an_offer_is_taken_where_both_layers_show_their_number() {
        assert_eq!(confirmed(6, &[Some(51), Some(102)]), 6);
        for wrong in [[Some(51), Some(0)], [Some(51), Some(51)], [Some(102), Some(51)], [None, None]] {
            assert_eq!(confirmed(6, &wrong), 1, "{wrong:?}");
        }
    }
}
