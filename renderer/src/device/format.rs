//! Conversion of formats and usages between the compiler and wgpu.

use framegraph::{Aspect, Format, Usage};
use wgpu::{AstcBlock, AstcChannel, BufferUsages, TextureAspect, TextureFormat, TextureUsages};

/// Returns the descriptor of a two-dimensional texture with one layer, one mip level and one sample per texel.
pub fn texture_2d(
    label: &str,
    [width, height]: [u32; 2],
    format: TextureFormat,
    usage: TextureUsages,
) -> wgpu::TextureDescriptor<'_> {
    wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }
}

/// Returns the wgpu format of the same name.
pub const fn texture_format(format: Format) -> TextureFormat {
    use TextureFormat as T;
    match format {
        Format::R8Unorm => T::R8Unorm,
        Format::R8Snorm => T::R8Snorm,
        Format::R8Uint => T::R8Uint,
        Format::R8Sint => T::R8Sint,
        Format::R16Uint => T::R16Uint,
        Format::R16Sint => T::R16Sint,
        Format::R16Float => T::R16Float,
        Format::Rg8Unorm => T::Rg8Unorm,
        Format::Rg8Snorm => T::Rg8Snorm,
        Format::Rg8Uint => T::Rg8Uint,
        Format::Rg8Sint => T::Rg8Sint,
        Format::R32Uint => T::R32Uint,
        Format::R32Sint => T::R32Sint,
        Format::R32Float => T::R32Float,
        Format::Rg16Uint => T::Rg16Uint,
        Format::Rg16Sint => T::Rg16Sint,
        Format::Rg16Float => T::Rg16Float,
        Format::Rgba8Unorm => T::Rgba8Unorm,
        Format::Rgba8UnormSrgb => T::Rgba8UnormSrgb,
        Format::Rgba8Snorm => T::Rgba8Snorm,
        Format::Rgba8Uint => T::Rgba8Uint,
        Format::Rgba8Sint => T::Rgba8Sint,
        Format::Bgra8Unorm => T::Bgra8Unorm,
        Format::Bgra8UnormSrgb => T::Bgra8UnormSrgb,
        Format::Rgb9e5Ufloat => T::Rgb9e5Ufloat,
        Format::Rgb10a2Uint => T::Rgb10a2Uint,
        Format::Rgb10a2Unorm => T::Rgb10a2Unorm,
        Format::Rg11b10Ufloat => T::Rg11b10Ufloat,
        Format::Rg32Uint => T::Rg32Uint,
        Format::Rg32Sint => T::Rg32Sint,
        Format::Rg32Float => T::Rg32Float,
        Format::Rgba16Uint => T::Rgba16Uint,
        Format::Rgba16Sint => T::Rgba16Sint,
        Format::Rgba16Float => T::Rgba16Float,
        Format::Rgba32Uint => T::Rgba32Uint,
        Format::Rgba32Sint => T::Rgba32Sint,
        Format::Rgba32Float => T::Rgba32Float,
        Format::Stencil8 => T::Stencil8,
        Format::Depth16Unorm => T::Depth16Unorm,
        Format::Depth24Plus => T::Depth24Plus,
        Format::Depth24PlusStencil8 => T::Depth24PlusStencil8,
        Format::Depth32Float => T::Depth32Float,
        Format::Depth32FloatStencil8 => T::Depth32FloatStencil8,
        Format::Bc1RgbaUnorm => T::Bc1RgbaUnorm,
        Format::Bc1RgbaUnormSrgb => T::Bc1RgbaUnormSrgb,
        Format::Bc3RgbaUnorm => T::Bc3RgbaUnorm,
        Format::Bc3RgbaUnormSrgb => T::Bc3RgbaUnormSrgb,
        Format::Bc4RUnorm => T::Bc4RUnorm,
        Format::Bc5RgUnorm => T::Bc5RgUnorm,
        Format::Bc6hRgbUfloat => T::Bc6hRgbUfloat,
        Format::Bc7RgbaUnorm => T::Bc7RgbaUnorm,
        Format::Bc7RgbaUnormSrgb => T::Bc7RgbaUnormSrgb,
        Format::Etc2Rgb8Unorm => T::Etc2Rgb8Unorm,
        Format::Etc2Rgba8Unorm => T::Etc2Rgba8Unorm,
        Format::Astc4x4Unorm => T::Astc { block: AstcBlock::B4x4, channel: AstcChannel::Unorm },
        Format::Astc4x4UnormSrgb => T::Astc { block: AstcBlock::B4x4, channel: AstcChannel::UnormSrgb },
        Format::Astc8x8Unorm => T::Astc { block: AstcBlock::B8x8, channel: AstcChannel::Unorm },
    }
}

