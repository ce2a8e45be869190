//! How many layers can be drawn into at once: what the device offers, where that is true.
//!
//! Mesa's software driver offers multiview rendering, but up to version 22.3 at least it clears all layers and draws into
//! the first alone. A frame would be wrong without a word, so two layers are drawn and looked at before the offer is taken.

use super::device::Gpu;
use super::probe::draw_texel;
use super::readback::{Readback, ReadbackError, Subresource};
use super::trouble::DeviceError;
use wgpu::{Backend, Features, TextureFormat};

/// The number of layers that the driver says a render pass can draw into; 1 without multiview rendering.
pub(crate) fn offered(gpu: &Gpu) -> u32 {
    let several = gpu.device.features().contains(Features::MULTIVIEW);
    if several { gpu.device.limits().max_multiview_view_count.clamp(1, u32::BITS) } else { 1 }
}

/// The number of layers that a render pass of the device really draws into; 1 without multiview rendering. Waits for the
/// device.
///
/// # Errors
/// When the device is in trouble.
pub(crate) fn measure(gpu: &Gpu) -> Result<u32, DeviceError> {
    let offered = offered(gpu);
    // Nothing is drawn on a device without a driver, so nothing can be seen there.
    if offered < 2 || gpu.info().backend == Backend::Noop {
        return Ok(offered);
    }
    match draw_two(gpu) {
        Ok(seen) => Ok(believed(offered, &seen)),
        Err(ReadbackError::Device(error)) => Err(error),
        // What cannot be looked at is not relied on.
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

/// What is made of the offer after a look at two layers.
fn believed(offered: u32, seen: &[Option<u8>; 2]) -> u32 {
    if *seen == [Some(51), Some(102)] { offered } else { 1 }
}

#[cfg(test)]
mod tests {
    use super::believed;

    #[test]
    fn an_offer_is_taken_where_both_layers_show_their_number() {
        assert_eq!(believed(6, &[Some(51), Some(102)]), 6);
        for wrong in [[Some(51), Some(0)], [Some(51), Some(51)], [Some(102), Some(51)], [None, None]] {
            assert_eq!(believed(6, &wrong), 1, "{wrong:?}");
        }
    }
}
