//! What an environment's light is made with.

use framegraph_scene::environment::{ShBands, ShWindow};
use framegraph_scene::error::SceneError;

/// Storage of the prefiltered environment's texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum EnvironmentFormat {
    /// `Rg11b10Ufloat`, 4 bytes a texel; half floats where the device cannot draw that format, and for light that the
    /// environment came with.
    #[default]
    Rg11b10,
    /// `Rgba16Float`, 8 bytes a texel.
    Half,
    /// `Rgba8Unorm` as RGBM, 4 bytes a texel: every device has it, and shaders decode it. Holds numbers from 0 to the cube's
    /// brightest channel, with steps of 0.4 to 0.9 % there. Filters interpolate codes, which shows where bright texels are
    /// beside dark ones.
    Rgbm,
}

/// How fine the light is. The default is what Filament does: 256 texels, five levels, three bands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IblSettings {
    /// Width and height of the specular cube in texels: a power of two, 64…1024.
    pub cube_texels: u32,
    /// Levels of roughness, 5…8, the last no smaller than 2 texels: of 256 texels the fifth level has 16 and
    /// the eighth 2. More levels err less between them, but the last one must still show the lobe of
    /// roughness 1: under a disc of 5° seven levels err by 12 % at most where five err by 46 %, and eight
    /// by 14 % because two texels are too few. `ibl_errors specular` prints the table.
    pub levels: u32,
    /// Bands of the spherical harmonics of irradiance.
    pub bands: ShBands,
    /// Whether high bands are weakened against ringing.
    pub window: ShWindow,
    /// Storage of the cube's texels.
    pub format: EnvironmentFormat,
}

impl Default for IblSettings {
    fn default() -> Self {
        Self {
            cube_texels: 256,
            levels: 5,
            bands: ShBands::Three,
            window: ShWindow::None,
            format: EnvironmentFormat::Rg11b10,
        }
    }
}

impl IblSettings {
    /// Checks that every setting is in its range, as making light does first.
    ///
    /// # Errors
    ///
    /// The first setting that is out of range, by name.
    pub fn check(&self) -> Result<(), SceneError> {
        let refuse = |parameter, value: f64, range| Err(SceneError::Parameter { parameter, value, range });
        if !(self.cube_texels.is_power_of_two() && (64..=1024).contains(&self.cube_texels)) {
            return refuse("specular cube size", self.cube_texels.into(), "64, 128, 256, 512 or 1024 texels");
        }
        if !(5..=8).contains(&self.levels) || self.cube_texels >> (self.levels - 1) < 2 {
            return refuse("specular cube levels", self.levels.into(), "5…8, the last no smaller than 2 texels");
        }
        match self.window {
            ShWindow::Laplacian { lambda } if !(lambda >= 0.0 && lambda.is_finite()) => {
                refuse("lambda of the Laplacian window", lambda, "0 or more")
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_out_of_range_are_named() {
        let good = IblSettings::default();
        assert!(good.check().is_ok());
        assert!(IblSettings { levels: 8, ..good }.check().is_ok());
        for (bad, word) in [
            (IblSettings { cube_texels: 100, ..good }, "cube size"),
            (IblSettings { cube_texels: 2048, ..good }, "cube size"),
            (IblSettings { levels: 4, ..good }, "levels"),
            (IblSettings { levels: 9, ..good }, "levels"),
            (IblSettings { levels: 7, cube_texels: 64, ..good }, "levels"),
            (IblSettings { window: ShWindow::Laplacian { lambda: f64::NAN }, ..good }, "lambda"),
        ] {
            assert!(bad.check().is_err_and(|e| e.to_string().contains(word)), "{bad:?}");
        }
    }
}
