//! Taking the sun out of a map.
//!
//! A sun inside a map is the hardest case for all that filters it: three bands of spherical harmonics
//! err by 9 % of its irradiance and ring, importance sampling leaves fireflies, and it casts no shadow.
//! As a light it has none of these. What makes a sun is that it is small and much brighter than what is
//! around it; lamps and windows of several degrees are left in the map, which shows them well.

use std::fmt;

use glam::DVec3;

use super::definition::Environment;
use super::equirect::EquirectMap;
use crate::color::luminance_from_rec709;
use crate::draw_options::DEFAULT_MASK;
use crate::light::{Light, LightKind};

/// What belongs to the sun lies this close to the brightest texel, in radians (2.5°): its disc and the
/// texels that cameras and resampling spread it over.
const CONE_RAD: f64 = 0.043_633;
/// The same in texels of a coarse map, should that be wider.
const CONE_TEXELS: f64 = 2.5;
/// What surrounds it lies up to this many times as far.
const RING: f64 = 2.0;
/// The sun is this many times brighter than its surroundings are in the mean. On the maps tried, suns
/// are 60 to 90 times brighter, a studio lamp of 4° is 6 times, a sunlit cloud 2 times.
const MIN_CONTRAST: f64 = 20.0;

/// What became of a map's sun.
#[derive(Clone, Debug, PartialEq)]
pub enum SunExtraction {
    /// It is a light now, and no longer in the map.
    Extracted {
        /// The light: direction, illuminance, color, angular radius.
        light: Light,
        /// How many texels were clamped.
        texels: usize,
        /// How many times brighter than its surroundings it was.
        contrast: f64,
    },
    /// The map has none: its brightest point is only this many times brighter than what is around it.
    None {
        /// The contrast found; below it the brightest point counts as part of the scenery.
        contrast: f64,
    },
    /// The environment came with its sun apart.
    Apart,
    /// The environment came with light made of it already, which a sun in the map is part of.
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
                    "the map has no sun: its brightest point is {contrast:.1} times as bright as what is around it"
                )
            }
            Self::Apart => f.write_str("the sun is apart from the map already"),
            Self::Filtered => f.write_str("light was made of the map already, its sun in it"),
        }
    }
}

impl Environment {
    /// Makes the sun of the map a directional light and clamps its texels to the brightest of their
    /// surroundings. The unit of illuminance is the map's times steradian: lux if the map is in nits.
    ///
    /// The light carries exactly the irradiance that the clamping removes from a surface facing it. Its
    /// angular radius is that of a uniform disc as concentrated as what was removed; it cannot be
    /// smaller than a texel shows, so low resolutions overstate the real sun's 0.27°.
    ///
    /// Leaves the environment alone where there is no sun, where it is apart already, and where light was made of the map. Pure arithmetic on the
    /// map: the same map gives the same light.
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

/// The brightest texel and what is around it.
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
        // A map so coarse that there is no ring has no sun that could be told.
        let ring_mean = if area > 0.0 { sum / area } else { f64::INFINITY };
        Self { toward, cos_cone, peak, ring_mean, ring_peak }
    }

    /// How many times brighter than its surroundings; at most 1e9, for a sun in blackness.
    fn contrast(&self) -> f64 {
        if self.peak <= 0.0 { 0.0 } else { self.peak / self.ring_mean.max(self.peak * 1e-9) }
    }
}

/// What clamping took away.
#[derive(Default)]
struct Removed {
    /// ∫ radiance · direction, a vector for each channel.
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
            name: "sun".into(),
            kind: LightKind::Directional { illuminance_lux: lux as f32, angular_radius_rad: radius as f32 },
            color: (illuminance / lux).as_vec3(),
            position: DVec3::ZERO,
            direction: (-toward).as_vec3(),
            channels: DEFAULT_MASK,
            rest: None,
        })
    }
}

/// The map without the sun, and what that took.
fn clamp(map: &EquirectMap, found: &Found) -> (Removed, EquirectMap) {
    let mut texels = map.texels().to_vec();
    let mut removed = Removed::default();
    let mut index = 0;
    map.for_each_texel(|direction, solid_angle, radiance| {
        let luminance = luminance_from_rec709(radiance);
        if luminance > found.ring_peak && direction.dot(found.toward) >= found.cos_cone {
            // The hue stays; a texel is its rounded self, so that light and map add up to what was.
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
