//! Settings of prefiltered environments.

use framegraph_scene::environment::{ShBands, ShWindow};
use framegraph_scene::error::SceneError;

/// Storage format of the prefiltered cube.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum EnvironmentFormat {
    /// `Rg11b10Ufloat`, 4 bytes a texel. Falls back to half floats if the device cannot render to it, and for light
    /// that comes with the environment.
    #[default]
    Rg11b10,
    /// `Rgba16Float`, 8 bytes a texel.
    Half,
    /// RGBM in `Rgba8Unorm`, 4 bytes a texel. Every device supports it, and shaders decode it. The range is 0 to the
    /// cube's brightest channel, with steps of 0.4 to 0.9 % there. Filtering interpolates encoded values, which is
    /// visible next to very bright texels.
    Rgbm,
}

/// Settings of a prefiltered environment. The default is Filament's: 256 texels, five levels, three bands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IblSettings {
    /// Width and height of the specular cube in texels: a power of two, 64…1024.
    pub cube_texels: u32,
    /// Number of roughness levels, 5…8. The last level has at least 2 texels a side: at 256 texels the fifth has 16,
    /// the eighth 2. More levels reduce the error of interpolation, but the last one must resolve the lobe of
    /// roughness 1. Under a disc of 5°, the error is up to 46 % with five levels, 12 % with seven and 14 % with eight.
    /// `ibl_errors specular` prints the table.
    pub levels: u32,
    /// Bands of the spherical harmonics of irradiance.
    pub bands: ShBands,
    /// Windowing of high bands against ringing.
    pub window: ShWindow,
    /// Storage format of the cube.
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
    /// Checks the range of every setting.
    ///
    /// # Errors
    ///
    /// Fails if a setting is out of range, and names the first.
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
