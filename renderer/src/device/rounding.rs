//! How a device rounds when a shader writes more bits than its target keeps.
//!
//! WebGPU leaves it open, and devices differ: hardware rounds half floats to nearest, Mesa's software rasterizer cuts them
//! off. An epilogue that is to give the same bits as a pass that reads its input from a texture has to do the same, so it
//! is measured.

use crate::device::draw_texel::draw_texel;
use crate::device::error::DeviceError;
use crate::device::format::texture_format;
use crate::device::gpu::Gpu;
use crate::device::readback::{ReadbackError, read_texture};
use framegraph::Format;
use wgpu::TextureUsages;

/// How a number is rounded to fewer bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rounding {
    /// To the nearest number, ties to the even one.
    Nearest,
    /// Toward zero: the excess bits are cut off.
    TowardZero,
}

/// How a device rounds colors that it stores in small floating-point formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StoreRounding {
    /// `Rgba16Float`.
    pub rgba16float: Rounding,
    /// `Rg11b10Ufloat`; none where the device cannot draw into it.
    pub rg11b10ufloat: Option<Rounding>,
}

/// The rounding could not be measured.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum RoundingError {
    /// The device is lost, or refused to draw.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The drawn texel could not be read back.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
    /// The device rounds, but in no known way.
    #[error(
        "this device stores {written:?} in {format:?} as {kept:?}, which is neither rounding to nearest nor toward zero; \
         compile with `Options::inline` off to keep the texture"
    )]
    Unknown {
        /// The format that was drawn into.
        format: Format,
        /// What was drawn.
        written: [f32; 3],
        /// What came back.
        kept: [f32; 3],
    },
}

impl std::fmt::Debug for RoundingError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl StoreRounding {
    /// Draws one texel in each format and looks at what came of it. Waits for the device.
    ///
    /// # Errors
    /// [`RoundingError`].
    pub fn measure(gpu: &Gpu) -> Result<Self, RoundingError> {
        let small = Format::Rg11b10Ufloat;
        let drawable = gpu.format_features(small).allowed_usages.contains(TextureUsages::RENDER_ATTACHMENT);
        Ok(Self {
            rgba16float: measure(gpu, Format::Rgba16Float, [10, 10, 10])?,
            rg11b10ufloat: if drawable { Some(measure(gpu, small, [6, 6, 5])?) } else { None },
        })
    }

    /// The rounding of one format; none for formats that are not measured.
    pub fn of(&self, format: Format) -> Option<Rounding> {
        match format {
            Format::Rgba16Float => Some(self.rgba16float),
            Format::Rg11b10Ufloat => self.rg11b10ufloat,
            _ => None,
        }
    }
}

/// Shares of a step above 1 that are drawn: they tell up from down, and what becomes of a tie.
const SHARES: [f32; 3] = [0.75, 0.5, 1.5];

/// `bits` are the explicit mantissa bits of red, green and blue.
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

/// One texel of the format with `color` drawn into it.
fn draw_and_read(gpu: &Gpu, format: Format, color: [f32; 3]) -> Result<[f32; 3], RoundingError> {
    let [r, g, b] = color;
    // Twice the position of the only pixel is one: the compiler must not do the rounding.
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
