//! Irradiance of an environment in spherical harmonics.

use glam::{DVec3, Vec3, Vec4};

use super::equirect::EquirectMap;
use super::sh_basis::{band_of, cosine_over_pi, polynomials, scale};
use super::sh_project;
use super::sh_window::ShWindow;
use crate::color::luminance_from_rec709;

/// Number of spherical harmonics bands for irradiance. A fourth band would add nothing, since the cosine lobe has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
    /// Returns the number of bands: 2, 3 or 5.
    #[must_use]
    pub fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
            Self::Five => 5,
        }
    }

    /// Returns the number of coefficients: 4, 9 or 25.
    #[must_use]
    pub fn coefficients(self) -> usize {
        self.count() * self.count()
    }
}

/// Radiance in spherical harmonics: coefficients of the orthonormal real basis, one linear Rec.709 color each.
#[derive(Clone, Debug, PartialEq)]
pub struct Sh {
    bands: ShBands,
    radiance: Vec<DVec3>,
}

impl Sh {
    /// Projects a map with piecewise constant texels: ∫ radiance · Y_lm over the sphere, in f64. Exact except for odd
    /// sine powers near the poles, whose error falls with the sixth power of the texel height. A constant map of any
    /// size yields the constant alone.
    #[must_use]
    pub fn project(map: &EquirectMap, bands: ShBands) -> Self {
        let mut radiance = sh_project::integrate(map, bands.coefficients());
        for (sum, scale) in radiance.iter_mut().zip(scale()) {
            *sum *= scale;
        }
        Self { bands, radiance }
    }

    /// Returns these coefficients attenuated by a window.
    #[must_use]
    pub fn windowed(&self, window: ShWindow) -> Self {
        let bands = self.bands.count();
        let radiance = self.radiance.iter().enumerate();
        Self { bands: self.bands, radiance: radiance.map(|(i, c)| *c * window.factor(band_of(i), bands)).collect() }
    }

    /// Returns the direction of most light: the unit vector of the luminance's first moment. `None` if the light is
    /// uniform.
    #[must_use]
    pub fn dominant_direction(&self) -> Option<DVec3> {
        let moment = |i: usize| luminance_from_rec709(self.radiance[i]);
        // Order of the polynomials: y, z, x.
        let vector = DVec3::new(moment(3), moment(1), moment(2));
        let even = luminance_from_rec709(self.radiance[0]);
        if vector.length() > 1e-4 * even { vector.try_normalize() } else { None }
    }

    /// Creates radiance from orthonormal coefficients, in the order of [`polynomials`].
    ///
    /// # Panics
    ///
    /// If the number of coefficients does not match the bands.
    #[must_use]
    pub fn from_coefficients(bands: ShBands, radiance: Vec<DVec3>) -> Self {
        assert_eq!(radiance.len(), bands.coefficients());
        Self { bands, radiance }
    }

    /// Creates three bands from their [`irradiance_over_pi`](Self::irradiance_over_pi), the form stored in Filament's
    /// files.
    #[must_use]
    pub fn from_irradiance_over_pi(factors: [[f32; 3]; 9]) -> Self {
        let scale = scale();
        let radiance =
            |(i, factor): (usize, [f32; 3])| Vec3::from(factor).as_dvec3() / (scale[i] * cosine_over_pi(band_of(i)));
        Self { bands: ShBands::Three, radiance: factors.into_iter().enumerate().map(radiance).collect() }
    }

    /// Returns the number of bands.
    #[must_use]
    pub fn bands(&self) -> ShBands {
        self.bands
    }

    /// Returns the orthonormal coefficients of radiance.
    #[must_use]
    pub fn radiance_coefficients(&self) -> &[DVec3] {
        &self.radiance
    }

    /// Returns irradiance divided by π as coefficients of unnormalized polynomials. A shader computes `max(Σ cᵢ pᵢ(n),
    /// 0)` and multiplies by the albedo of a Lambertian surface. For constant radiance L the first coefficient is L and
    /// the others are zero.
    ///
    /// With three bands this is Filament's form, radiance · K · {1, 2/3, 1/4} · K. The order of the polynomials is 1;
    /// y, z, x; xy, yz, 3z²−1, zx, x²−y².
    #[must_use]
    pub fn irradiance_over_pi(&self) -> Vec<[f32; 3]> {
        let scale = scale();
        self.radiance
            .iter()
            .enumerate()
            .map(|(i, c)| (*c * (scale[i] * cosine_over_pi(band_of(i)))).as_vec3().to_array())
            .collect()
    }

    /// Returns irradiance divided by π for `irradiance_sh5` in `wgsl/lib/sh.wgsl`: coefficients of bands 0 to 2, then
    /// of band 4. The fourth band is omitted because its coefficients are zero. Missing bands and w are zero.
    #[must_use]
    pub fn irradiance_coefficients(&self) -> [Vec4; 18] {
        let factors = self.irradiance_over_pi();
        std::array::from_fn(|i| {
            let index = if i < 9 { i } else { i + 7 };
            factors.get(index).map_or(Vec4::ZERO, |c| Vec3::from(*c).extend(0.0))
        })
    }

    /// Returns irradiance divided by π for a unit normal, in f64 and not clamped.
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
}
