//! Irradiance of an environment in spherical harmonics.

use glam::DVec3;

use super::equirect::EquirectMap;
use super::sh_basis::{band_of, cosine_over_pi, polynomials, scale};

/// How many bands irradiance keeps. Four would equal three: the cosine removes the fourth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShBands {
    /// 4 coefficients.
    Two,
    /// 9 coefficients.
    #[default]
    Three,
    /// 25 coefficients, 7 of which are zero for irradiance.
    Five,
}

impl ShBands {
    /// The number of bands: 2, 3 or 5.
    #[must_use]
    pub fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
            Self::Five => 5,
        }
    }

    /// The number of coefficients: 4, 9 or 25.
    #[must_use]
    pub fn coefficients(self) -> usize {
        self.count() * self.count()
    }
}

/// Radiance as coefficients of the orthonormal real basis, one linear Rec.709 color each.
#[derive(Clone, Debug, PartialEq)]
pub struct Sh {
    bands: ShBands,
    radiance: Vec<DVec3>,
}

impl Sh {
    /// Projects a map: for each coefficient the sum over texels of radiance · Y_lm · solid angle, in
    /// f64.
    ///
    /// The sum over solid angles is exact, so a constant map gives its constant and nothing else to
    /// rounding in band 0; higher bands carry the error of sampling each texel at its center, which
    /// falls with the square of the resolution.
    #[must_use]
    pub fn project(map: &EquirectMap, bands: ShBands) -> Self {
        let count = bands.coefficients();
        let scale = scale();
        let mut radiance = vec![DVec3::ZERO; count];
        map.for_each_texel(|direction, solid_angle, texel| {
            let weighted = texel * solid_angle;
            for (sum, polynomial) in radiance.iter_mut().zip(polynomials(direction)) {
                *sum += weighted * polynomial;
            }
        });
        for (sum, scale) in radiance.iter_mut().zip(scale) {
            *sum *= scale;
        }
        Self { bands, radiance }
    }

    /// Radiance given as orthonormal coefficients, in the order of [`polynomials`].
    ///
    /// # Panics
    ///
    /// When their number is not that of the bands.
    #[must_use]
    pub fn from_coefficients(bands: ShBands, radiance: Vec<DVec3>) -> Self {
        assert_eq!(radiance.len(), bands.coefficients());
        Self { bands, radiance }
    }

    /// How many bands there are.
    #[must_use]
    pub fn bands(&self) -> ShBands {
        self.bands
    }

    /// The orthonormal coefficients of radiance.
    #[must_use]
    pub fn radiance_coefficients(&self) -> &[DVec3] {
        &self.radiance
    }

    /// Irradiance divided by π, as factors of the plain polynomials: a shader computes
    /// `max(Σ cᵢ pᵢ(n), 0)` and multiplies with the albedo of a Lambert surface. For a constant
    /// radiance L the first is L and the others are zero.
    ///
    /// With three bands this is the form Filament stores: radiance · K · {1, 2/3, 1/4} · K for 1; y,
    /// z, x; xy, yz, 3z²−1, zx, x²−y².
    #[must_use]
    pub fn irradiance_over_pi(&self) -> Vec<[f32; 3]> {
        let scale = scale();
        self.radiance
            .iter()
            .enumerate()
            .map(|(i, c)| (*c * (scale[i] * cosine_over_pi(band_of(i)))).as_vec3().to_array())
            .collect()
    }

    /// Irradiance divided by π for a unit normal, in f64 and not clamped.
    #[must_use]
    pub fn irradiance_over_pi_at(&self, normal: DVec3) -> DVec3 {
        let scale = scale();
        let polynomials = polynomials(normal);
        self.radiance
            .iter()
            .enumerate()
            .map(|(i, c)| *c * (scale[i] * polynomials[i] * cosine_over_pi(band_of(i))))
            .sum()
    }

    /// The radiance itself, as far as these bands hold it.
    #[must_use]
    pub fn radiance_at(&self, direction: DVec3) -> DVec3 {
        let scale = scale();
        let polynomials = polynomials(direction);
        self.radiance.iter().enumerate().map(|(i, c)| *c * (scale[i] * polynomials[i])).sum()
    }
}
