//! Validation of clear values.

use crate::access::{Access, ByteRange, ClearValue, Mode};
use crate::caps::{Caps, FormatCaps};
use crate::compile::error::{CompileError, CompileErrors, CompileReason};
use crate::format::{Aspect, Format};
use crate::graph::Tables;
use crate::id::PassId;

/// Reports the clear values of a pass that the view format cannot represent, and clears outside of render passes that
/// the device cannot do.
pub(super) fn clears(graph: &Tables, caps: &Caps, pass: PassId, errors: &mut CompileErrors) {
    for access in graph.accesses_of(pass).iter().filter(|a| a.mode == Mode::Clear) {
        let texture = graph.resources[access.resource.index()].desc.texture();
        let format = texture.map(|t| access.range.view.unwrap_or(t.format));
        let value = graph.clears[access.clear as usize];
        if !holds(format, value) {
            let reason = CompileReason::ClearValue { value, format };
            errors.push(|| CompileError::new(graph, reason, pass, access.resource));
        } else if !access.kind.is_attachment() && !stores(graph, caps, access, format, value) {
            let reason = CompileReason::ClearUnsupported { access: access.kind, format };
            errors.push(|| CompileError::new(graph, reason, pass, access.resource));
        }
    }
}

/// Returns `true` if the device can clear a storage or copy target to a value.
fn stores(graph: &Tables, caps: &Caps, access: &Access, format: Option<Format>, value: ClearValue) -> bool {
    let Some(format) = format else {
        let aligned = |range: ByteRange| (range.offset | range.bytes).is_multiple_of(4);
        return caps.clears_to_value || graph.bytes_of(access).is_none_or(aligned);
    };
    // One plane alone is cleared by drawing.
    let whole = format.planes() == 1 || access.range.aspect == Aspect::All;
    caps.clears_to_value
        || caps.formats.get(format).contains(FormatCaps::RENDERABLE)
        || caps.clears_to_zero && whole && is_zero(value)
}

/// Returns `true` if every component is zero, including alpha.
fn is_zero(value: ClearValue) -> bool {
    match value {
        ClearValue::Zero => true,
        ClearValue::Color(color) => color.iter().all(|c| c.to_bits() == 0),
        ClearValue::DepthStencil(depth, stencil) => depth.to_bits() == 0 && stencil == 0,
    }
}

/// Returns `true` if a format, or a buffer, can represent a value.
fn holds(format: Option<Format>, value: ClearValue) -> bool {
    match (value, format) {
        (ClearValue::Zero, _) => true,
        (ClearValue::Color(color), None) => color.iter().all(|c| c.to_bits() == 0),
        (ClearValue::DepthStencil(..), None) => false,
        (ClearValue::DepthStencil(depth, stencil), Some(format)) => {
            format.is_depth_stencil() && (0.0..=1.0).contains(&depth) && (stencil <= 255 || !format.has_stencil())
        }
        (ClearValue::Color(color), Some(format)) => {
            let Some(Channels { count, min, max, whole, infinite }) = channels(format) else {
                return false;
            };
            let fits = |c: f64| (min..=max).contains(&c) && (!whole || c.fract() == 0.0);
            let endless = |c: f64| infinite && c.is_infinite() && (c > 0.0 || min < 0.0);
            let alpha = |at: usize, c: f64| format != Format::Rgb10a2Uint || at != 3 || c <= 3.0;
            let used = color.iter().take(count).enumerate();
            !color.iter().any(|c| c.is_nan())
                && used.into_iter().all(|(at, c)| (fits(*c) && alpha(at, *c)) || endless(*c))
        }
    }
}

/// Value range of the channels of a color format.
struct Channels {
    count: usize,
    min: f64,
    max: f64,
    /// Integers only.
    whole: bool,
    /// Includes infinities.
    infinite: bool,
}

