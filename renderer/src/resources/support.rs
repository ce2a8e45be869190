//! What the device can and cannot make, said before wgpu refuses it: what was asked, what the adapter offers, what to do.
//!
//! Optional formats have stated fallbacks ([`supported_format`]): a pass asks for the format that it prefers and gets the
//! next best where the device has it not.

use crate::device::adapter::describe;
use crate::device::format::{texture_format, texture_usages};
use crate::device::gpu::Gpu;
use crate::resources::physical::PhysicalTextureDesc;
use framegraph::{Dimension, Format, Usage, sanitize};
use wgpu::{AdapterInfo, Features, TextureFormatFeatures, TextureUsages};

/// The device offers no such texture or buffer.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{}` {}", sanitize::name(.name), .reason.sentence(&describe(.adapter)))]
pub struct Unsupported {
    /// Full name of the resource.
    pub name: String,
    /// The adapter of the device.
    pub adapter: Box<AdapterInfo>,
    /// What it asks for, and what there is instead.
    pub reason: UnsupportedReason,
}

impl std::fmt::Debug for Unsupported {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// What a device does not offer.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", self.sentence("the device"))]
pub enum UnsupportedReason {
    /// A texture of that many texels.
    Size {
        /// Width, height, layers or depth.
        asked: [u32; 3],
        /// The most that there may be of each.
        most: [u32; 3],
    },
    /// A format for some use.
    Usage {
        /// Format of the texture.
        format: Format,
        /// The uses that it cannot have.
        missing: TextureUsages,
        /// The uses that it can have.
        offered: TextureUsages,
        /// Features of wgpu that the format takes and the device was opened without.
        features: Features,
        /// The first of its fallbacks that can have all uses asked for.
        fallback: Option<Format>,
    },
    /// That many samples per texel.
    Samples {
        /// Format of the texture.
        format: Format,
        /// Samples per texel.
        asked: u32,
        /// The counts that there are.
        offered: Vec<u32>,
    },
    /// Views in another format than the texture's own.
    Views {
        /// Format of the texture.
        format: Format,
    },
    /// A buffer of that size.
    BufferBytes {
        /// Size in bytes.
        asked: u64,
        /// The most that there may be.
        most: u64,
    },
}

impl std::fmt::Debug for UnsupportedReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl UnsupportedReason {
    fn sentence(&self, device: &str) -> String {
        format!("asks for {}; {device} offers {}; {}", self.asked(), self.offered(), self.hint())
    }

    fn asked(&self) -> String {
        match self {
            Self::Size { asked: [width, height, layers], .. } => format!("{width}×{height}×{layers} texels"),
            Self::Usage { format, missing, .. } => format!("{format:?} as {missing:?}"),
            Self::Samples { format, asked, .. } => format!("{asked} samples of {format:?}"),
            Self::Views { format } => format!("views of {format:?} through its sRGB twin"),
            Self::BufferBytes { asked, .. } => format!("{asked} bytes"),
        }
    }

    fn offered(&self) -> String {
        match self {
            Self::Size { most: [width, height, layers], .. } => format!("at most {width}×{height}×{layers}"),
            Self::Usage { offered, features, fallback, .. } => {
                let offered = match features.is_empty() {
                    true => format!("{offered:?}"),
                    false => format!("no such format, which takes {features:?}"),
                };
                fallback.map_or(offered.clone(), |format| format!("{offered}, and {format:?} as all of that"))
            }
            Self::Samples { offered, .. } => format!("{offered:?}"),
            Self::Views { .. } => "views in a texture's own format".into(),
            Self::BufferBytes { most, .. } => format!("at most {most} bytes"),
        }
    }

    const fn hint(&self) -> &'static str {
        match self {
            Self::Size { .. } => "use a smaller frame or a smaller texture",
            Self::Usage { .. } => "choose another format: `supported_format` takes the fallback by itself",
            Self::Samples { .. } => "use 1 or 4 samples",
            Self::BufferBytes { .. } => "split the buffer",
            Self::Views { .. } => "declare it in one format, or open a device that has `VIEW_FORMATS`",
        }
    }
}

