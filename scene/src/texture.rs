//! Images, how they are sampled, and what their texels mean.

use glam::{Mat3, Vec2};

use super::id::Id;

/// An image of a scene.
pub type ImageId = Id<Image>;
/// A texture of a scene: an image with its role and sampler.
pub type TextureId = Id<Texture>;
/// A sampler of a scene.
pub type SamplerId = Id<Sampler>;

/// A decoded picture: row 0 at the top, alpha not premultiplied.
///
/// The texels carry no color space of their own; [`TextureRole`] says how to read them. 16-bit
/// sources are rounded to 8 bits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// For messages: the image's file, or the file it is embedded in with its number and name.
    pub name: String,
    /// Width in texels, at least 1.
    pub width: u32,
    /// Height in texels, at least 1.
    pub height: u32,
    /// Format of the texels of every level.
    pub format: ImageFormat,
    /// Bytes of the first mip level, or of every level down to 1 × 1, largest first. [`Image::missing_levels`] tells the two
    /// apart. Empty after the image was uploaded and freed.
    pub levels: Vec<Vec<u8>>,
}

impl Image {
    /// Returns an image of 8-bit RGBA texels with one level. `texels` holds `width * height * 4` bytes, which
    /// [`Scene::check`](crate::Scene::check) verifies.
    #[must_use]
    pub fn from_rgba8(name: impl Into<String>, width: u32, height: u32, texels: Vec<u8>) -> Self {
        Self { name: name.into(), width, height, format: ImageFormat::Rgba8, levels: vec![texels] }
    }

    /// Returns the texels of the first level, four bytes each; `None` for an image of blocks or one without levels.
    #[must_use]
    pub fn rgba8(&self) -> Option<&[u8]> {
        self.levels.first().filter(|_| self.format == ImageFormat::Rgba8).map(Vec::as_slice)
    }

    /// Returns the bytes of all levels that the image holds.
    #[must_use]
    pub fn size_bytes(&self) -> u64 {
        self.levels.iter().map(|level| level.len() as u64).sum()
    }

    /// Returns whether the image holds the first mip level alone and has more than one texel, so that the others are to be
    /// made. Images of blocks always hold every level.
    #[must_use]
    pub fn missing_levels(&self) -> bool {
        self.levels.len() == 1 && self.width.max(self.height) > 1
    }

    /// Returns the width and height of a level, at least 1 each.
    #[must_use]
    pub fn level_size(&self, level: u32) -> [u32; 2] {
        level_size([self.width, self.height], level)
    }
}

/// Width and height of a level of a picture of this size, at least 1 each.
pub(crate) fn level_size(size_texels: [u32; 2], level: u32) -> [u32; 2] {
    size_texels.map(|side| side.checked_shr(level).unwrap_or(0).max(1))
}

/// Storage format of the texels of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ImageFormat {
    /// Four bytes a texel: red, green, blue, alpha.
    #[default]
    Rgba8,
    /// BC7: blocks of 4 × 4 texels, 16 bytes each.
    Bc7,
    /// ETC2 with EAC alpha: blocks of 4 × 4 texels, 16 bytes each.
    Etc2Rgba8,
    /// ASTC of low dynamic range: blocks of 4 × 4 texels, 16 bytes each.
    Astc4x4,
}

impl ImageFormat {
    /// Returns the texels along a side of a block: 1 for formats without blocks.
    #[must_use]
    pub fn block_side_texels(self) -> u32 {
        match self {
            Self::Rgba8 => 1,
            Self::Bc7 | Self::Etc2Rgba8 | Self::Astc4x4 => 4,
        }
    }

    /// Returns the bytes of a block, or of a texel for formats without blocks.
    #[must_use]
    pub fn block_bytes(self) -> u32 {
        match self {
            Self::Rgba8 => 4,
            Self::Bc7 | Self::Etc2Rgba8 | Self::Astc4x4 => 16,
        }
    }

    /// Returns the bytes of a level of this size. Blocks at its right and lower edge count whole.
    #[must_use]
    pub fn level_bytes(self, [width, height]: [u32; 2]) -> u64 {
        let blocks = |side: u32| u64::from(side.div_ceil(self.block_side_texels()));
        blocks(width) * blocks(height) * u64::from(self.block_bytes())
    }
}

/// Block-compressed formats that a device can sample; none by default, which keeps every image in [`ImageFormat::Rgba8`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockFormats {
    /// [`ImageFormat::Bc7`]: most desktop GPUs.
    pub bc7: bool,
    /// [`ImageFormat::Etc2Rgba8`]: mobile GPUs.
    pub etc2: bool,
    /// [`ImageFormat::Astc4x4`]: most mobile GPUs.
    pub astc: bool,
}

