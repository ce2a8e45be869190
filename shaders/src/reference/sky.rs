//! Mirror of `wgsl/lib/sky.wgsl`, and the coefficients of Preetham's sky.

use glam::DVec3;

use super::math::{PI, mix, saturate, smoothstep};

/// Evaluates the Perez sky function for three quantities.
pub fn perez(coefficients: &[DVec3; 5], cos_theta: f64, cos_gamma: f64) -> DVec3 {
    let c = cos_gamma.clamp(-1.0, 1.0);
    let [a, b, d, e, f] = *coefficients;
    let toward_zenith = DVec3::ONE + a * (b / cos_theta.max(0.01)).exp();
    let toward_sun = DVec3::ONE + d * (e * c.acos()).exp() + f * (c * c);
    toward_zenith * toward_sun
}

/// Converts CIE xyY to linear Rec.709.
pub fn linear_from_xyy(xyy: DVec3) -> DVec3 {
    let scale = xyy.z / xyy.y.max(1e-3);
    let xyz = DVec3::new(xyy.x * scale, xyy.z, (1.0 - xyy.x - xyy.y) * scale);
    DVec3::new(
        xyz.dot(DVec3::new(3.240_454_2, -1.537_138_5, -0.498_531_4)),
        xyz.dot(DVec3::new(-0.969_266_0, 1.876_010_8, 0.041_556_0)),
        xyz.dot(DVec3::new(0.055_643_4, -0.204_025_9, 1.057_225_2)),
    )
    .max(DVec3::ZERO)
}

/// Returns the radiance of the sky without the sun in the unit direction d.
pub fn sky_radiance(coefficients: &[DVec3; 5], zenith: DVec3, ground: DVec3, to_sun: DVec3, d: DVec3) -> DVec3 {
    let sky = linear_from_xyy(zenith * perez(coefficients, d.y, d.dot(to_sun)));
    let t = smoothstep(-0.01, 0.01, d.y);
    DVec3::new(mix(ground.x, sky.x, t), mix(ground.y, sky.y, t), mix(ground.z, sky.z, t))
}

/// Returns the coverage of the unit direction d by the sun disc.
pub fn sun_disc(d: DVec3, to_sun: DVec3, sin_radius: f64) -> f64 {
    if d.dot(to_sun) <= 0.0 {
        return 0.0;
    }
    1.0 - smoothstep(0.9 * sin_radius, sin_radius, d.cross(to_sun).length())
}

/// Returns the relative brightness of the sun disc and its halo in the unit direction d.
pub fn sun_halo(d: DVec3, to_sun: DVec3, versine: f64, per_halo: f64, falloff: f64) -> f64 {
    let left = 1.0 - saturate((0.5 * (d - to_sun).length_squared() - versine) * per_halo);
    if left > 0.0 { left.max(1e-6).powf(falloff) } else { 0.0 }
}

/// Returns the radiance of a disc that lights a surface facing it with `illuminance`.
pub fn sun_disc_radiance(illuminance: DVec3, sin_radius: f64) -> DVec3 {
    illuminance / (PI * (sin_radius * sin_radius).max(1e-12))
}

/// Clear sky after Preetham, Shirley and Smits (1999). It provides the shader's coefficients, and evaluates the sky on
/// the CPU to bake a panorama. CPU only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preetham {
    /// Perez coefficients A…E for (x, y, Y).
    pub perez: [DVec3; 5],
    /// (x, y, Y) at the zenith divided by the Perez function there; Y in nits.
    pub zenith: DVec3,
    /// Radiance below the horizon in nits, linear Rec.709.
    pub ground: DVec3,
    /// Unit vector toward the sun, clamped above the horizon.
    pub to_sun: DVec3,
}

/// Minimum sine of the sun's elevation (2°). The model does not cover night, and its zenith luminance turns negative
/// below this.
const MIN_SUN_SIN: f64 = 0.0349;

impl Preetham {
    /// Computes the sky for a sun in direction `to_sun`, clamped to 2° above the horizon. `turbidity` is 1.7 (mountain)
    /// … 10 (haze); 2.5 is clear. The ground has `albedo` and is lit by the sky and a sun of `sun_illuminance` in lux.
    pub fn new(to_sun: DVec3, turbidity: f64, albedo: DVec3, sun_illuminance: DVec3) -> Self {
        let t = turbidity.clamp(1.7, 10.0);
        let to_sun = above_horizon(to_sun);
        // Table 2 of the paper: each coefficient is linear in turbidity, for x, y and Y.
        let linear = |slope: [f64; 3], base: [f64; 3]| DVec3::from_array(slope) * t + DVec3::from_array(base);
        let perez_coefficients = [
            linear([-0.0193, -0.0167, 0.1787], [-0.2592, -0.2608, -1.4630]),
            linear([-0.0665, -0.0950, -0.3554], [0.0008, 0.0092, 0.4275]),
            linear([-0.0004, -0.0079, -0.0227], [0.2125, 0.2102, 5.3251]),
            linear([-0.0641, -0.0441, 0.1206], [-0.8989, -1.6537, -2.5771]),
            linear([-0.0033, -0.0109, -0.0670], [0.0452, 0.0529, 0.3703]),
        ];
        let theta = to_sun.y.clamp(-1.0, 1.0).acos();
        let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * theta);
        let luminance_knits = (4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192;
        let zenith = DVec3::new(
            zenith_chromaticity(t, theta, &X_ZENITH),
            zenith_chromaticity(t, theta, &Y_ZENITH),
            1000.0 * luminance_knits.max(0.0),
        );
        let sky = Self {
            perez: perez_coefficients,
            zenith: zenith / perez(&perez_coefficients, 1.0, to_sun.y),
            ground: DVec3::ZERO,
            to_sun,
        };
        let lit_by = sky.horizontal_illuminance() + sun_illuminance * to_sun.y;
        Self { ground: albedo * lit_by / PI, ..sky }
    }

