//! Reflectance of a thin film over a base, by summing all internal reflections and integrating over the spectrum.
//!
//! Uses Airy's sum with Fresnel's amplitudes of both polarizations, and the CIE 1931 color matching functions.

use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// Color matching functions x̄, ȳ, z̄ of the CIE 1931 standard observer, from 380 to 780 nm in steps of 10 nm.
const OBSERVER: [[f64; 3]; 41] = [
    [0.0014, 0.0000, 0.0065],
    [0.0042, 0.0001, 0.0201],
    [0.0143, 0.0004, 0.0679],
    [0.0435, 0.0012, 0.2074],
    [0.1344, 0.0040, 0.6456],
    [0.2839, 0.0116, 1.3856],
    [0.3483, 0.0230, 1.7471],
    [0.3362, 0.0380, 1.7721],
    [0.2908, 0.0600, 1.6692],
    [0.1954, 0.0910, 1.2876],
    [0.0956, 0.1390, 0.8130],
    [0.0320, 0.2080, 0.4652],
    [0.0049, 0.3230, 0.2720],
    [0.0093, 0.5030, 0.1582],
    [0.0633, 0.7100, 0.0782],
    [0.1655, 0.8620, 0.0422],
    [0.2904, 0.9540, 0.0203],
    [0.4334, 0.9950, 0.0087],
    [0.5945, 0.9950, 0.0039],
    [0.7621, 0.9520, 0.0021],
    [0.9163, 0.8700, 0.0017],
    [1.0263, 0.7570, 0.0011],
    [1.0622, 0.6310, 0.0008],
    [1.0026, 0.5030, 0.0003],
    [0.8544, 0.3810, 0.0002],
    [0.6424, 0.2650, 0.0000],
    [0.4479, 0.1750, 0.0000],
    [0.2835, 0.1070, 0.0000],
    [0.1649, 0.0610, 0.0000],
    [0.0874, 0.0320, 0.0000],
    [0.0468, 0.0170, 0.0000],
    [0.0227, 0.0082, 0.0000],
    [0.0114, 0.0041, 0.0000],
    [0.0058, 0.0021, 0.0000],
    [0.0029, 0.0010, 0.0000],
    [0.0014, 0.0005, 0.0000],
    [0.0007, 0.0002, 0.0000],
    [0.0003, 0.0001, 0.0000],
    [0.0002, 0.0001, 0.0000],
    [0.0001, 0.0000, 0.0000],
    [0.0000, 0.0000, 0.0000],
];

/// Interpolation steps between two entries of the table.
const STEPS: usize = 5;

/// XYZ to linear Rec.709 (IEC 61966-2-1).
const FROM_XYZ: DMat3 = DMat3::from_cols(
    DVec3::new(3.240_454_2, -0.969_266_0, 0.055_643_4),
    DVec3::new(-1.537_138_5, 1.876_010_8, -0.204_025_9),
    DVec3::new(-0.498_531_4, 0.041_556_0, 1.057_225_2),
);

/// Converts a spectrum in nm to linear Rec.709; a constant spectrum of 1 has luminance 1.
pub fn rec709(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    let (mut sum, mut luminance) = (DVec3::ZERO, 0.0);
    for (row, pair) in OBSERVER.windows(2).enumerate() {
        for step in 0..STEPS {
            let share = step as f64 / STEPS as f64;
            let eye = DVec3::from(pair[0]).lerp(DVec3::from(pair[1]), share);
            sum += eye * spectrum(380.0 + 10.0 * (row as f64 + share));
            luminance += eye.y;
        }
    }
    FROM_XYZ * (sum / luminance)
}

/// Returns the reflectance at one wavelength of a film with index `ior` between air and a base with reflectance
/// `base_f0` in air. Nothing is absorbed.
pub fn at_wavelength(wavelength_nm: f64, cosine: f64, ior: f64, thickness_nm: f64, base_f0: f64) -> f64 {
    let base = (1.0 + base_f0.sqrt()) / (1.0 - base_f0.sqrt());
    let bent = |index: f64| (1.0 - (1.0 - cosine * cosine) / (index * index)).sqrt();
    let (inside, below) = (bent(ior), bent(base));
    // Phase difference of one internal round trip.
    let (sin, cos) = (4.0 * PI * ior * thickness_nm * inside / wavelength_nm).sin_cos();
    let border = |a: f64, b: f64| (a - b) / (a + b);
    let polarizations = [
        [border(cosine, ior * inside), border(ior * inside, base * below)],
        [border(ior * cosine, inside), border(base * inside, ior * below)],
    ];
    let share = |[top, bottom]: [f64; 2]| {
        // |(t + b·e^{iδ}) / (1 + t·b·e^{iδ})|²
        let square = |re: f64, im: f64| re * re + im * im;
        square(top + bottom * cos, bottom * sin) / square(1.0 + top * bottom * cos, top * bottom * sin)
    };
    0.5 * (share(polarizations[0]) + share(polarizations[1]))
}

/// Returns the reflectance of a film as linear Rec.709; a constant spectrum is white.
pub fn reflectance(cosine: f64, ior: f64, thickness_nm: f64, base_f0: f64) -> DVec3 {
    rec709(|wavelength_nm| at_wavelength(wavelength_nm, cosine, ior, thickness_nm, base_f0)) / rec709(|_| 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter-wave film with index √n on glass with index n reflects nothing at that wavelength.
    #[test]
    fn a_quarter_wave_coat_is_dark() {
        let glass = 1.5_f64;
        let f0 = ((glass - 1.0) / (glass + 1.0)).powi(2);
        let index = glass.sqrt();
        let dark = at_wavelength(550.0, 1.0, index, 550.0 / (4.0 * index), f0);
        assert!(dark < 1e-12, "{dark}");
        let bright = at_wavelength(550.0, 1.0, index, 550.0 / (2.0 * index), f0);
        assert!((bright - f0).abs() < 1e-12, "half a wave is not there: {bright}");
    }

    #[test]
    fn a_film_without_thickness_is_fresnels_formula() {
        for (cosine, index) in [(1.0, 1.5), (0.5, 1.5), (0.2, 2.5)] {
            let f0 = f64::powi((index - 1.0) / (index + 1.0), 2);
            let g = (index * index - 1.0 + cosine * cosine).sqrt();
            let a = ((g - cosine) / (g + cosine)).powi(2);
            let b = ((cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0)).powi(2);
            let seen = reflectance(cosine, 1.33, 0.0, f0);
            assert!((seen - DVec3::splat(0.5 * a * (1.0 + b))).abs().max_element() < 1e-9, "{cosine} {index}: {seen}");
        }
    }

    #[test]
    fn an_even_spectrum_has_the_white_of_equal_energy() {
        let white = rec709(|_| 1.0);
        // Four digits of the table, summed up.
        assert!((white - DVec3::new(1.2048, 0.9483, 0.9088)).abs().max_element() < 2e-3, "{white}");
    }
}
