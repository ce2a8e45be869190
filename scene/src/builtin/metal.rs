//! Measured reflectance of metals.

use glam::Vec3;

/// A metal, described by its reflectance at normal incidence.
#[derive(Clone, Copy, Debug)]
pub struct Metal {
    /// English name, lower case.
    pub name: &'static str,
    /// Reflectance at normal incidence, linear Rec.709, clamped to 1.
    pub f0: Vec3,
}

const fn metal(name: &'static str, r: f32, g: f32, b: f32) -> Metal {
    Metal { name, f0: Vec3::new(r, g, b) }
}

/// Reflectances of eight metals, integrated over the spectrum from complex refractive indices (Akenine-Möller et al.,
/// "Real-Time Rendering", 4th edition, 2018, table 9.2).
pub const METALS: [Metal; 8] = [
    metal("gold", 1.000, 0.782, 0.344),
    metal("silver", 0.972, 0.960, 0.915),
    metal("copper", 0.955, 0.638, 0.538),
    metal("aluminum", 0.913, 0.922, 0.924),
    metal("brass", 0.910, 0.778, 0.423),
    metal("platinum", 0.673, 0.637, 0.585),
    metal("iron", 0.562, 0.565, 0.578),
    metal("titanium", 0.542, 0.497, 0.449),
];
