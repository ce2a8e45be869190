//! Precision of shading arithmetic.

use framegraph_wgpu::Gpu;

/// Error for a device without half floats in shaders.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "precision {}: {adapter} has no half floats in shaders (the feature SHADER_F16); choose {}, or another adapter",
    .precision.name(),
    Precision::Full.name()
)]
pub struct PrecisionError {
    /// The requested precision.
    pub precision: Precision,
    /// Description of the adapter.
    pub adapter: String,
}

impl std::fmt::Debug for PrecisionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Precision of surface parameters and reflected light in the color pass. Radiance, positions, depth and shadows
/// always use 32 bits (`shaders/wgsl/lib/real.wgsl`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Precision {
    /// 32 bits.
    #[default]
    Full,
    /// 16 bits, if shaders support them. Perceptual roughness is at least 0.089; below it highlights exceed the range
    /// of half floats. `docs/measurements/half-floats.md` has the errors.
    Half,
}

impl Precision {
    /// Both precisions.
    pub const ALL: [Self; 2] = [Self::Full, Self::Half];

    /// Returns the name used in options: `f32` or `f16`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Full => "f32",
            Self::Half => "f16",
        }
    }

    /// Returns the precision with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|precision| precision.name() == name)
    }

    /// Returns the minimum perceptual roughness at this precision.
    pub const fn roughness_floor(self) -> f32 {
        match self {
            Self::Full => 0.045,
            Self::Half => 0.089,
        }
    }

    /// Checks that the device supports this precision.
    ///
    /// # Errors
    /// Fails with a message that names the adapter and an alternative.
    pub fn check(self, gpu: &Gpu) -> Result<(), PrecisionError> {
        if self == Self::Full || gpu.device.features().contains(wgpu::Features::SHADER_F16) {
            return Ok(());
        }
        Err(PrecisionError { precision: self, adapter: gpu.describe() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_again() {
        for precision in Precision::ALL {
            assert_eq!(Precision::from_name(precision.name()), Some(precision));
        }
        assert_eq!(Precision::from_name("half"), None);
    }

    #[test]
    fn a_device_without_half_floats_is_named() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        assert_eq!(Precision::Full.check(&gpu), Ok(()));
        let can = gpu.device.features().contains(wgpu::Features::SHADER_F16);
        let told = Precision::Half.check(&gpu);
        assert_eq!(told.is_ok(), can);
        if let Err(error) = told {
            let told = error.to_string();
            assert!(told.contains(&gpu.describe()) && told.contains("f32") && !told.contains('\n'), "{told}");
        }
        Ok(())
    }
}
