//! Mirror of `LightUniforms`, and its creation from KHR_lights_punctual.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// A punctual light as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LightUniforms {
    /// Position in m; unused by directional lights.
    pub position: Vec3,
    /// Reciprocal of the squared range, in 1/m²; zero for unlimited range.
    pub inv_range2: f32,
    /// Pre-exposed luminous intensity in candela, or illuminance in lux for directional lights; linear Rec.709.
    pub intensity: Vec3,
    /// Light type: 0 directional, 1 point, 2 spot.
    pub kind: u32,
    /// Unit vector the light travels along; unused by point lights.
    pub direction: Vec3,
    /// Spot lights: 1 / max(cos inner - cos outer, 0.001) of the half angles of the cones.
    pub spot_scale: f32,
    /// Spot lights: -cos outer · `spot_scale`.
    pub spot_offset: f32,
    /// Number of the light's first shadow map, starting at 1; 0 if the light casts no shadows.
    pub shadow_map: u32,
    /// Shadow strength, 0…1; [`LightUniforms::punctual`] sets 1.
    pub shadow_strength: f32,
    /// Light channels in bits 0 to 7.
    pub channels: u32,
}

/// Shape of a punctual light, as in KHR_lights_punctual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Punctual {
    /// Parallel light; its intensity is an illuminance in lux.
    Directional {
        /// Direction of travel; need not be normalized.
        direction: Vec3,
    },
    /// Point light of equal intensity in all directions, in candela.
    Point {
        /// Position in m.
        position: Vec3,
        /// Distance in m at which the light has faded to zero; `None` for unlimited range.
        range_m: Option<f32>,
    },
    /// Spot light: intensity in candela along the axis, fading between two cones.
    Spot {
        /// Position in m.
        position: Vec3,
        /// Direction of travel along the axis; need not be normalized.
        direction: Vec3,
        /// Distance in m at which the light has faded to zero; `None` for unlimited range.
        range_m: Option<f32>,
        /// Half angle of the cone of full intensity, in radians; 0 ≤ inner < outer.
        inner_cone_rad: f32,
        /// Half angle of the cone that bounds the light, in radians; at most π/2.
        outer_cone_rad: f32,
    },
}

/// Error for an invalid light.
#[derive(Clone, Copy, PartialEq, thiserror::Error)]
pub enum LightError {
    /// A position, direction or color is NaN or infinite, or an intensity is negative.
    #[error("light has a {what} of {value}; finite and not negative is needed")]
    Value {
        /// Name of the property.
        what: &'static str,
        /// Invalid value.
        value: f32,
    },
    /// The direction has length zero.
    #[error("light has a direction of length zero")]
    Direction,
    /// The cone angles are out of order or range.
    #[error("spot cone of {inner} to {outer} rad; 0 <= inner <= outer <= pi/2 is needed")]
    Cone {
        /// Inner half angle in radians.
        inner: f32,
        /// Outer half angle in radians.
        outer: f32,
    },
}

impl std::fmt::Debug for LightError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl LightUniforms {
    /// Packs a light. `color` is linear Rec.709, `intensity` is in lux for directional lights and candela for others,
    /// and `exposure` is in 1/nits. They are multiplied here, in f32.
    ///
    /// # Errors
    ///
    /// If a value is not finite, a range is not positive, a direction has zero length, or the cone angles are out of
    /// order.
    pub fn punctual(shape: Punctual, color: Vec3, intensity: f32, exposure: f32) -> Result<Self, LightError> {
        for (what, value) in [("color", color.min_element()), ("intensity", intensity)] {
            finite_positive(what, value, 0.0)?;
        }
        finite_positive("color", color.max_element(), 0.0)?;
        let base = Self { intensity: color * (intensity * exposure), shadow_strength: 1.0, ..Self::zeroed() };
        match shape {
            Punctual::Directional { direction } => Ok(Self { kind: 0, direction: unit(direction)?, ..base }),
            Punctual::Point { position, range_m } => {
                Ok(Self { kind: 1, position: finite(position)?, inv_range2: inv_range2(range_m)?, ..base })
            }
            Punctual::Spot { position, direction, range_m, inner_cone_rad, outer_cone_rad } => {
                let (inner, outer) = (inner_cone_rad, outer_cone_rad);
                if !(0.0 <= inner && inner <= outer && outer <= 1.570_797) {
                    return Err(LightError::Cone { inner, outer });
                }
                // Cosines of small angles are nearly equal, so the difference is computed in f64.
                let (cos_inner, cos_outer) = (f64::from(inner).cos(), f64::from(outer).cos());
                let scale = 1.0 / (cos_inner - cos_outer).max(1e-3);
                Ok(Self {
                    kind: 2,
                    position: finite(position)?,
                    direction: unit(direction)?,
                    inv_range2: inv_range2(range_m)?,
                    spot_scale: scale as f32,
                    spot_offset: (-cos_outer * scale) as f32,
                    ..base
                })
            }
        }
    }
}