/// Checks size, layers, samples and uses of a texture against the device.
pub(crate) fn check_texture(gpu: &Gpu, desc: &PhysicalTextureDesc, name: &str) -> Result<(), Unsupported> {
    let limits = gpu.device.limits();
    let [width, height, layers] = desc.size;
    let most = match desc.dimension {
        Dimension::D2 => {
            [limits.max_texture_dimension_2d, limits.max_texture_dimension_2d, limits.max_texture_array_layers]
        }
        Dimension::D3 => [limits.max_texture_dimension_3d; 3],
    };
    let refuse = |reason| Err(Unsupported { name: name.to_owned(), adapter: gpu.info().clone().into(), reason });
    if width > most[0] || height > most[1] || layers > most[2] {
        return refuse(UnsupportedReason::Size { asked: desc.size, most });
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
        return refuse(UnsupportedReason::Samples { format, asked: desc.samples, offered });
    }
    Ok(())
}

/// Checks the size of a buffer against the device.
pub(crate) fn check_buffer(gpu: &Gpu, bytes: u64, name: &str) -> Result<(), Unsupported> {
    let most = gpu.device.limits().max_buffer_size;
    if bytes <= most {
        return Ok(());
    }
    let reason = UnsupportedReason::BufferBytes { asked: bytes, most };
    Err(Unsupported { name: name.to_owned(), adapter: gpu.info().clone().into(), reason })
}

/// The next best format, when the device lacks one: more bits where there is such a format, fewer for the 32-bit ones.
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

/// `wanted`, or the first of its fallbacks that the device offers for `usage`; with `filtered`, one that can be sampled
/// with a linear filter. `None` when there is none.
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

/// Whether a shader may sample the format with a linear filter on this device.
fn is_filterable(gpu: &Gpu, format: Format) -> bool {
    let theirs = texture_format(format);
    let sampled = theirs.sample_type(None, Some(gpu.device.features()));
    sampled == Some(wgpu::TextureSampleType::Float { filterable: true })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::OpenError;
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
    fn a_refusal_names_what_was_asked_and_what_there_is() -> Result<(), OpenError> {
        let gpu = Gpu::noop()?;
        assert_eq!(check_texture(&gpu, &shape(Format::Rgba8Unorm, 64, 4, Usage::ATTACHMENT), "color"), Ok(()));
        let told = |shape| check_texture(&gpu, &shape, "color").map_err(|e| e.to_string()).err().unwrap_or_default();
        let large = told(shape(Format::Rgba8Unorm, 1 << 20, 1, Usage::ATTACHMENT));
        assert!(large.contains("1048576×1048576") && large.contains("at most 8192"), "{large}");
        let attached = told(shape(Format::Rgb9e5Ufloat, 4, 1, Usage::ATTACHMENT));
        assert!(attached.contains("Rgb9e5Ufloat") && attached.contains("RENDER_ATTACHMENT"), "{attached}");
        let samples = told(shape(Format::Rgba8Unorm, 4, 3, Usage::ATTACHMENT));
        assert!(samples.contains("3 samples") && samples.contains('4'), "{samples}");
        assert!(check_buffer(&gpu, u64::MAX, "b").is_err());
        Ok(())
    }

    /// A device that has nothing beyond what every one has.
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
        // What the two words say is what wgpu does: the format itself is refused, its fallback is made.
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
        let told = |format, usage| {
            let checked = check_texture(&gpu, &shape(format, 4, 1, usage), "hdr").map_err(|e| e.to_string());
            checked.err().unwrap_or_default()
        };
        let both = told(Format::Depth32FloatStencil8, Usage::ATTACHMENT);
        assert!(both.contains("`hdr` asks for Depth32FloatStencil8 as TextureUsages(RENDER_ATTACHMENT)"), "{both}");
        assert!(both.contains("takes Features") && both.contains("DEPTH32FLOAT_STENCIL8"), "{both}");
        assert!(both.contains("Depth24PlusStencil8 as all of that"), "{both}");
        let small = told(Format::Rg11b10Ufloat, Usage::ATTACHMENT);
        assert!(small.contains("Rgba16Float as all of that"), "{small}");
        Ok(())
    }

    #[test]
    fn fallbacks_are_taken_where_the_format_is_missing() -> Result<(), OpenError> {
        let gpu = Gpu::noop()?;
        let attached = |f| supported_format(&gpu, f, Usage::ATTACHMENT.union(Usage::SAMPLED), false);
        assert_eq!(attached(Format::Rgba8Unorm), Some(Format::Rgba8Unorm));
        assert_eq!(attached(Format::Rgb9e5Ufloat), Some(Format::Rgba16Float));
        assert_eq!(attached(Format::Bc1RgbaUnorm), None);
        assert_eq!(supported_format(&gpu, Format::R16Float, Usage::STORAGE, false), Some(Format::R32Float));
        Ok(())
    }
}
