//! Real spherical harmonics up to the fifth band, as polynomials of a unit direction.
//!
//! Y_lm = K_lm · p_lm(x, y, z) with polar axis z and all signs positive; index l² + l + m. Bands 0 to 2 are in the
//! evaluation order of Filament's shaders: 1; y, z, x; xy, yz, 3z²−1, zx, x²−y². Polynomials and factors: Sloan,
//! "Stupid Spherical Harmonics Tricks", 2008, appendix A2.

use std::f64::consts::PI;

use glam::DVec3;

/// Returns the 25 polynomials p_lm of a unit direction.
#[must_use]
pub fn polynomials(d: DVec3) -> [f64; 25] {
    let (x, y, z) = (d.x, d.y, d.z);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    [
        1.0,
        y,
        z,
        x,
        x * y,
        y * z,
        3.0 * zz - 1.0,
        z * x,
        xx - yy,
        y * (3.0 * xx - yy),
        x * y * z,
        y * (5.0 * zz - 1.0),
        z * (5.0 * zz - 3.0),
        x * (5.0 * zz - 1.0),
        z * (xx - yy),
        x * (xx - 3.0 * yy),
        x * y * (xx - yy),
        y * z * (3.0 * xx - yy),
        x * y * (7.0 * zz - 1.0),
        y * z * (7.0 * zz - 3.0),
        zz * (35.0 * zz - 30.0) + 3.0,
        x * z * (7.0 * zz - 3.0),
        (xx - yy) * (7.0 * zz - 1.0),
        x * z * (xx - 3.0 * yy),
        xx * (xx - 3.0 * yy) - yy * (3.0 * xx - yy),
    ]
}

/// Returns the factors K_lm that make the basis orthonormal over the sphere.
#[must_use]
pub fn scale() -> [f64; 25] {
    let k = |square: f64| (square / PI).sqrt();
    [
        0.5 * k(1.0),
        0.5 * k(3.0),
        0.5 * k(3.0),
        0.5 * k(3.0),
        0.5 * k(15.0),
        0.5 * k(15.0),
        0.25 * k(5.0),
        0.5 * k(15.0),
        0.25 * k(15.0),
        0.25 * k(17.5),
        0.5 * k(105.0),
        0.25 * k(10.5),
        0.25 * k(7.0),
        0.25 * k(10.5),
        0.25 * k(105.0),
        0.25 * k(17.5),
        0.75 * k(35.0),
        0.75 * k(17.5),
        0.75 * k(5.0),
        0.75 * k(2.5),
        0.1875 * k(1.0),
        0.75 * k(2.5),
        0.375 * k(5.0),
        0.75 * k(17.5),
        0.1875 * k(35.0),
    ]
}

/// Returns the band l of a coefficient index.
#[must_use]
pub(super) fn band_of(index: usize) -> usize {
    index.isqrt()
}

/// Returns the factor of band `l` under convolution with the clamped cosine, divided by π: 1, 2/3, 1/4, 0, −1/24. The
/// fourth band vanishes (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
/// 2001).
#[must_use]
pub(super) fn cosine_over_pi(l: usize) -> f64 {
    [1.0, 2.0 / 3.0, 0.25, 0.0, -1.0 / 24.0][l]
}