fn finite_positive(what: &'static str, value: f32, least: f32) -> Result<(), LightError> {
    if value.is_finite() && value >= least {
        return Ok(());
    }
    Err(LightError::Value { what, value })
}

fn finite(position: Vec3) -> Result<Vec3, LightError> {
    match position.to_array().into_iter().find(|x| !x.is_finite()) {
        Some(value) => Err(LightError::Value { what: "position", value }),
        None => Ok(position),
    }
}

fn unit(direction: Vec3) -> Result<Vec3, LightError> {
    direction.as_dvec3().try_normalize().map(|d| d.as_vec3()).ok_or(LightError::Direction)
}

fn inv_range2(range_m: Option<f32>) -> Result<f32, LightError> {
    let Some(range) = range_m else { return Ok(0.0) };
    finite_positive("range", range, 1e-6)?;
    Ok((1.0 / (f64::from(range) * f64::from(range))) as f32)
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(LightUniforms {
        position,
        inv_range2,
        intensity,
        kind,
        direction,
        spot_scale,
        spot_offset,
        shadow_map,
        shadow_strength,
        channels
    })]
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_shader_mirrors::punctual::spot_attenuation;

    fn spot(inner: f32, outer: f32) -> Result<LightUniforms, LightError> {
        let shape = Punctual::Spot {
            position: Vec3::ZERO,
            direction: Vec3::new(0.0, 0.0, -3.0),
            range_m: None,
            inner_cone_rad: inner,
            outer_cone_rad: outer,
        };
        LightUniforms::punctual(shape, Vec3::ONE, 2.0, 0.5)
    }

    #[test]
    fn a_spot_is_full_inside_and_dark_outside() {
        let light = spot(0.3, 0.6).unwrap();
        let at = |angle: f64| spot_attenuation(angle.cos(), light.spot_scale.into(), light.spot_offset.into());
        assert_eq!((at(0.0), at(0.29)), (1.0, 1.0));
        assert_eq!((at(0.61), at(2.0)), (0.0, 0.0));
        assert!(at(0.45) > 0.0 && at(0.45) < 1.0);
        assert_eq!(light.direction, Vec3::NEG_Z);
        assert_eq!(light.intensity, Vec3::ONE);
    }

    #[test]
    fn equal_and_tiny_cones_stay_finite() {
        for (inner, outer) in [(0.3, 0.3), (0.0, 0.0), (0.0, 0.0087), (0.0, 1.570_796_4)] {
            let light = spot(inner, outer).unwrap();
            assert!(light.spot_scale.is_finite() && light.spot_offset.is_finite());
        }
    }

    #[test]
    fn unusable_lights_are_refused() {
        assert!(matches!(spot(0.6, 0.3), Err(LightError::Cone { .. })));
        assert!(matches!(spot(f32::NAN, 0.3), Err(LightError::Cone { .. })));
        let point = |position, range_m, intensity| {
            let shape = Punctual::Point { position, range_m };
            LightUniforms::punctual(shape, Vec3::ONE, intensity, 1.0)
        };
        assert!(point(Vec3::ZERO, Some(0.0), 1.0).is_err());
        assert!(point(Vec3::ZERO, Some(f32::NAN), 1.0).is_err());
        assert!(point(Vec3::splat(f32::NAN), None, 1.0).is_err());
        assert!(point(Vec3::ZERO, None, -1.0).is_err());
        assert!(point(Vec3::ZERO, None, f32::INFINITY).is_err());
        assert_eq!(point(Vec3::ZERO, Some(2.0), 1.0).unwrap().inv_range2, 0.25);
        let dark = Punctual::Directional { direction: Vec3::ZERO };
        let dark = LightUniforms::punctual(dark, Vec3::ONE, 1.0, 1.0);
        assert_eq!(dark, Err(LightError::Direction));
    }
}
