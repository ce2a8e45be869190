//! Rounding of shader outputs in formats with fewer bits.
//!
//! WebGPU leaves the rounding open: hardware rounds half floats to nearest, Mesa's llvmpipe truncates them. An inlined
//! epilogue must reproduce this rounding, so that it gives the same result as a separate pass that reads a stored
//! texture. The rounding is therefore measured.

use crate::device::draw_texel::draw_texel;
use crate::device::error::DeviceError;
use crate::device::format::texture_format;
use crate::device::gpu::Gpu;
use crate::device::readback::{ReadbackError, read_texture};
use framegraph::Format;
use wgpu::TextureUsages;

/// Rounding mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rounding {
    /// To the nearest value, ties to even.
    Nearest,
    /// Toward zero: excess bits are truncated.
    TowardZero,
}

/// Rounding modes of a device for colors stored in small float formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StoreRounding {
    /// Rounding of `Rgba16Float`.
    pub rgba16float: Rounding,
    /// Rounding of `Rg11b10Ufloat`; `None` if the device cannot render to it.
    pub rg11b10ufloat: Option<Rounding>,
}

/// Error: the rounding could not be measured.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum RoundingError {
    /// The device is lost, or rejected the draw.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The drawn texel could not be read back.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
    /// The device uses another rounding mode.
    #[error(
        "this device stores {written:?} in {format:?} as {kept:?}, which is rounded neither to nearest nor toward zero; compile \
         with `Options::inline` off to keep the texture"
    )]
    Unknown {
        /// Format that was rendered to.
        format: Format,
        /// Color that was drawn.
        written: [f32; 3],
        /// Color that was read back.
        kept: [f32; 3],
    },
}

impl std::fmt::Debug for RoundingError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl StoreRounding {
    /// Measures the rounding by drawing one texel in each format. Waits for the device.
    ///
    /// # Errors
    /// Fails with [`RoundingError`] if the texel cannot be drawn or read back, or the rounding is of an unknown kind.
    pub fn measure(gpu: &Gpu) -> Result<Self, RoundingError> {
        let small = Format::Rg11b10Ufloat;
        let drawable = gpu.format_features(small).allowed_usages.contains(TextureUsages::RENDER_ATTACHMENT);
        Ok(Self {
            rgba16float: measure(gpu, Format::Rgba16Float, [10, 10, 10])?,
            rg11b10ufloat: if drawable { Some(measure(gpu, small, [6, 6, 5])?) } else { None },
        })
    }

    /// Returns the rounding mode of one format; `None` for other formats.
    pub fn of(&self, format: Format) -> Option<Rounding> {
        match format {
            Format::Rgba16Float => Some(self.rgba16float),
            Format::Rg11b10Ufloat => self.rg11b10ufloat,
            _ => None,
        }
    }
}

/// Test values, in steps of the format above 1. They distinguish the modes and show how ties are rounded.
const SHARES: [f32; 3] = [0.75, 0.5, 1.5];

/// Measures one format. `bits` is the number of mantissa bits of red, green and blue.
fn measure(gpu: &Gpu, format: Format, bits: [i32; 3]) -> Result<Rounding, RoundingError> {
    let above_one = |steps: [f32; 3]| -> [f32; 3] { std::array::from_fn(|c| 1.0 + steps[c] * 2.0_f32.powi(-bits[c])) };
    let written = above_one(SHARES);
    let kept = draw_and_read(gpu, format, written)?;
    if kept == above_one([1.0, 0.0, 2.0]) {
        Ok(Rounding::Nearest)
    } else if kept == above_one([0.0, 0.0, 1.0]) {
        Ok(Rounding::TowardZero)
    } else {
        Err(RoundingError::Unknown { format, written, kept })
    }
}

/// Draws `color` into one texel of the format and reads it back.
fn draw_and_read(gpu: &Gpu, format: Format, color: [f32; 3]) -> Result<[f32; 3], RoundingError> {
    let [r, g, b] = color;
    // The factor is 1 at run time, so that the shader compiler cannot round the constants itself.
    let fragment = format!(
        "@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {{
             return vec4f(vec3f({r:?}, {g:?}, {b:?}) * (2.0 * at.x), 1.0);
         }}"
    );
    let texture =
        gpu.guard("measuring how colors are rounded", || draw_texel(gpu, &fragment, texture_format(format), 1))?;
    let [r, g, b, _] = read_texture(gpu, &texture)?.rgba().first().copied().unwrap_or_default();
    Ok([r, g, b])
}
