//! Extraction of the sun from an environment map.
//!
//! A sun inside a map is difficult to filter. Three bands of spherical harmonics misrepresent 9 % of its irradiance and
//! ring, importance sampling leaves fireflies, and the sun casts no shadow. A directional light avoids all of this.
//!
//! The sun is recognized as small and much brighter than its surroundings. Studio lights and windows of several degrees
//! stay in the map, which represents them well.

use std::fmt;

use glam::DVec3;

use super::definition::Environment;
use super::equirect::EquirectMap;
use crate::color::luminance_from_rec709;
use crate::light::{Light, LightKind};

/// Radius in radians (2.5°) around the brightest texel that is attributed to the sun. It covers the disc and the texels
/// over which cameras and resampling spread it.
const CONE_RAD: f64 = 0.043_633;
/// Radius of that cone in texels of a coarse map, if this is larger.
const CONE_TEXELS: f64 = 2.5;
/// Outer radius of the surroundings, relative to the sun's cone.
const RING: f64 = 2.0;
/// Minimum ratio of the sun to the mean of its surroundings. In measured maps the ratio is 60 to 90 for suns, 6 for a
/// studio light of 4°, and 2 for a sunlit cloud.
const MIN_CONTRAST: f64 = 20.0;

/// Result of extracting the sun.
#[derive(Clone, Debug, PartialEq)]
pub enum SunExtraction {
    /// The sun was removed from the map and is now a light.
    Extracted {
        /// The sun: direction, illuminance, color, angular radius.
        light: Light,
        /// Number of clamped texels.
        texels: usize,
        /// Ratio of the sun to the mean of its surroundings.
        contrast: f64,
    },
    /// The map has no sun: its brightest point is not bright enough relative to its surroundings.
    None {
        /// Ratio of the brightest point to its surroundings.
        contrast: f64,
    },
    /// The sun of the environment was separate already.
    Apart,
    /// The environment has prefiltered light that includes any sun of the map.
    Filtered,
}

impl fmt::Display for SunExtraction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Extracted { light, texels, .. } => {
                let (lux, radius) = match light.kind {
                    LightKind::Directional { illuminance_lux, angular_radius_rad } => {
                        (illuminance_lux, angular_radius_rad)
                    }
                    _ => (0.0, 0.0),
                };
                let toward = -light.direction;
                write!(
                    f,
                    "the sun was taken out of the map: {lux:.4} lx toward {:.3},{:.3},{:.3}, radius {:.2}°, {texels} \
                     texels clamped",
                    toward.x,
                    toward.y,
                    toward.z,
                    radius.to_degrees()
                )
            }
            Self::None { contrast } => {
                write!(
                    f,
                    "the map has no sun: its brightest point is {contrast:.1} times as bright as its surroundings"
                )
            }
            Self::Apart => f.write_str("the sun is separate from the map already"),
            Self::Filtered => f.write_str("the map has prefiltered light that includes its sun"),
        }
    }
}

impl Environment {
    /// Replaces the sun in the map by a directional light; its texels are clamped to the brightest texel of the
    /// surroundings. The light's illuminance is in the map's unit times steradian: lux if the map is in nits.
    ///
    /// The light carries exactly the irradiance that clamping removes from a surface facing it. Its angular radius is
    /// that of a uniform disc with equal concentration. It is at least the size of a texel, so low resolutions
    /// overestimate the real sun's 0.27°.
    ///
    /// Does nothing if the map has no sun, the sun is already separate, or the environment has prefiltered light.
    /// Deterministic.
    pub fn extract_sun(&mut self) -> SunExtraction {
        if self.sun.is_some() {
            return SunExtraction::Apart;
        }
        if self.filtered.is_some() {
            return SunExtraction::Filtered;
        }
        let found = Found::of(&self.map);
        let contrast = found.contrast();
        if contrast < MIN_CONTRAST {
            return SunExtraction::None { contrast };
        }
        let (removed, map) = clamp(&self.map, &found);
        let Some(light) = removed.light() else {
            return SunExtraction::None { contrast };
        };
        self.map = map;
        self.sun = Some(light.clone());
        SunExtraction::Extracted { light, texels: removed.texels, contrast }
    }
}

