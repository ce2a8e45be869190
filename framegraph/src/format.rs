//! Texel formats: memory size, planes, compression blocks and tile memory cost.
//!
//! Names and properties are those of the WebGPU specification, section "Texture Format Capabilities". Nothing here
//! depends on a GPU API.

/// Defines the enumeration of formats and the list of its variants.
macro_rules! formats {
    ($($format:ident),+ $(,)?) => {
        /// Format of a texel. Names follow WebGPU: channels with their bits, then the numeric type.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
        #[repr(u8)]
        #[allow(missing_docs, reason = "names define channels, bits and numeric type")]
        pub enum Format {
            $($format,)+
        }

        impl Format {
            /// Every format, in declaration order.
            pub const ALL: [Self; [$(Self::$format),+].len()] = [$(Self::$format),+];
        }
    };
}

formats! {
    R8Unorm, R8Snorm, R8Uint, R8Sint,
    R16Uint, R16Sint, R16Float,
    Rg8Unorm, Rg8Snorm, Rg8Uint, Rg8Sint,
    R32Uint, R32Sint, R32Float,
    Rg16Uint, Rg16Sint, Rg16Float,
    Rgba8Unorm, Rgba8UnormSrgb, Rgba8Snorm, Rgba8Uint, Rgba8Sint,
    Bgra8Unorm, Bgra8UnormSrgb,
    Rgb9e5Ufloat, Rgb10a2Uint, Rgb10a2Unorm, Rg11b10Ufloat,
    Rg32Uint, Rg32Sint, Rg32Float,
    Rgba16Uint, Rgba16Sint, Rgba16Float,
    Rgba32Uint, Rgba32Sint, Rgba32Float,
    Stencil8, Depth16Unorm, Depth24Plus, Depth24PlusStencil8, Depth32Float, Depth32FloatStencil8,
    Bc1RgbaUnorm, Bc1RgbaUnormSrgb, Bc3RgbaUnorm, Bc3RgbaUnormSrgb,
    Bc4RUnorm, Bc5RgUnorm, Bc6hRgbUfloat, Bc7RgbaUnorm, Bc7RgbaUnormSrgb,
    Etc2Rgb8Unorm, Etc2Rgba8Unorm,
    Astc4x4Unorm, Astc4x4UnormSrgb, Astc8x8Unorm,
}

/// Planes of a format: a color format has one, a depth-stencil format up to two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Aspect {
    /// Every plane of the format.
    All,
    /// The depth plane only.
    Depth,
    /// The stencil plane only.
    Stencil,
}

/// Numeric type that a shader reads or writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numeric {
    /// Floating point or normalized.
    Float,
    /// Signed integer.
    Sint,
    /// Unsigned integer.
    Uint,
    /// Depth, with or without stencil.
    Depth,
}

impl Format {
    /// Size of one block in memory in bytes, with all planes. `Depth24Plus` counts 4, `Depth32FloatStencil8` counts 5.
    pub const fn block_bytes(self) -> u32 {
        use Format::*;
        match self {
            R8Unorm | R8Snorm | R8Uint | R8Sint | Stencil8 => 1,
            R16Uint | R16Sint | R16Float | Rg8Unorm | Rg8Snorm | Rg8Uint | Rg8Sint | Depth16Unorm => 2,
            R32Uint | R32Sint | R32Float | Rg16Uint | Rg16Sint | Rg16Float | Rgba8Unorm | Rgba8UnormSrgb
            | Rgba8Snorm | Rgba8Uint | Rgba8Sint | Bgra8Unorm | Bgra8UnormSrgb | Rgb9e5Ufloat | Rgb10a2Uint
            | Rgb10a2Unorm | Rg11b10Ufloat | Depth24Plus | Depth24PlusStencil8 | Depth32Float => 4,
            Depth32FloatStencil8 => 5,
            Rg32Uint | Rg32Sint | Rg32Float | Rgba16Uint | Rgba16Sint | Rgba16Float | Bc1RgbaUnorm
            | Bc1RgbaUnormSrgb | Bc4RUnorm | Etc2Rgb8Unorm => 8,
            Rgba32Uint | Rgba32Sint | Rgba32Float | Bc3RgbaUnorm | Bc3RgbaUnormSrgb | Bc5RgUnorm | Bc6hRgbUfloat
            | Bc7RgbaUnorm | Bc7RgbaUnormSrgb | Etc2Rgba8Unorm | Astc4x4Unorm | Astc4x4UnormSrgb | Astc8x8Unorm => 16,
        }
    }

    /// Width and height of one block in texels; 1×1 for uncompressed formats.
    pub const fn block_texels(self) -> (u32, u32) {
        use Format::*;
        match self {
            Bc1RgbaUnorm | Bc1RgbaUnormSrgb | Bc3RgbaUnorm | Bc3RgbaUnormSrgb | Bc4RUnorm | Bc5RgUnorm
            | Bc6hRgbUfloat | Bc7RgbaUnorm | Bc7RgbaUnormSrgb | Etc2Rgb8Unorm | Etc2Rgba8Unorm | Astc4x4Unorm
            | Astc4x4UnormSrgb => (4, 4),
            Astc8x8Unorm => (8, 8),
            _ => (1, 1),
        }
    }

