//! Mirror of `wgsl/lib/thin_film.wgsl`, with the constants as published in KHR_materials_iridescence.

use super::math::{PI, pow5, saturate};
use glam::{DMat3, DVec3};

/// Returns the linear Rec.709 response to a spectral wave, from its path in nm and its phase in full turns.
pub fn film_sensitivity(path_nm: f64, turns: DVec3) -> DVec3 {
    let phase = 2.0 * PI * path_nm.min(1e5) * 1e-9;
    let shift = turns * (2.0 * PI);
    let wave = |value: f64, position: f64, variance: f64, shift: f64| {
        let height = value * (2.0 * PI * variance).sqrt();
        height * (position * phase + shift).cos() * (-phase * phase * variance).exp() / 1.0685e-7
    };
    let xyz = DVec3::new(
        wave(5.4856e-13, 1.6810e6, 4.3278e9, shift.x) + wave(9.7470e-14, 2.2399e6, 4.5282e9, shift.x),
        wave(4.4201e-13, 1.7953e6, 9.3046e9, shift.y),
        wave(5.2481e-13, 2.2084e6, 6.6121e9, shift.z),
    );
    // Matrix of the sample code, by columns.
    DMat3::from_cols(
        DVec3::new(3.240_454_2, -0.969_266_0, 0.055_643_4),
        DVec3::new(-1.537_138_5, 1.876_010_8, -0.204_025_9),
        DVec3::new(-0.498_531_4, 0.041_556_0, 1.057_225_2),
    ) * xyz
}

/// Returns the reflectance of a film on a base.
pub fn thin_film_reflectance(cosine: f64, ior: f64, thickness_nm: f64, base_f0: DVec3) -> DVec3 {
    let index = ior.max(1.0);
    let outside = saturate(cosine);
    let inside = (1.0 - (1.0 - outside * outside) / (index * index)).max(0.0).sqrt();
    let schlick = |f0: f64, cosine: f64| f0 + (1.0 - f0) * pow5(1.0 - cosine);
    let between = |a: f64, b: f64| ((a - b) / (a + b)).powi(2);
    let top = schlick(between(index, 1.0), outside);
    let path_nm = 2.0 * index * thickness_nm * inside;
    let channel = |f0: f64| {
        let root = f0.clamp(0.0, f64::from(0.9999_f32)).sqrt();
        let base = (1.0 + root) / (1.0 - root);
        let bottom = schlick(between(base, index), inside);
        let trips = (top * bottom).min(0.9999);
        let returned = (1.0 - top).powi(2) * bottom / (1.0 - trips);
        let turns = if base < index { 1.0 } else { 0.5 };
        (top + returned, returned - (1.0 - top), trips.sqrt(), turns)
    };
    let channels = base_f0.to_array().map(channel);
    let turns = DVec3::from(channels.map(|c| c.3));
    let mut reflectance = DVec3::from(channels.map(|c| c.0));
    for m in 1..=2 {
        let amplitude = DVec3::from(channels.map(|c| c.1 * c.2.powi(m)));
        let trips = f64::from(m);
        reflectance += 2.0 * amplitude * film_sensitivity(trips * path_nm, turns * trips);
    }
    reflectance.clamp(DVec3::ZERO, DVec3::ONE)
}

/// Solves Schlick's approximation for the reflectance at normal incidence.
pub fn f0_from_reflectance(reflectance: DVec3, f90: f64, cosine: f64) -> DVec3 {
    let grazing = pow5(1.0 - cosine).min(f64::from(0.9999_f32));
    ((reflectance - DVec3::splat(f90 * grazing)) / (1.0 - grazing)).clamp(DVec3::ZERO, DVec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies a film with the same index as its base: nothing reflects at the lower interface, so nothing interferes.
    #[test]
    fn a_film_of_the_bases_index_is_the_base() {
        let f0 = 0.04;
        for cosine in [0.1, 0.5, 1.0] {
            let film = thin_film_reflectance(cosine, 1.5, 400.0, DVec3::splat(f0));
            let bare = f0 + (1.0 - f0) * pow5(1.0 - cosine);
            // The lower interface has Schlick's grazing increase of its own, at 41.7° at most: 1e-3 of the incoming
            // light.
            assert!((film - DVec3::splat(bare)).abs().max_element() < 3e-2, "{cosine}: {film} for {bare}");
        }
    }

    #[test]
    fn reflectance_is_solved_for_f0() {
        for cosine in [0.05, 0.3, 1.0] {
            let f0 = DVec3::new(0.02, 0.5, 1.0);
            let reflectance = f0 + (DVec3::splat(0.8) - f0) * pow5(1.0 - cosine);
            assert!((f0_from_reflectance(reflectance, 0.8, cosine) - f0).abs().max_element() < 1e-12);
        }
        assert!(f0_from_reflectance(DVec3::ONE, 1.0, 0.0).is_finite());
    }
}
