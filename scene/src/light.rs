//! Lights in photometric units (KHR_lights_punctual). Pre-exposure is applied at upload.

use glam::{DMat4, DVec3, Vec3};

use super::draw_options::DEFAULT_MASK;

/// Shape of a light's emission, with its strength in the unit of that shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light from a source at infinity, such as the sun.
    Directional {
        /// Illuminance on a surface that faces the light, in lux.
        illuminance_lux: f32,
        /// Angular radius of the source in radians; 0 for a point at infinity.
        angular_radius_rad: f32,
    },
    /// Light from a point, equal in all directions.
    Point {
        /// Luminous intensity in candela.
        intensity_candela: f32,
        /// Distance in meters at which the light fades to zero, above 0; `None` for unlimited range.
        range_m: Option<f32>,
    },
    /// Light from a point within a cone around the light's direction.
    Spot {
        /// Luminous intensity within the inner cone, in candela.
        intensity_candela: f32,
        /// Distance in meters at which the light fades to zero, above 0; `None` for unlimited range.
        range_m: Option<f32>,
        /// Angle from the axis at which the light begins to fade, in radians, below `outer_cone_rad`.
        inner_cone_rad: f32,
        /// Angle from the axis at which the light ends, in radians, at most π/2.
        outer_cone_rad: f32,
    },
}

/// Disc of a directional light and a halo around it, drawn in the background for the scene's sun.
///
/// Corresponds to Filament's `Skybox::Builder::showSun`. The disc has the light's angular radius, or 0.545° if that is
/// 0. Its radiance is 4π times the illuminance per steradian, which is far below the real sun's and fits half floats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunHalo {
    /// Radius of the halo relative to the disc, above 1. Filament: `setSunHaloSize`.
    pub size: f32,
    /// Exponent of the halo's falloff, above 0; larger values make it fade faster. Filament: `setSunHaloFalloff`.
    pub falloff: f32,
}

impl SunHalo {
    /// Filament's defaults.
    pub const FILAMENT: Self = Self { size: 10.0, falloff: 80.0 };
    /// Accepted range of sizes.
    pub const SIZES: [f32; 2] = [1.001, 1000.0];
    /// Accepted range of falloffs.
    pub const FALLOFFS: [f32; 2] = [0.01, 10_000.0];

    /// Radius of the disc in radians for lights without angular radius: 0.545°, Filament's `sunAngularRadius`.
    pub const RADIUS_RAD: f32 = 0.009_51;
}

/// Light of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name, for messages; may be empty.
    pub name: String,
    /// Shape of the emission, and its strength.
    pub kind: LightKind,
    /// Linear Rec.709 color that multiplies the strength per channel. As in KHR_lights_punctual, it is not normalized
    /// to a luminance of 1.
    pub color: Vec3,
    /// Position in meters. Ignored and zero for a directional light.
    pub position: DVec3,
    /// Unit direction in which the light *travels*. Ignored for a point light.
    pub direction: Vec3,
    /// Bit mask of channels: the light affects instances that share a channel ([`DrawOptions`](crate::DrawOptions)).
    /// Filament's `LightManager::setLightChannel`.
    pub channels: u8,
    /// Index in [`Rest::lights`](crate::motion::Rest::lights) if the light is attached to a node.
    /// [`Scene::pose`](crate::Scene::pose) leaves other lights unchanged.
    pub rest: Option<usize>,
    /// Darkness of the light's shadows, from 0 (no shadows) to 1 (fully dark). Unity: `shadowStrength`.
    pub shadow_strength: f32,
    /// Disc and halo of the light in the background; `None` draws neither. Used only for the sun.
    pub halo: Option<SunHalo>,
}

impl Light {
    /// Returns a directional light that travels along `direction` (any length but zero), with this illuminance.
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

    /// Returns the shadow strength, clamped to 0…1; NaN counts as 1.
    #[must_use]
    pub fn held_shadow_strength(&self) -> f32 {
        if self.shadow_strength.is_nan() { 1.0 } else { self.shadow_strength.clamp(0.0, 1.0) }
    }

    /// Returns the direction of a light attached to a node: the node's −Z, independent of its scale. `None` if the
    /// node's z axis has zero length or overflows.
    #[must_use]
    pub fn direction_of_node(world_from_node: &DMat4) -> Option<Vec3> {
        let backward = world_from_node.z_axis.truncate();
        // Dividing by the largest component first avoids squares of 1e-200 or 1e200, which exceed f64.
        let largest = backward.abs().max_element();
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        (-backward / largest).try_normalize().map(|d| d.as_vec3())
    }

    /// Returns false if strength or color is zero; such a light must not change any pixel.
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