    /// Size in memory of one texel of a plane, in bytes; `All` is the sum of the planes.
    pub const fn texel_bytes(self, aspect: Aspect) -> u32 {
        use Format::*;
        match (self, aspect) {
            (Depth24PlusStencil8, Aspect::Depth) => 3,
            (Depth32FloatStencil8, Aspect::Depth) => 4,
            (Depth24PlusStencil8 | Depth32FloatStencil8 | Stencil8, Aspect::Stencil) => 1,
            (Stencil8, Aspect::Depth) => 0,
            (_, Aspect::Stencil) => 0,
            _ => self.block_bytes(),
        }
    }

    /// Bytes per sample in the tile: WebGPU's "render target pixel byte cost", to which its limit on color bytes per
    /// sample applies. For depth, the size in memory.
    pub const fn tile_bytes(self) -> u32 {
        use Format::*;
        match self {
            Rgba8Unorm | Rgba8UnormSrgb | Rgba8Snorm | Bgra8Unorm | Bgra8UnormSrgb | Rgb10a2Unorm | Rgb10a2Uint
            | Rg11b10Ufloat => 8,
            _ => self.block_bytes(),
        }
    }

    /// Number of channels of a color format: 1 to 4. For depth-stencil formats, the number of planes.
    pub const fn channels(self) -> u8 {
        use Format::*;
        match self {
            R8Unorm | R8Snorm | R8Uint | R8Sint | R16Uint | R16Sint | R16Float | R32Uint | R32Sint | R32Float
            | Bc4RUnorm | Stencil8 | Depth16Unorm | Depth24Plus | Depth32Float => 1,
            Rg8Unorm | Rg8Snorm | Rg8Uint | Rg8Sint | Rg16Uint | Rg16Sint | Rg16Float | Rg32Uint | Rg32Sint
            | Rg32Float | Bc5RgUnorm | Depth24PlusStencil8 | Depth32FloatStencil8 => 2,
            Rgb9e5Ufloat | Rg11b10Ufloat | Bc6hRgbUfloat | Etc2Rgb8Unorm => 3,
            _ => 4,
        }
    }

    /// Returns `true` if the values of the format are integers that stand for 0 to 1 or −1 to 1.
    pub const fn is_normalized(self) -> bool {
        use Format::*;
        matches!(
            self,
            R8Unorm
                | R8Snorm
                | Rg8Unorm
                | Rg8Snorm
                | Rgba8Unorm
                | Rgba8UnormSrgb
                | Rgba8Snorm
                | Bgra8Unorm
                | Bgra8UnormSrgb
                | Rgb10a2Unorm
                | Depth16Unorm
                | Bc1RgbaUnorm
                | Bc1RgbaUnormSrgb
                | Bc3RgbaUnorm
                | Bc3RgbaUnormSrgb
                | Bc4RUnorm
                | Bc5RgUnorm
                | Bc7RgbaUnorm
                | Bc7RgbaUnormSrgb
                | Etc2Rgb8Unorm
                | Etc2Rgba8Unorm
                | Astc4x4Unorm
                | Astc4x4UnormSrgb
                | Astc8x8Unorm
        )
    }

    /// Size of one component in the tile, in bytes: WebGPU's "render target component alignment". Attachments start at
    /// a multiple of it.
    pub const fn tile_component_bytes(self) -> u32 {
        use Format::*;
        match self {
            R16Uint | R16Sint | R16Float | Rg16Uint | Rg16Sint | Rg16Float | Rgba16Uint | Rgba16Sint | Rgba16Float => 2,
            R32Uint | R32Sint | R32Float | Rg32Uint | Rg32Sint | Rg32Float | Rgba32Uint | Rgba32Sint | Rgba32Float
            | Rgb10a2Uint | Rgb10a2Unorm | Rg11b10Ufloat => 4,
            _ => 1,
        }
    }

    /// Returns the size of color attachments in the tile, in bytes per sample, each aligned to its component as in
    /// WebGPU. `formats` are ordered by slot.
    pub fn tile_sum(formats: impl Iterator<Item = Self>) -> u32 {
        formats.fold(0, |sum: u32, f| sum.next_multiple_of(f.tile_component_bytes()) + f.tile_bytes())
    }

    /// Returns `true` if the format has a depth or a stencil plane.
    pub const fn is_depth_stencil(self) -> bool {
        self.has_depth() || self.has_stencil()
    }

    /// Returns `true` if the format has a depth plane.
    pub const fn has_depth(self) -> bool {
        use Format::*;
        matches!(self, Depth16Unorm | Depth24Plus | Depth24PlusStencil8 | Depth32Float | Depth32FloatStencil8)
    }

