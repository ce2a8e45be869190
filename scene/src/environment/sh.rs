//! Irradiance of an environment in spherical harmonics.

use glam::{DVec3, Vec3, Vec4};

use super::equirect::EquirectMap;
use super::sh_basis::{band_of, cosine_over_pi, polynomials, scale};
use super::sh_project;
use super::sh_window::ShWindow;
use crate::color::luminance_from_rec709;

/// How many bands irradiance keeps. Four would equal three: the cosine removes the fourth.
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
    /// Projects a map whose texels are patches of one radiance each: ∫ radiance · Y_lm over the
    /// sphere, in f64. Exact but for the sines of odd frequencies near the poles, which err with the
    /// sixth power of a texel's height; a constant map gives its constant and nothing else, whatever
    /// its size.
    #[must_use]
    pub fn project(map: &EquirectMap, bands: ShBands) -> Self {
        let mut radiance = sh_project::integrate(map, bands.coefficients());
        for (sum, scale) in radiance.iter_mut().zip(scale()) {
            *sum *= scale;
        }
        Self { bands, radiance }
    }

    /// The same with its bands weakened.
    #[must_use]
    pub fn windowed(&self, window: ShWindow) -> Self {
        let bands = self.bands.count();
        let radiance = self.radiance.iter().enumerate();
        Self { bands: self.bands, radiance: radiance.map(|(i, c)| *c * window.factor(band_of(i), bands)).collect() }
    }

    /// Where most light comes from: the unit vector of the luminance's first moment. `None` for light
    /// that comes evenly from all sides.
    #[must_use]
    pub fn dominant_direction(&self) -> Option<DVec3> {
        let moment = |i: usize| luminance_from_rec709(self.radiance[i]);
        // In the order of the polynomials: y, z, x.
        let vector = DVec3::new(moment(3), moment(1), moment(2));
        let even = luminance_from_rec709(self.radiance[0]);
        if vector.length() > 1e-4 * even { vector.try_normalize() } else { None }
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

    /// The harmonics of three bands whose [`irradiance_over_pi`](Self::irradiance_over_pi) this is: what Filament's files hold.
    #[must_use]
    pub fn from_irradiance_over_pi(factors: [[f32; 3]; 9]) -> Self {
        let scale = scale();
        let radiance =
            |(i, factor): (usize, [f32; 3])| Vec3::from(factor).as_dvec3() / (scale[i] * cosine_over_pi(band_of(i)));
        Self { bands: ShBands::Three, radiance: factors.into_iter().enumerate().map(radiance).collect() }
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

    /// The same without the fourth band, whose factors are zero: bands 0 to 2, then 4, as
    /// `irradiance_sh5` of `wgsl/lib/sh.wgsl` takes them. Bands that are not there are zero; w is 0.
    #[must_use]
    pub fn irradiance_coefficients(&self) -> [Vec4; 18] {
        let factors = self.irradiance_over_pi();
        std::array::from_fn(|i| {
            let index = if i < 9 { i } else { i + 7 };
            factors.get(index).map_or(Vec4::ZERO, |c| Vec3::from(*c).extend(0.0))
        })
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
}
