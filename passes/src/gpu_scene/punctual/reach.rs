//! Volume that a light can reach.

use framegraph_scene::{Aabb, Light, LightKind};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Margin added to a spot light's outer half angle, in radians. The cosine in shaders has an error of up to 2e-7,
/// which at angle 0 is 6e-4 rad.
const CONE_MARGIN_RAD: f64 = 1e-3;
/// Margin added to a range, as a fraction of it and of the distance from the eye. Shaders and froxels round positions
/// to a relative 2⁻²⁴.
const RANGE_MARGIN: f64 = 1e-4;
const DISTANCE_MARGIN: f64 = 1e-5;
/// Maximum range in meters; squares of longer ranges overflow f32.
const LONGEST_M: f64 = 1e15;

/// Bounds of the points that a light can reach: a sphere and, for spot lights, a cone. World axes, relative to an eye,
/// in meters, with margins for rounding in shaders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reach {
    /// Center of the sphere, relative to the eye.
    pub center: DVec3,
    /// Its radius.
    pub radius_m: f64,
    /// Cone of a spot light.
    pub cone: Option<Cone>,
}

/// Directions around an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cone {
    /// Position of the light, relative to the eye.
    pub apex: DVec3,
    /// Unit vector.
    pub axis: DVec3,
    /// Angle between axis and side.
    pub half_rad: f64,
}

impl Reach {
    /// Returns the reach of a light seen from `eye` in a scene within `bounds`; `None` if it is unbounded. A spot
    /// light ends at the bounds of the scene.
    pub fn of(light: &Light, eye: DVec3, bounds: &Aabb) -> Option<Self> {
        let apex = light.position - eye;
        let widened = |range: f64| (range * (1.0 + RANGE_MARGIN) + apex.length() * DISTANCE_MARGIN).min(LONGEST_M);
        match light.kind {
            LightKind::Directional { .. } | LightKind::Point { range_m: None, .. } => None,
            LightKind::Point { range_m: Some(range), .. } => {
                Some(Self { center: apex, radius_m: widened(range.into()), cone: None })
            }
            LightKind::Spot { range_m, outer_cone_rad, .. } => {
                let whole_m = (bounds.center() - light.position).length() + bounds.radius();
                let range_m = widened(range_m.map_or(whole_m, |range| f64::from(range).min(whole_m)));
                let half_rad = f64::from(outer_cone_rad) + CONE_MARGIN_RAD;
                let cone = Cone { apex, axis: light.direction.as_dvec3(), half_rad };
                let (along, radius) = around_sector(half_rad);
                Some(Self {
                    center: apex + cone.axis * (along * range_m),
                    radius_m: radius * range_m,
                    cone: Some(cone),
                })
            }
        }
    }

    /// Returns true if the box is outside the sphere; false for boxes that are not finite.
    pub fn misses(&self, bounds: &Aabb, eye: DVec3) -> bool {
        let center = self.center + eye;
        let nearest = center.clamp(bounds.min.min(bounds.max), bounds.max.max(bounds.min));
        (nearest - center).length() > self.radius_m
    }
}

/// Returns the smallest sphere around the part of a unit ball within a cone from its center: the position of its
/// center along the axis, and its radius.
fn around_sector(half_rad: f64) -> (f64, f64) {
    let (sin, cos) = half_rad.sin_cos();
    if half_rad < FRAC_PI_4 {
        // Through the apex and the rim.
        (0.5 / cos, 0.5 / cos)
    } else if half_rad < FRAC_PI_2 {
        (cos, sin)
    } else {
        (0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_hold_their_sectors_and_touch_them() {
        for half_rad in [0.0_f64, 0.01, 0.5, 0.78, 0.79, 1.2, 1.57, 1.6] {
            let (along, radius) = around_sector(half_rad);
            let rim = (0..=1000).map(|i| half_rad * f64::from(i) / 1000.0).map(|a| (a.cos(), a.sin()));
            let distance = |(x, y): (f64, f64)| (x - along).hypot(y);
            let farthest = rim.chain([(0.0, 0.0)]).map(distance).fold(0.0, f64::max);
            assert!(farthest <= radius + 1e-12 && farthest > radius - 1e-6, "{half_rad}: {farthest} of {radius}");
        }
    }
}
