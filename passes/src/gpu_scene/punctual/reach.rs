//! The volume that a light can light.

use framegraph_scene::{Aabb, Light, LightKind};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Added to a spot's outer half angle, in radians: the cosine that shaders compare is off by up to 2e-7, which at an angle
/// of 0 is six ten-thousandths of a radian.
const CONE_MARGIN_RAD: f64 = 1e-3;
/// Added to a range, as a share of it and of the distance from the eye: shaders round positions to 2⁻²⁴ of them, and so
/// does the arithmetic on froxels.
const RANGE_MARGIN: f64 = 1e-4;
const DISTANCE_MARGIN: f64 = 1e-5;
/// The longest range in meters; squares of longer ones leave f32.
const LONGEST_M: f64 = 1e15;

/// All places that a light can light lie in this sphere and, of a spot, in the cone too. World axes, about an eye, in
/// meters; wider than the light by what shaders may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reach {
    /// Middle of the sphere, from the eye.
    pub center: DVec3,
    /// Its radius.
    pub radius_m: f64,
    /// A spot's cone.
    pub cone: Option<Cone>,
}

/// Directions about an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cone {
    /// Where the light is, from the eye.
    pub apex: DVec3,
    /// Unit vector.
    pub axis: DVec3,
    /// Angle between axis and side.
    pub half_rad: f64,
}

impl Reach {
    /// Reach of a light seen from `eye` in a scene within `bounds`; none where the light has no end. A spot ends with the
    /// scene.
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

    /// Whether no place of the box is in the sphere. Boxes that are not finite are touched.
    pub fn misses(&self, bounds: &Aabb, eye: DVec3) -> bool {
        let center = self.center + eye;
        let nearest = center.clamp(bounds.min.min(bounds.max), bounds.max.max(bounds.min));
        (nearest - center).length() > self.radius_m
    }
}

/// The least sphere around what of a ball of radius 1 is in a cone from its middle: how far along the axis it is centered,
/// and its radius.
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
