//! Images, how they are sampled, and what their texels mean.

use glam::{Mat3, Vec2};

use super::id::Id;

/// An image of a scene.
pub type ImageId = Id<Image>;
/// A texture of a scene: an image with its role and sampler.
pub type TextureId = Id<Texture>;
/// A sampler of a scene.
pub type SamplerId = Id<Sampler>;

/// A decoded picture: 8-bit RGBA, row 0 at the top, alpha not premultiplied.
///
/// The texels carry no color space of their own; [`TextureRole`] says how to read them. 16-bit
/// sources are rounded to 8 bits.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// For messages: the image's file, or the file it is embedded in with its number and name.
    pub name: String,
    /// Width in texels, at least 1.
    pub width: u32,
    /// Height in texels, at least 1.
    pub height: u32,
    /// `width * height * 4` bytes.
    pub rgba8: Vec<u8>,
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