/// Returns the channels of an uncompressed color format.
fn channels(format: Format) -> Option<Channels> {
    use Format::*;
    let normalized = |count, min| Channels { count, min, max: 1.0, whole: false, infinite: false };
    let unsigned = |count, bits| Channels { count, min: 0.0, max: f64::exp2(bits) - 1.0, whole: true, infinite: false };
    let signed = |count, bits: f64| {
        let half = f64::exp2(bits - 1.0);
        Channels { count, min: -half, max: half - 1.0, whole: true, infinite: false }
    };
    let float = |count, max: f64| Channels { count, min: -max, max, whole: false, infinite: true };
    // Maxima of half and single precision, of unsigned 11- and 10-bit floats, and of shared-exponent formats.
    const HALF: f64 = 65504.0;
    const SINGLE: f64 = f32::MAX as f64;
    const SMALL: f64 = 64512.0;
    const SHARED: f64 = 65408.0;
    Some(match format {
        R8Unorm => normalized(1, 0.0),
        Rg8Unorm => normalized(2, 0.0),
        Rgba8Unorm | Rgba8UnormSrgb | Bgra8Unorm | Bgra8UnormSrgb | Rgb10a2Unorm => normalized(4, 0.0),
        R8Snorm => normalized(1, -1.0),
        Rg8Snorm => normalized(2, -1.0),
        Rgba8Snorm => normalized(4, -1.0),
        R8Uint => unsigned(1, 8.0),
        Rg8Uint => unsigned(2, 8.0),
        Rgba8Uint => unsigned(4, 8.0),
        R16Uint => unsigned(1, 16.0),
        Rg16Uint => unsigned(2, 16.0),
        Rgba16Uint => unsigned(4, 16.0),
        R32Uint => unsigned(1, 32.0),
        Rg32Uint => unsigned(2, 32.0),
        Rgba32Uint => unsigned(4, 32.0),
        Rgb10a2Uint => unsigned(4, 10.0),
        R8Sint => signed(1, 8.0),
        Rg8Sint => signed(2, 8.0),
        Rgba8Sint => signed(4, 8.0),
        R16Sint => signed(1, 16.0),
        Rg16Sint => signed(2, 16.0),
        Rgba16Sint => signed(4, 16.0),
        R32Sint => signed(1, 32.0),
        Rg32Sint => signed(2, 32.0),
        Rgba32Sint => signed(4, 32.0),
        R16Float => float(1, HALF),
        Rg16Float => float(2, HALF),
        Rgba16Float => float(4, HALF),
        R32Float => float(1, SINGLE),
        Rg32Float => float(2, SINGLE),
        Rgba32Float => float(4, SINGLE),
        Rg11b10Ufloat => Channels { min: 0.0, ..float(3, SMALL) },
        Rgb9e5Ufloat => Channels { min: 0.0, infinite: false, ..float(3, SHARED) },
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_hold_what_they_can() {
        use Format::*;
        let (inf, nan) = (f64::INFINITY, f64::NAN);
        let gray = |c: f64| ClearValue::Color([c; 4]);
        let cases = [
            (Rgba8Unorm, 0.5, true),
            (Rgba8Unorm, 1.5, false),
            (Rgba8Unorm, -0.1, false),
            (Rgba8Snorm, -1.0, true),
            (Rgba8Uint, 255.0, true),
            (Rgba8Uint, 256.0, false),
            (Rgba8Uint, 0.5, false),
            (Rgba8Sint, -128.0, true),
            (Rgba8Sint, -129.0, false),
            (R32Uint, 4294967295.0, true),
            (R32Uint, inf, false),
            (Rgb10a2Uint, 3.0, true),
            (Rgb10a2Uint, 4.0, false),
            (Rgba16Float, 65504.0, true),
            (Rgba16Float, 65505.0, false),
            (Rgba16Float, -inf, true),
            (Rg11b10Ufloat, -0.5, false),
            (Rg11b10Ufloat, -inf, false),
            (Rg11b10Ufloat, inf, true),
            (Depth32Float, 0.0, false),
        ];
        for (format, value, fits) in cases {
            assert_eq!(holds(Some(format), gray(value)), fits, "{format:?} {value}");
        }
        for format in Format::ALL {
            assert!(!holds(Some(format), gray(nan)) && holds(Some(format), ClearValue::Zero), "{format:?}");
            let color = !format.is_depth_stencil() && !format.is_compressed();
            assert_eq!(holds(Some(format), ClearValue::BLACK), color, "{format:?}");
            assert_eq!(holds(Some(format), ClearValue::FAR), format.is_depth_stencil(), "{format:?}");
            assert!(!holds(Some(format), ClearValue::DepthStencil(f32::NAN, 0)), "{format:?}");
        }
        // Channels that the format lacks accept any value except NaN.
        assert!(holds(Some(R8Unorm), ClearValue::Color([1.0, 9.0, 9.0, 9.0])));
        assert!(!holds(Some(R8Unorm), ClearValue::Color([1.0, nan, 0.0, 0.0])));
        assert!(!holds(Some(Stencil8), ClearValue::DepthStencil(0.0, 256)));
        assert!(holds(None, ClearValue::TRANSPARENT) && !holds(None, ClearValue::BLACK));
    }
}
