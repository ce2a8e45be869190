//! Lights in photometric units (KHR_lights_punctual). Pre-exposure happens where they are uploaded.

use glam::{DMat4, DVec3, Vec3};

use super::draw_options::DEFAULT_MASK;

/// The shape of a light's emission, with its strength in the unit that shape has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light from a source at infinity, such as the sun.
    Directional {
        /// Illuminance on a surface that faces the light, in lux.
        illuminance_lux: f32,
        /// Half the angle the source subtends, in radians; 0 for a point at infinity.
        angular_radius_rad: f32,
    },
    /// Light from a point, the same in every direction.
    Point {
        /// Luminous intensity in candela.
        intensity_candela: f32,
        /// Where the light has faded to nothing, in meters, above 0; `None` never does.
        range_m: Option<f32>,
    },
    /// Light from a point within a cone around the light's direction.
    Spot {
        /// Luminous intensity within the inner cone, in candela.
        intensity_candela: f32,
        /// Where the light has faded to nothing, in meters, above 0; `None` never does.
        range_m: Option<f32>,
        /// From the axis to where the light begins to fade, in radians, below `outer_cone_rad`.
        inner_cone_rad: f32,
        /// From the axis to where the light ends, in radians, at most π/2.
        outer_cone_rad: f32,
    },
}

/// Disc of a directional light with a halo about it, drawn in the background where the light is the sun.
///
/// Filament draws both with `Skybox::Builder::showSun`. The disc has the light's angular radius, or 0.545° where that is 0,
/// and a radiance of 4π times the illuminance per steradian, which is far below the real sun's and fits half floats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunHalo {
    /// Radius of the halo over that of the disc, above 1. Filament: `setSunHaloSize`.
    pub size: f32,
    /// Exponent of the halo's falloff, above 0; larger values make it fade faster. Filament: `setSunHaloFalloff`.
    pub falloff: f32,
}

impl SunHalo {
    /// Filament's defaults.
    pub const FILAMENT: Self = Self { size: 10.0, falloff: 80.0 };
    /// Sizes that are accepted.
    pub const SIZES: [f32; 2] = [1.001, 1000.0];
    /// Falloffs that are accepted.
    pub const FALLOFFS: [f32; 2] = [0.01, 10_000.0];

    /// Radius of the disc in radians where the light has none: 0.545°, Filament's `sunAngularRadius`.
    pub const RADIUS_RAD: f32 = 0.009_51;
}

/// A light of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name, for messages; may be empty.
    pub name: String,
    /// Shape of the emission, with its strength.
    pub kind: LightKind,
    /// Linear Rec.709, multiplies the strength per channel (as in KHR_lights_punctual, it is not
    /// normalised to a luminance of 1).
    pub color: Vec3,
    /// Position in meters. Zero and without meaning for a directional light.
    pub position: DVec3,
    /// The unit direction in which the light *travels*. Without meaning for a point light.
    pub direction: Vec3,
    /// Channels, a bit each: the light lights instances that share one ([`DrawOptions`](crate::DrawOptions)). Filament's
    /// `LightManager::setLightChannel`.
    pub channels: u8,
    /// Place in [`Rest::lights`](crate::motion::Rest::lights) of a light that hangs on a node; `None` for others, which
    /// [`Scene::pose`](crate::Scene::pose) leaves alone.
    pub rest: Option<usize>,
    /// Darkness of the shadows that the light casts, from 0 (none) to 1 (no light of it is left). Unity: `shadowStrength`.
    pub shadow_strength: f32,
    /// Disc and halo of the light in the background; `None` draws neither. Only the sun's is drawn.
    pub halo: Option<SunHalo>,
}

impl Light {
    /// A sun: parallel light traveling along `direction` (any length but zero), of this illuminance.
    #[must_use]
    pub fn directional(name: &str, direction: Vec3, illuminance_lux: f32) -> Self {
        Self {
            name: name.into(),
            kind: LightKind::Directional { illuminance_lux, angular_radius_rad: 0.0 },
            color: Vec3::ONE,
            position: DVec3::ZERO,
            direction: direction.normalize_or(Vec3::NEG_Y),
            channels: DEFAULT_MASK,
            rest: None,
            shadow_strength: 1.0,
            halo: None,
        }
    }

    /// The shadow strength, held within 0…1; one that is no number counts as 1.
    #[must_use]
    pub fn held_shadow_strength(&self) -> f32 {
        if self.shadow_strength.is_nan() { 1.0 } else { self.shadow_strength.clamp(0.0, 1.0) }
    }

    /// The direction in which light attached to a node travels: the node's −Z, whatever its scale.
    /// `None` when the node's z axis has no length or overflows.
    #[must_use]
    pub fn direction_of_node(world_from_node: &DMat4) -> Option<Vec3> {
        let backward = world_from_node.z_axis.truncate();
        // Divide by the largest component first: squares of 1e-200 or 1e200 leave f64.
        let largest = backward.abs().max_element();
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        (-backward / largest).try_normalize().map(|d| d.as_vec3())
    }

    /// Whether the light can add anything: a light of zero strength or color must not change a
    /// pixel.
    #[must_use]
    pub fn is_on(&self) -> bool {
        let strength = match self.kind {
            LightKind::Directional { illuminance_lux, .. } => illuminance_lux,
            LightKind::Point { intensity_candela, .. } | LightKind::Spot { intensity_candela, .. } => intensity_candela,
        };
        strength > 0.0 && self.color.max_element() > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn node_direction_ignores_scale_and_refuses_flat_nodes() {
        let tiny = DMat4::from_scale(DVec3::splat(1e-200));
        assert_eq!(Light::direction_of_node(&tiny), Some(Vec3::NEG_Z));
        let huge = DMat4::from_scale(DVec3::splat(1e200));
        assert_eq!(Light::direction_of_node(&huge), Some(Vec3::NEG_Z));
        let flat = DMat4::from_scale(DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(Light::direction_of_node(&flat), None);
    }

    #[test]
    fn a_light_without_strength_or_color_is_off() {
        let mut light = Light::directional("sun", Vec3::NEG_Y, 0.0);
        assert!(!light.is_on());
        light.kind = LightKind::Point { intensity_candela: 1.0, range_m: None };
        assert!(light.is_on());
        light.color = Vec3::ZERO;
        assert!(!light.is_on());
    }
}