/// Returns the compiler's format of the same name. `None` for formats that the compiler does not know (video planes,
/// 16-bit normalized, most ASTC blocks).
pub fn format_of(format: TextureFormat) -> Option<Format> {
    Format::ALL.into_iter().find(|f| texture_format(*f) == format)
}

/// Returns the wgpu usages of a texture. Input attachments become texture bindings, since wgpu has no input
/// attachments.
pub fn texture_usages(usage: Usage) -> TextureUsages {
    let table = [
        (Usage::ATTACHMENT, TextureUsages::RENDER_ATTACHMENT),
        (Usage::INPUT_ATTACHMENT, TextureUsages::TEXTURE_BINDING),
        (Usage::SAMPLED, TextureUsages::TEXTURE_BINDING),
        (Usage::STORAGE, TextureUsages::STORAGE_BINDING),
        (Usage::COPY_SOURCE, TextureUsages::COPY_SRC),
        (Usage::COPY_TARGET, TextureUsages::COPY_DST),
    ];
    table.into_iter().filter(|(u, _)| usage.contains(*u)).fold(TextureUsages::empty(), |all, (_, w)| all | w)
}

/// Returns the wgpu usages of a buffer.
pub fn buffer_usages(usage: Usage) -> BufferUsages {
    let table = [
        (Usage::STORAGE, BufferUsages::STORAGE),
        (Usage::UNIFORM, BufferUsages::UNIFORM),
        (Usage::VERTEX, BufferUsages::VERTEX),
        (Usage::INDEX, BufferUsages::INDEX),
        (Usage::INDIRECT, BufferUsages::INDIRECT),
        (Usage::COPY_SOURCE, BufferUsages::COPY_SRC),
        (Usage::COPY_TARGET, BufferUsages::COPY_DST),
    ];
    table.into_iter().filter(|(u, _)| usage.contains(*u)).fold(BufferUsages::empty(), |all, (_, w)| all | w)
}

/// Returns wgpu's name of a plane selection.
pub const fn texture_aspect(aspect: Aspect) -> TextureAspect {
    match aspect {
        Aspect::All => TextureAspect::All,
        Aspect::Depth => TextureAspect::DepthOnly,
        Aspect::Stencil => TextureAspect::StencilOnly,
    }
}

/// Returns the planes that a shader can sample. For formats with depth and stencil, `All` means depth.
pub const fn sampled_aspect(format: Format, aspect: Aspect) -> TextureAspect {
    match aspect {
        Aspect::All if format.has_depth() && format.has_stencil() => TextureAspect::DepthOnly,
        other => texture_aspect(other),
    }
}

/// Returns the sRGB and the linear form of a format, for `view_formats` of a texture that is viewed as both.
pub(crate) fn both_forms(format: TextureFormat) -> [TextureFormat; 2] {
    [format.add_srgb_suffix(), format.remove_srgb_suffix()]
}

/// Joins names of flags with commas, for error messages.
pub(crate) fn joined<'n, F>(names: impl Iterator<Item = (&'n str, F)>) -> String {
    let names: Vec<_> = names.map(|(name, _)| name).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_maps_and_agrees_with_wgpu() {
        for format in Format::ALL {
            let theirs = texture_format(format);
            assert_eq!(format_of(theirs), Some(format));
            assert_eq!(theirs.block_dimensions(), format.block_texels(), "{format:?}");
            assert_eq!(theirs.has_depth_aspect(), format.has_depth(), "{format:?}");
            assert_eq!(theirs.has_stencil_aspect(), format.has_stencil(), "{format:?}");
            assert_eq!(theirs.is_srgb(), format.is_srgb(), "{format:?}");
            assert_eq!(theirs.remove_srgb_suffix(), texture_format(format.without_srgb()), "{format:?}");
            if !format.is_depth_stencil() {
                assert_eq!(theirs.block_copy_size(None), Some(format.block_bytes()), "{format:?}");
            }
            if format.is_color_renderable() {
                assert_eq!(theirs.target_pixel_byte_cost(), Some(format.tile_bytes()), "{format:?}");
            }
        }
    }

    #[test]
    fn usages_map_one_to_one() {
        let all = Usage::ATTACHMENT.union(Usage::INPUT_ATTACHMENT).union(Usage::COPY_TARGET);
        let expected = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        assert_eq!(texture_usages(all), expected);
        assert_eq!(buffer_usages(Usage::INDEX.union(Usage::STORAGE)), BufferUsages::INDEX | BufferUsages::STORAGE);
    }
}
