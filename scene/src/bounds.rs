//! Axis-aligned bounding boxes, in f64 so that transforming one stays conservative far from the
//! origin.

use glam::{DMat4, DVec3, Vec3};

/// Largest distance from the origin that a scene may reach, in meters: squares of it stay finite in f32.
pub const MAX_COORDINATE_M: f64 = 1e18;

/// An axis-aligned box in meters. Empty when any `min` exceeds its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The smallest coordinates, in meters.
    pub min: DVec3,
    /// The largest coordinates, in meters.
    pub max: DVec3,
}

impl Default for Aabb {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Aabb {
    /// The box that holds nothing: the neutral element of [`union`](Self::union).
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around `points`; empty for none. Non-finite points are the caller's error
    /// (the importer refuses them).
    #[must_use]
    pub fn from_points(points: &[Vec3]) -> Self {
        let mut bounds = Self::EMPTY;
        for point in points {
            bounds = bounds.including(point.as_dvec3());
        }
        bounds
    }

    /// This box grown to hold `point`.
    #[must_use]
    pub fn including(self, point: DVec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether the box holds no point at all. A single point is not empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The middle of the box, in meters; the origin for an empty box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        if self.is_empty() {
            return DVec3::ZERO;
        }
        (self.min + self.max) * 0.5
    }

    /// Half the edge lengths, in meters; zero for an empty box.
    #[must_use]
    pub fn half_extent(&self) -> DVec3 {
        if self.is_empty() {
            return DVec3::ZERO;
        }
        (self.max - self.min) * 0.5
    }

    /// The radius in meters of the sphere around [`center`](Self::center) through the corners.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.half_extent().length()
    }

    /// The eight corners, x varying fastest. Meaningless for an empty box.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            DVec3::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }

    /// The box around this box after an affine transform: center moved, half extent multiplied by
    /// the absolute values of the linear part (Arvo, "Transforming axis-aligned bounding boxes",
    /// Graphics Gems 1990). Conservative, and tight for axis-aligned transforms.
    #[must_use]
    pub fn transformed(&self, to_from_this: &DMat4) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let center = to_from_this.transform_point3(self.center());
        let half = self.half_extent();
        let extent = to_from_this.x_axis.truncate().abs() * half.x
            + to_from_this.y_axis.truncate().abs() * half.y
            + to_from_this.z_axis.truncate().abs() * half.z;
        Self { min: center - extent, max: center + extent }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_is_neutral_and_a_point_is_not_empty() {
        let point = Aabb::from_points(&[Vec3::new(1.0, 2.0, 3.0)]);
        assert!(Aabb::EMPTY.is_empty());
        assert!(!point.is_empty());
        assert_eq!(Aabb::EMPTY.union(point), point);
        assert_eq!(point.radius(), 0.0);
        assert_eq!(Aabb::EMPTY.center(), DVec3::ZERO);
        assert!(Aabb::EMPTY.transformed(&DMat4::IDENTITY).is_empty());
    }

    /// Every corner of the source lies in the transformed box, also under mirroring and shear, and
    /// for a rotation by 90° the box is exact.
    #[test]
    fn transformed_box_holds_every_transformed_corner() {
        let source = Aabb { min: DVec3::new(-1.0, 0.5, 2.0), max: DVec3::new(3.0, 0.75, 9.0) };
        let shear = DMat4::from_cols_array(&[
            1.0, 0.5, -2.0, 0.0, 0.25, -3.0, 0.0, 0.0, 7.0, 1.0, 1.0, 0.0, 1e6, -2e6, 5.0, 1.0,
        ]);
        let target = source.transformed(&shear);
        for corner in source.corners() {
            let moved = shear.transform_point3(corner);
            // One rounding of a coordinate near 2e6 in f64 is below 1e-9.
            assert!(moved.cmpge(target.min - 1e-8).all());
            assert!(moved.cmple(target.max + 1e-8).all());
        }
        let turned = source.transformed(&DMat4::from_rotation_y(std::f64::consts::FRAC_PI_2));
        assert!((turned.half_extent() - DVec3::new(3.5, 0.125, 2.0)).length() < 1e-12);
    }
}