/// Brightest texel and its surroundings.
struct Found {
    toward: DVec3,
    cos_cone: f64,
    peak: f64,
    ring_mean: f64,
    ring_peak: f64,
}

impl Found {
    fn of(map: &EquirectMap) -> Self {
        let (mut peak, mut toward) = (-1.0, DVec3::Y);
        map.for_each_texel(|direction, _, radiance| {
            let luminance = luminance_from_rec709(radiance);
            if luminance > peak {
                (peak, toward) = (luminance, direction);
            }
        });
        let texel = std::f64::consts::PI / f64::from(map.height());
        let cone = CONE_RAD.max(CONE_TEXELS * texel).min(0.5);
        let (cos_cone, cos_ring) = (cone.cos(), (RING * cone).cos());
        let (mut sum, mut area, mut ring_peak) = (0.0, 0.0, 0.0_f64);
        map.for_each_texel(|direction, solid_angle, radiance| {
            let cos = direction.dot(toward);
            if cos < cos_cone && cos >= cos_ring {
                let luminance = luminance_from_rec709(radiance);
                sum += luminance * solid_angle;
                area += solid_angle;
                ring_peak = ring_peak.max(luminance);
            }
        });
        // In a map too coarse for surroundings, no sun can be recognized.
        let ring_mean = if area > 0.0 { sum / area } else { f64::INFINITY };
        Self { toward, cos_cone, peak, ring_mean, ring_peak }
    }

    /// Returns the ratio of the brightest texel to its surroundings; at most 1e9, for a sun on black.
    fn contrast(&self) -> f64 {
        if self.peak <= 0.0 { 0.0 } else { self.peak / self.ring_mean.max(self.peak * 1e-9) }
    }
}

/// Light removed by clamping.
#[derive(Default)]
struct Removed {
    /// ∫ radiance · direction, one vector per channel.
    vectors: [DVec3; 3],
    luminous: f64,
    luminous2: f64,
    texels: usize,
}

impl Removed {
    fn light(&self) -> Option<Light> {
        let [r, g, b] = self.vectors;
        let along = DVec3::new(
            luminance_from_rec709(DVec3::new(r.x, g.x, b.x)),
            luminance_from_rec709(DVec3::new(r.y, g.y, b.y)),
            luminance_from_rec709(DVec3::new(r.z, g.z, b.z)),
        );
        let toward = along.try_normalize()?;
        let illuminance = DVec3::new(r.dot(toward), g.dot(toward), b.dot(toward)).max(DVec3::ZERO);
        let lux = luminance_from_rec709(illuminance);
        if lux <= 0.0 {
            return None;
        }
        // A uniform disc of solid angle Ω has (∫L)² / ∫L² = Ω.
        let solid_angle = self.luminous * self.luminous / self.luminous2;
        let radius = (1.0 - solid_angle / std::f64::consts::TAU).clamp(-1.0, 1.0).acos();
        Some(Light {
            kind: LightKind::Directional { illuminance_lux: lux as f32, angular_radius_rad: radius as f32 },
            color: (illuminance / lux).as_vec3(),
            ..Light::directional("sun", (-toward).as_vec3(), lux as f32)
        })
    }
}

/// Returns the map without the sun, and the removed light.
fn clamp(map: &EquirectMap, found: &Found) -> (Removed, EquirectMap) {
    let mut texels = map.texels().to_vec();
    let mut removed = Removed::default();
    let mut index = 0;
    map.for_each_texel(|direction, solid_angle, radiance| {
        let luminance = luminance_from_rec709(radiance);
        if luminance > found.ring_peak && direction.dot(found.toward) >= found.cos_cone {
            // Keeps the hue. The texel's rounded value is subtracted, so that light and map add up to the original.
            let left = (radiance * (found.ring_peak / luminance)).as_vec3();
            let taken = radiance - left.as_dvec3();
            for (vector, channel) in removed.vectors.iter_mut().zip(taken.to_array()) {
                *vector += direction * (channel * solid_angle);
            }
            let taken = luminance_from_rec709(taken);
            removed.luminous += taken * solid_angle;
            removed.luminous2 += taken * taken * solid_angle;
            removed.texels += 1;
            texels[index] = [left.x, left.y, left.z, 1.0];
        }
        index += 1;
    });
    (removed, EquirectMap::new(map.width(), map.height(), texels))
}
