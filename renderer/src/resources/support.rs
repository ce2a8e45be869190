//! Checks of device support before wgpu rejects a resource. Errors name the request, the limit of the adapter, and a
//! solution.
//!
//! Optional formats have fallbacks ([`supported_format`]): a pass can request a preferred format and gets the next best
//! if the device lacks it.

use crate::device::adapter::describe;
use crate::device::format::{joined, texture_format, texture_usages};
use crate::device::gpu::Gpu;
use crate::resources::physical::PhysicalTextureDesc;
use framegraph::{Dimension, Format, Usage, sanitize};
use wgpu::{AdapterInfo, Features, TextureFormatFeatures, TextureUsages};

/// Error: the device does not support a texture or buffer.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{}`: {}", sanitize::name(.name), .reason.sentence(&describe(.adapter)))]
pub struct Unsupported {
    /// Full name of the resource.
    pub name: String,
    /// Adapter of the device.
    pub adapter: Box<AdapterInfo>,
    /// Property that is not supported.
    pub reason: UnsupportedReason,
}

impl std::fmt::Debug for Unsupported {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Property of a texture or buffer that a device does not support.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", self.sentence("the device"))]
pub enum UnsupportedReason {
    /// Texture size.
    Size {
        /// Requested width, height, and layers or depth.
        requested: [u32; 3],
        /// Maximum of each.
        max: [u32; 3],
    },
    /// Usages of a texture format.
    Usage {
        /// Format of the texture.
        format: Format,
        /// Usages that the format does not support.
        missing: TextureUsages,
        /// Usages that the format supports.
        offered: TextureUsages,
        /// Features that the format needs and the device does not have.
        features: Features,
        /// First fallback format that supports all requested usages.
        fallback: Option<Format>,
    },
    /// Number of samples per texel.
    Samples {
        /// Format of the texture.
        format: Format,
        /// Requested number of samples.
        requested: u32,
        /// Supported numbers of samples.
        offered: Vec<u32>,
    },
    /// Views that change between linear and sRGB.
    Views {
        /// Format of the texture.
        format: Format,
    },
    /// Size of a buffer.
    BufferBytes {
        /// Requested size in bytes.
        requested: u64,
        /// Maximum size in bytes.
        max: u64,
    },
}

impl std::fmt::Debug for UnsupportedReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl UnsupportedReason {
    fn sentence(&self, device: &str) -> String {
        match self {
            Self::Size { requested: [width, height, layers], max: [max_width, max_height, max_layers] } => format!(
                "{width}×{height}×{layers} texels exceed the limit of {device}, {max_width}×{max_height}×{max_layers}; use a \
                 smaller frame or texture"
            ),
            Self::Usage { format, missing, offered, features, fallback } => {
                let needs = match (features.is_empty(), offered.is_empty()) {
                    (false, _) => format!("without the feature {}", joined(features.iter_names())),
                    (true, false) => format!("only for {}", joined(offered.iter_names())),
                    (true, true) => "the format has no usages".to_owned(),
                };
                let instead = fallback.map_or("another format".to_owned(), |format| format!("{format:?}"));
                format!(
                    "{device} does not support {format:?} for {} ({needs}); use {instead}, or `supported_format` to choose a \
                     fallback",
                    joined(missing.iter_names())
                )
            }
            Self::Samples { format, requested, offered } => {
                let offered: Vec<_> = offered.iter().map(u32::to_string).collect();
                format!("{device} does not support {requested} samples of {format:?}; use {}", offered.join(" or "))
            }
            Self::Views { format } => format!(
                "{device} does not support views of {format:?} in both linear and sRGB form; declare it in one format, or use a \
                 device with `VIEW_FORMATS`"
            ),
            Self::BufferBytes { requested, max } => {
                format!("{requested} bytes exceed the maximum buffer size of {device}, {max} bytes; split the buffer")
            }
        }
    }
}

/// Checks size, layers, samples and usages of a texture against the device.
pub(crate) fn check_texture(gpu: &Gpu, desc: &PhysicalTextureDesc, name: &str) -> Result<(), Unsupported> {
    let limits = gpu.device.limits();
    let [width, height, layers] = desc.size;
    let max = match desc.dimension {
        Dimension::D2 => {
            [limits.max_texture_dimension_2d, limits.max_texture_dimension_2d, limits.max_texture_array_layers]
        }
        Dimension::D3 => [limits.max_texture_dimension_3d; 3],
    };
    let refuse = |reason| Err(Unsupported { name: name.to_owned(), adapter: gpu.info().clone().into(), reason });
    if width > max[0] || height > max[1] || layers > max[2] {
        return refuse(UnsupportedReason::Size { requested: desc.size, max });
    }
    if desc.srgb_views && !gpu.has_view_formats() {
        return refuse(UnsupportedReason::Views { format: desc.format });
    }
    let TextureFormatFeatures { allowed_usages: offered, flags } = gpu.format_features(desc.format);
    let used = desc.usage - TextureUsages::TRANSIENT_ATTACHMENT;
    let (format, missing) = (desc.format, used - offered);
    if !missing.is_empty() {
        let features = texture_format(format).required_features() - gpu.device.features();
        let fallback = first_offered(gpu, format, used, false);
        return refuse(UnsupportedReason::Usage { format, missing, offered, features, fallback });
    }
    if !flags.sample_count_supported(desc.samples) {
        let offered = flags.supported_sample_counts();
        return refuse(UnsupportedReason::Samples { format, requested: desc.samples, offered });
    }
    Ok(())
}

/// Checks the size of a buffer against the device.
pub(crate) fn check_buffer(gpu: &Gpu, bytes: u64, name: &str) -> Result<(), Unsupported> {
    let max = gpu.device.limits().max_buffer_size;
    if bytes <= max {
        return Ok(());
    }
    let reason = UnsupportedReason::BufferBytes { requested: bytes, max };
    Err(Unsupported { name: name.to_owned(), adapter: gpu.info().clone().into(), reason })
}

/// Returns the next best format: one with more bits if there is one, or fewer for 32-bit formats.
const fn fallback(format: Format) -> Option<Format> {
    match format {
        Format::Rg11b10Ufloat | Format::Rgb9e5Ufloat | Format::Rgba32Float => Some(Format::Rgba16Float),
        Format::R32Float => Some(Format::R16Float),
        Format::R16Float => Some(Format::R32Float),
        Format::Rg32Float => Some(Format::Rg16Float),
        Format::Rg16Float | Format::Bgra8Unorm => Some(Format::Rgba16Float),
        Format::R8Unorm | Format::Rg8Unorm => Some(Format::Rgba8Unorm),
        Format::Depth32FloatStencil8 => Some(Format::Depth24PlusStencil8),
        _ => None,
    }
}

/// Returns `wanted`, or its first fallback that the device supports for `usage`. With `filtered`, the format must
/// support linear filtering. `None` if there is no such format.
pub fn supported_format(gpu: &Gpu, wanted: Format, usage: Usage, filtered: bool) -> Option<Format> {
    first_offered(gpu, wanted, texture_usages(usage), filtered)
}

fn first_offered(gpu: &Gpu, wanted: Format, usages: TextureUsages, filtered: bool) -> Option<Format> {
    let mut tried = Vec::new();
    let mut next = Some(wanted);
    while let Some(format) = next.filter(|f| !tried.contains(f)) {
        let allowed = gpu.format_features(format).allowed_usages;
        if allowed.contains(usages) && (!filtered || is_filterable(gpu, format)) {
            return Some(format);
        }
        tried.push(format);
        next = fallback(format);
    }
    None
}

/// Returns whether shaders can sample the format with a linear filter on this device.
fn is_filterable(gpu: &Gpu, format: Format) -> bool {
    let theirs = texture_format(format);
    let sampled = theirs.sample_type(None, Some(gpu.device.features()));
    sampled == Some(wgpu::TextureSampleType::Float { filterable: true })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::open_error::OpenError;
    use framegraph::{Extent, TextureDesc};

    fn shape(format: Format, side: u32, samples: u8, usage: Usage) -> PhysicalTextureDesc {
        PhysicalTextureDesc::new(
            &TextureDesc::new(Extent::absolute(side, side), format).samples(samples),
            [1, 1],
            usage,
            false,
        )
    }

    #[test]
    fn unsupported_resources_name_request_and_limit() -> Result<(), OpenError> {
        let gpu = Gpu::noop()?;
        assert_eq!(check_texture(&gpu, &shape(Format::Rgba8Unorm, 64, 4, Usage::ATTACHMENT), "color"), Ok(()));
        let message = |shape| check_texture(&gpu, &shape, "color").map_err(|e| e.to_string()).err().unwrap_or_default();
        let large = message(shape(Format::Rgba8Unorm, 1 << 20, 1, Usage::ATTACHMENT));
        assert!(large.contains("1048576×1048576") && large.contains("8192×8192"), "{large}");
        let attached = message(shape(Format::Rgb9e5Ufloat, 4, 1, Usage::ATTACHMENT));
        assert!(attached.contains("Rgb9e5Ufloat") && attached.contains("RENDER_ATTACHMENT"), "{attached}");
        let samples = message(shape(Format::Rgba8Unorm, 4, 3, Usage::ATTACHMENT));
        assert!(samples.contains("3 samples") && samples.contains('4'), "{samples}");
        assert!(check_buffer(&gpu, u64::MAX, "b").is_err());
        Ok(())
    }

    /// Opens a device without optional features.
    fn bare() -> Result<Gpu, Box<dyn std::error::Error>> {
        let full = Gpu::noop()?;
        let adapter = full.adapter();
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
        Ok(Gpu::wrap(adapter, &device, &queue))
    }

    #[test]
    fn optional_formats_have_fallbacks_on_a_bare_device() -> Result<(), Box<dyn std::error::Error>> {
        let (gpu, full) = (bare()?, Gpu::noop()?);
        let drawn = Usage::ATTACHMENT.union(Usage::SAMPLED);
        let cases = [
            (Format::Rg11b10Ufloat, drawn, false, Format::Rgba16Float),
            (Format::R32Float, Usage::SAMPLED, true, Format::R16Float),
            (Format::Rg32Float, Usage::SAMPLED, true, Format::Rg16Float),
            (Format::Rgba32Float, drawn, true, Format::Rgba16Float),
            (Format::Depth32FloatStencil8, Usage::ATTACHMENT, false, Format::Depth24PlusStencil8),
            (Format::Bgra8Unorm, Usage::STORAGE, false, Format::Rgba16Float),
        ];
        for (wanted, usage, filtered, expected) in cases {
            assert_eq!(supported_format(&gpu, wanted, usage, filtered), Some(expected), "{wanted:?}");
            assert_eq!(supported_format(&full, wanted, usage, filtered), Some(wanted), "{wanted:?}, with its feature");
        }
        // Checks that wgpu rejects the original format and accepts the fallback.
        for (format, usage) in [(Format::Rg11b10Ufloat, drawn), (Format::Depth32FloatStencil8, Usage::ATTACHMENT)] {
            let desc = |format| wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: 4, height: 4, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: texture_format(format),
                usage: texture_usages(usage),
                view_formats: &[],
            };
            let made = |format| gpu.guard("a texture", || gpu.device.create_texture(&desc(format))).map(drop);
            assert!(made(format).is_err(), "{format:?}");
            let instead = supported_format(&gpu, format, usage, false).ok_or("no fallback")?;
            assert_eq!(made(instead), Ok(()), "{instead:?}");
        }
        Ok(())
    }