    /// Returns `true` if the format has a stencil plane.
    pub const fn has_stencil(self) -> bool {
        matches!(self, Format::Stencil8 | Format::Depth24PlusStencil8 | Format::Depth32FloatStencil8)
    }

    /// Number of planes: 2 for depth with stencil, otherwise 1.
    pub const fn planes(self) -> u32 {
        if self.has_depth() && self.has_stencil() { 2 } else { 1 }
    }

    /// Returns `true` for block-compressed formats, which can only be sampled and copied.
    pub const fn is_compressed(self) -> bool {
        self.block_texels().0 != 1
    }

    /// Returns `true` if WebGPU allows color attachments of this format (`Rg11b10Ufloat` requires a feature).
    pub const fn is_color_renderable(self) -> bool {
        !self.is_depth_stencil() && !self.is_compressed() && !matches!(self, Format::Rgb9e5Ufloat)
    }

    /// Returns `true` for formats with the sRGB transfer function (IEC 61966-2-1).
    pub const fn is_srgb(self) -> bool {
        self.without_srgb() as u8 != self as u8
    }

    /// Returns the format without the sRGB transfer function. Formats that differ only in it can share memory through
    /// `view_formats`.
    pub const fn without_srgb(self) -> Self {
        use Format::*;
        match self {
            Rgba8UnormSrgb => Rgba8Unorm,
            Bgra8UnormSrgb => Bgra8Unorm,
            Bc1RgbaUnormSrgb => Bc1RgbaUnorm,
            Bc3RgbaUnormSrgb => Bc3RgbaUnorm,
            Bc7RgbaUnormSrgb => Bc7RgbaUnorm,
            Astc4x4UnormSrgb => Astc4x4Unorm,
            other => other,
        }
    }

    /// Returns the numeric type that a shader reads or writes.
    pub const fn numeric(self) -> Numeric {
        use Format::*;
        match self {
            R8Uint | R16Uint | Rg8Uint | R32Uint | Rg16Uint | Rgba8Uint | Rgb10a2Uint | Rg32Uint | Rgba16Uint
            | Rgba32Uint => Numeric::Uint,
            R8Sint | R16Sint | Rg8Sint | R32Sint | Rg16Sint | Rgba8Sint | Rg32Sint | Rgba16Sint | Rgba32Sint => {
                Numeric::Sint
            }
            Stencil8 | Depth16Unorm | Depth24Plus | Depth24PlusStencil8 | Depth32Float | Depth32FloatStencil8 => {
                Numeric::Depth
            }
            _ => Numeric::Float,
        }
    }

    /// Returns the format of the depth plane for depth with stencil; other formats are returned unchanged.
    pub const fn depth_alone(self) -> Self {
        match self {
            Self::Depth24PlusStencil8 => Self::Depth24Plus,
            Self::Depth32FloatStencil8 => Self::Depth32Float,
            other => other,
        }
    }

    /// Returns `true` if multisampled attachments of this format can be averaged: color, not integer.
    pub const fn is_resolvable(self) -> bool {
        self.is_color_renderable() && matches!(self.numeric(), Numeric::Float)
    }
}

impl Aspect {
    /// Returns `true` if the aspect includes plane number `plane` of `format`.
    pub const fn selects_plane(self, format: Format, plane: u32) -> bool {
        match self {
            Self::All => true,
            Self::Depth => plane == 0 && format.has_depth(),
            Self::Stencil => format.has_stencil() && plane + 1 == format.planes(),
        }
    }

    /// Returns `true` if `format` has the planes of this aspect.
    pub const fn exists_in(self, format: Format) -> bool {
        match self {
            Self::All => true,
            Self::Depth => format.has_depth(),
            Self::Stencil => format.has_stencil(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_complete_and_in_order() {
        for (i, f) in Format::ALL.iter().enumerate() {
            assert_eq!(*f as usize, i, "{f:?}");
        }
    }

    #[test]
    fn planes_add_up() {
        for f in Format::ALL {
            if f.has_depth() && f.has_stencil() {
                assert_eq!(f.texel_bytes(Aspect::Depth) + f.texel_bytes(Aspect::Stencil), f.block_bytes(), "{f:?}");
            }
        }
    }

    #[test]
    fn a_format_and_its_srgb_form_have_one_size_and_one_block() {
        for f in Format::ALL {
            let linear = f.without_srgb();
            assert!(!linear.is_srgb());
            assert_eq!((f.block_bytes(), f.block_texels()), (linear.block_bytes(), linear.block_texels()));
            assert_eq!(f.is_srgb(), format!("{f:?}").ends_with("Srgb"), "{f:?}");
        }
    }

    #[test]
    fn tile_cost_of_the_webgpu_table() {
        assert_eq!(Format::Rgba8Unorm.tile_bytes(), 8);
        assert_eq!(Format::Rgba16Float.tile_bytes(), 8);
        assert_eq!(Format::R32Float.tile_bytes(), 4);
        assert_eq!(Format::Depth32FloatStencil8.tile_bytes(), 5);
    }
}