    /// Returns the radiance in nits in the unit direction d, without the sun's disc.
    pub fn radiance(&self, d: DVec3) -> DVec3 {
        sky_radiance(&self.perez, self.zenith, self.ground, self.to_sun, d)
    }

    /// Returns the sky's illuminance of level ground in lux, from 64 × 32 points of the hemisphere.
    pub fn horizontal_illuminance(&self) -> DVec3 {
        let (columns, rows) = (64, 32);
        let point = |i: u32| {
            // Equal steps of cos² give all points equal weight: E = π · mean radiance.
            let cos = ((f64::from(i / columns) + 0.5) / f64::from(rows)).sqrt();
            let azimuth = (f64::from(i % columns) + 0.5) / f64::from(columns) * 2.0 * PI;
            let sin = (1.0 - cos * cos).sqrt();
            self.radiance(DVec3::new(sin * azimuth.cos(), cos, sin * azimuth.sin()))
        };
        let sum: DVec3 = (0..columns * rows).map(point).sum();
        sum * (PI / f64::from(columns * rows))
    }
}

fn above_horizon(to_sun: DVec3) -> DVec3 {
    let d = to_sun.try_normalize().unwrap_or(DVec3::Y);
    if d.y >= MIN_SUN_SIN {
        return d;
    }
    let flat = DVec3::new(d.x, 0.0, d.z).try_normalize().unwrap_or(DVec3::X);
    flat * (1.0 - MIN_SUN_SIN * MIN_SUN_SIN).sqrt() + DVec3::Y * MIN_SUN_SIN
}

/// Coefficients with rows turbidity², turbidity, 1 and columns θ³, θ², θ, 1 (appendix A.2 of the paper).
type ZenithMatrix = [[f64; 4]; 3];

const X_ZENITH: ZenithMatrix =
    [[0.00166, -0.00375, 0.00209, 0.0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]];
const Y_ZENITH: ZenithMatrix =
    [[0.00275, -0.00610, 0.00317, 0.0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]];

fn zenith_chromaticity(turbidity: f64, theta: f64, matrix: &ZenithMatrix) -> f64 {
    let row = |r: &[f64; 4]| ((r[0] * theta + r[1]) * theta + r[2]) * theta + r[3];
    (row(&matrix[0]) * turbidity + row(&matrix[1])) * turbidity + row(&matrix[2])
}

#[cfg(test)]
mod tests {
    use super::super::luminance::luminance;
    use super::*;

    fn sky(elevation_degrees: f64, turbidity: f64) -> Preetham {
        let e = elevation_degrees.to_radians();
        let to_sun = DVec3::new(e.cos(), e.sin(), 0.0);
        Preetham::new(to_sun, turbidity, DVec3::splat(0.2), DVec3::splat(1e5))
    }

    #[test]
    fn the_white_point_is_white() {
        let white = linear_from_xyy(DVec3::new(0.312_71, 0.329_02, 1.0));
        assert!((white - DVec3::ONE).abs().max_element() < 2e-3, "{white}");
    }

    #[test]
    fn the_zenith_has_the_luminance_the_paper_gives() {
        // T = 2.5, sun at 45°: 5.92 kilonits.
        let zenith = luminance(sky(45.0, 2.5).radiance(DVec3::Y));
        assert!((zenith - 5920.0).abs() < 30.0, "{zenith}");
    }

    #[test]
    fn a_clear_sky_is_blue_and_gives_ten_to_thirty_kilolux() {
        let sky = sky(60.0, 2.5);
        let up = sky.radiance(DVec3::new(-0.3, 0.9, 0.3).normalize());
        assert!(up.z > up.x, "{up}");
        let lux = luminance(sky.horizontal_illuminance());
        assert!((10e3..30e3).contains(&lux), "{lux}");
    }

    #[test]
    fn every_sky_is_finite_and_not_negative() {
        for elevation in [-90.0, -5.0, 0.0, 1.0, 10.0, 45.0, 90.0] {
            for turbidity in [0.0, 1.7, 2.5, 6.0, 10.0, 99.0] {
                let sky = sky(elevation, turbidity);
                for i in 0..200 {
                    let y = f64::from(i) / 99.5 - 1.0;
                    let r = (1.0 - y * y).max(0.0).sqrt();
                    let (s, c) = (f64::from(i) * 2.4).sin_cos();
                    let l = sky.radiance(DVec3::new(r * c, y, r * s));
                    assert!(l.is_finite() && l.cmpge(DVec3::ZERO).all(), "{elevation} {l}");
                    assert!(l.max_element() < 1e6, "{elevation} {turbidity} {y}: {l}");
                }
            }
        }
    }

    #[test]
    fn the_disc_holds_the_energy_of_the_sun() {
        let radius = 0.00465_f64;
        let radiance = sun_disc_radiance(DVec3::splat(1e5), radius.sin()).x;
        assert!((radiance - 1.47e9).abs() < 0.01e9, "{radiance}");
        assert_eq!(sun_disc(DVec3::X, DVec3::X, radius.sin()), 1.0);
        assert_eq!(sun_disc(DVec3::NEG_X, DVec3::X, radius.sin()), 0.0);
        let beside = DVec3::new(1.0, 0.005, 0.0).normalize();
        assert_eq!(sun_disc(beside, DVec3::X, radius.sin()), 0.0);
    }
}