    #[test]
    fn a_missing_feature_and_the_fallback_are_named() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = bare()?;
        let message = |format, usage| {
            let checked = check_texture(&gpu, &shape(format, 4, 1, usage), "hdr").map_err(|e| e.to_string());
            checked.err().unwrap_or_default()
        };
        let both = message(Format::Depth32FloatStencil8, Usage::ATTACHMENT);
        assert!(both.contains("does not support Depth32FloatStencil8 for RENDER_ATTACHMENT"), "{both}");
        assert!(both.contains("without the feature DEPTH32FLOAT_STENCIL8"), "{both}");
        assert!(both.contains("use Depth24PlusStencil8"), "{both}");
        let small = message(Format::Rg11b10Ufloat, Usage::ATTACHMENT);
        assert!(small.contains("use Rgba16Float"), "{small}");
        Ok(())
    }

    #[test]
    fn missing_formats_have_fallbacks() -> Result<(), OpenError> {
        let gpu = Gpu::noop()?;
        let attached = |f| supported_format(&gpu, f, Usage::ATTACHMENT.union(Usage::SAMPLED), false);
        assert_eq!(attached(Format::Rgba8Unorm), Some(Format::Rgba8Unorm));
        assert_eq!(attached(Format::Rgb9e5Ufloat), Some(Format::Rgba16Float));
        assert_eq!(attached(Format::Bc1RgbaUnorm), None);
        assert_eq!(supported_format(&gpu, Format::R16Float, Usage::STORAGE, false), Some(Format::R32Float));
        Ok(())
    }
}
