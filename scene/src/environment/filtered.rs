//! Prefiltered light of an environment.

use super::sh::Sh;

/// Prefiltered light from a file: radiance for a roughness per level as a cube map, and irradiance. Filament's `cmgen`
/// writes such files; using them unchanged reproduces Filament's shading.
#[derive(Clone, Debug, PartialEq)]
pub struct FilteredLight {
    /// Width and height of the faces of the first level in texels.
    pub size_texels: u32,
    /// Texels of each level; a level is half as wide as its predecessor. Faces follow in the order +x −x +y −y +z −z,
    /// in the row order of cube map lookups. A texel is four numbers, linear Rec.709 in the unit of the map, alpha 1.
    /// With n levels, level i is for the perceptual roughness r with r · (2 − r) = i / (n − 1).
    pub levels: Vec<Vec<[f32; 4]>>,
    /// Three bands of spherical harmonics of radiance that reproduce the irradiance of the file.
    pub sh: Sh,
}
