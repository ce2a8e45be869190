//! Light that was made of an environment elsewhere.

use super::sh::Sh;

/// Light that a file holds ready-made: a cube of radiance filtered for a roughness a level, and irradiance. Filament's
/// `cmgen` makes it so; it is taken as it is, so that surfaces look as they do there.
#[derive(Clone, Debug, PartialEq)]
pub struct FilteredLight {
    /// Width and height of the faces of the first level in texels.
    pub size_texels: u32,
    /// Level by level, each half as wide as the one before; the faces of each one after the other, +x −x +y −y +z −z, rows
    /// from the top as a cube is looked up by direction. Four numbers a texel, linear Rec.709 in the unit of the map, alpha 1.
    /// Of n levels, level i is for the perceptual roughness r with r · (2 − r) = i / (n − 1).
    pub levels: Vec<Vec<[f32; 4]>>,
    /// Three bands of radiance whose irradiance the file has.
    pub sh: Sh,
}