/// What the texels of a texture mean, which decides the GPU format and how mip levels are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TextureRole {
    /// sRGB-encoded Rec.709 color, linear alpha.
    Color,
    /// Linear values: metallic, roughness, occlusion.
    Linear,
    /// Tangent-space unit vectors, `v = 2 t − 1`; mip levels are renormalised.
    Normal,
}

/// Which texel is sampled at coordinates outside of 0…1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Wrap {
    /// The picture repeats.
    #[default]
    Repeat,
    /// The picture repeats, mirrored every second time.
    MirroredRepeat,
    /// The edge texel continues.
    ClampToEdge,
}

/// How neighboring texels, or levels, are combined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Filter {
    /// The nearest one.
    Nearest,
    /// The mean of the nearest ones, weighted by distance.
    #[default]
    Linear,
}

/// How a texture is sampled (glTF 2.0, section 5.26).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Sampler {
    /// Wrapping along u.
    pub wrap_u: Wrap,
    /// Wrapping along v.
    pub wrap_v: Wrap,
    /// Filter when a texel covers more than a pixel.
    pub mag: Filter,
    /// Filter within a level when a texel covers less than a pixel.
    pub min: Filter,
    /// Filter between levels; `None` samples level 0 only.
    pub mip: Option<Filter>,
}

impl Default for Sampler {
    /// Repeat, trilinear: what glTF leaves to the implementation when no sampler is given.
    fn default() -> Self {
        Self {
            wrap_u: Wrap::Repeat,
            wrap_v: Wrap::Repeat,
            mag: Filter::Linear,
            min: Filter::Linear,
            mip: Some(Filter::Linear),
        }
    }
}

/// An image read in one role through one sampler. One image may stand in several textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Texture {
    /// The image that is sampled.
    pub image: ImageId,
    /// What its texels mean in this texture.
    pub role: TextureRole,
    /// Wrapping and filtering.
    pub sampler: SamplerId,
}

/// An affine map of texture coordinates (KHR_texture_transform): scale, then rotation, then offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform {
    /// Translation, applied last; 1 is the width or height of the picture.
    pub offset: Vec2,
    /// Rotation in radians, applied second; a quarter turn takes (u, v) to (v, −u), counter-clockwise on a screen where v
    /// grows downwards.
    pub rotation_rad: f32,
    /// Scale along u and v, applied first.
    pub scale: Vec2,
}

impl Default for UvTransform {
    fn default() -> Self {
        Self { offset: Vec2::ZERO, rotation_rad: 0.0, scale: Vec2::ONE }
    }
}

impl UvTransform {
    /// The matrix to multiply `(u, v, 1)` with: translation · rotation · scale
    /// (KHR_texture_transform, "Overview"; the sign of the rotation is that of its first example,
    /// since the sample code there can be read either way).
    #[must_use]
    pub fn matrix(&self) -> Mat3 {
        let (sin, cos) = self.rotation_rad.sin_cos();
        let rotation = Mat3::from_cols_array(&[cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0]);
        Mat3::from_translation(self.offset) * rotation * Mat3::from_scale(self.scale)
    }
}

/// A texture as a material uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureSlot {
    /// The texture that is sampled.
    pub texture: TextureId,
    /// The set of texture coordinates: 0 or 1.
    pub uv_set: u32,
    /// Transform of the coordinates before sampling.
    pub transform: UvTransform,
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// The extension's first example shows "only the lower left quadrant, rotated": with the other
    /// sign the picture would leave 0…1.
    #[test]
    fn rotation_has_the_sign_of_the_specifications_example() {
        let matrix = UvTransform {
            offset: Vec2::new(0.0, 1.0),
            rotation_rad: std::f32::consts::FRAC_PI_2,
            scale: Vec2::splat(0.5),
        }
        .matrix();
        for (from, to) in
            [(Vec2::ZERO, Vec2::new(0.0, 1.0)), (Vec2::X, Vec2::new(0.0, 0.5)), (Vec2::ONE, Vec2::new(0.5, 0.5))]
        {
            let moved = matrix * from.extend(1.0);
            assert!((moved - to.extend(1.0)).length() < 1e-6, "{from} -> {moved}");
        }
    }

    /// An uneven scale tells scale-then-rotate from rotate-then-scale.
    #[test]
    fn transform_scales_before_it_rotates() {
        let transform = UvTransform {
            rotation_rad: std::f32::consts::FRAC_PI_2,
            scale: Vec2::new(2.0, 3.0),
            ..UvTransform::default()
        };
        let moved = transform.matrix() * Vec3::new(1.0, 1.0, 1.0);
        assert!((moved - Vec3::new(3.0, -2.0, 1.0)).length() < 1e-6, "{moved}");
        assert_eq!(UvTransform::default().matrix(), Mat3::IDENTITY);
    }
}
