//! Images, samplers and textures.

use glam::{Mat3, Vec2};

use super::id::Id;

/// Id of an image of a scene.
pub type ImageId = Id<Image>;
/// Id of a texture of a scene: an image with its role and sampler.
pub type TextureId = Id<Texture>;
/// Id of a sampler of a scene.
pub type SamplerId = Id<Sampler>;

/// Decoded image: row 0 at the top, straight alpha.
///
/// The image has no color space; [`TextureRole`] defines how to interpret texels. 16-bit sources are rounded to 8 bits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// Name for messages: the image's file, or the containing file with the image's number and name.
    pub name: String,
    /// Width in texels, at least 1.
    pub width: u32,
    /// Height in texels, at least 1.
    pub height: u32,
    /// Format of the texels of every level.
    pub format: ImageFormat,
    /// Bytes of the first mip level alone, or of every level down to 1 × 1, largest first; see
    /// [`Image::missing_levels`]. Empty after the image was uploaded and freed.
    pub levels: Vec<Vec<u8>>,
}

impl Image {
    /// Returns an image of 8-bit RGBA texels with one level. `texels` holds `width * height * 4` bytes, which
    /// [`Scene::check`](crate::Scene::check) verifies.
    #[must_use]
    pub fn from_rgba8(name: impl Into<String>, width: u32, height: u32, texels: Vec<u8>) -> Self {
        Self { name: name.into(), width, height, format: ImageFormat::Rgba8, levels: vec![texels] }
    }

    /// Returns the texels of the first level, four bytes each; `None` for a block-compressed image or one without
    /// levels.
    #[must_use]
    pub fn rgba8(&self) -> Option<&[u8]> {
        self.levels.first().filter(|_| self.format == ImageFormat::Rgba8).map(Vec::as_slice)
    }

    /// Returns the bytes of all levels that the image holds.
    #[must_use]
    pub fn size_bytes(&self) -> u64 {
        self.levels.iter().map(|level| level.len() as u64).sum()
    }

    /// Returns true if the image has only the first of several mip levels, so that the others must be generated.
    /// Block-compressed images always have all levels.
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

/// Returns the width and height of a mip level, at least 1 each.
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
    /// Returns the side of a block in texels; 1 for uncompressed formats.
    #[must_use]
    pub fn block_side_texels(self) -> u32 {
        match self {
            Self::Rgba8 => 1,
            Self::Bc7 | Self::Etc2Rgba8 | Self::Astc4x4 => 4,
        }
    }

    /// Returns the bytes of a block, or of a texel for uncompressed formats.
    #[must_use]
    pub fn block_bytes(self) -> u32 {
        match self {
            Self::Rgba8 => 4,
            Self::Bc7 | Self::Etc2Rgba8 | Self::Astc4x4 => 16,
        }
    }

    /// Returns the bytes of a level of this size. Partial blocks at the right and bottom edges count as whole ones.
    #[must_use]
    pub fn level_bytes(self, [width, height]: [u32; 2]) -> u64 {
        let blocks = |side: u32| u64::from(side.div_ceil(self.block_side_texels()));
        blocks(width) * blocks(height) * u64::from(self.block_bytes())
    }
}

/// Block-compressed formats that a device can sample. By default none, which keeps every image in
/// [`ImageFormat::Rgba8`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockFormats {
    /// [`ImageFormat::Bc7`]: most desktop GPUs.
    pub bc7: bool,
    /// [`ImageFormat::Etc2Rgba8`]: mobile GPUs.
    pub etc2: bool,
    /// [`ImageFormat::Astc4x4`]: most mobile GPUs.
    pub astc: bool,
}

/// Interpretation of the texels of a texture; determines the GPU format and the averaging of mip levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TextureRole {
    /// sRGB-encoded Rec.709 color, linear alpha.
    Color,
    /// Linear values: metallic, roughness, occlusion.
    Linear,
    /// Tangent-space unit vectors, `v = 2 t − 1`; mip levels are renormalized.
    Normal,
}

/// Addressing mode for texture coordinates outside of 0…1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Wrap {
    /// Repeats the image.
    #[default]
    Repeat,
    /// Repeats the image, mirrored every second time.
    MirroredRepeat,
    /// Extends the edge texel.
    ClampToEdge,
}

/// Filter between neighboring texels or mip levels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Filter {
    /// Nearest texel or level.
    Nearest,
    /// Linear interpolation.
    #[default]
    Linear,
}

/// Texture sampling state (glTF 2.0, section 5.26).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Sampler {
    /// Addressing mode along u.
    pub wrap_u: Wrap,
    /// Addressing mode along v.
    pub wrap_v: Wrap,
    /// Magnification filter: texels are larger than pixels.
    pub mag: Filter,
    /// Minification filter within a level: texels are smaller than pixels.
    pub min: Filter,
    /// Filter between mip levels; `None` samples only level 0.
    pub mip: Option<Filter>,
}

impl Default for Sampler {
    /// Returns repeat and trilinear filtering, for textures without a sampler; glTF leaves the choice to the
    /// implementation.
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

/// An image with a role and a sampler. Several textures may share an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Texture {
    /// Image to sample.
    pub image: ImageId,
    /// Interpretation of the texels.
    pub role: TextureRole,
    /// Sampler: addressing and filtering.
    pub sampler: SamplerId,
}

/// Affine transform of texture coordinates (KHR_texture_transform): scale, then rotation, then offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform {
    /// Translation, applied last; 1 is the width or height of the image.
    pub offset: Vec2,
    /// Rotation in radians, applied second. A quarter turn maps (u, v) to (v, −u), counter-clockwise on a screen with v
    /// pointing down.
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
    /// Returns the matrix that multiplies `(u, v, 1)`: translation · rotation · scale. The sign of the rotation follows
    /// the first example in the overview of KHR_texture_transform, since its sample code is ambiguous.
    #[must_use]
    pub fn matrix(&self) -> Mat3 {
        let (sin, cos) = self.rotation_rad.sin_cos();
        let rotation = Mat3::from_cols_array(&[cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0]);
        Mat3::from_translation(self.offset) * rotation * Mat3::from_scale(self.scale)
    }
}

/// Reference of a material to a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureSlot {
    /// Texture to sample.
    pub texture: TextureId,
    /// Set of texture coordinates: 0 or 1.
    pub uv_set: u32,
    /// Transform of the coordinates before sampling.
    pub transform: UvTransform,
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// The extension's first example shows "only the lower left quadrant, rotated"; with the opposite sign the image
    /// would leave 0…1.
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

    /// A non-uniform scale distinguishes scale-then-rotate from rotate-then-scale.
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
