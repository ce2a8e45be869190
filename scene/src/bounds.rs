//! Axis-aligned bounding boxes in f64, so that transformed boxes stay conservative far from the origin.

use glam::{DMat4, DVec3, Vec3};

/// Maximum distance of a scene from the origin, in meters; squares of it stay finite in f32.
pub const MAX_COORDINATE_M: f64 = 1e18;

/// An axis-aligned box in meters. Empty when any `min` exceeds its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Minimum corner, in meters.
    pub min: DVec3,
    /// Maximum corner, in meters.
    pub max: DVec3,
}

impl Default for Aabb {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Aabb {
    /// Empty box: the neutral element of [`union`](Self::union).
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// Returns the smallest box around `points`, or an empty box if there are none. Points must be finite; the importer
    /// rejects others.
    #[must_use]
    pub fn from_points(points: &[Vec3]) -> Self {
        let mut bounds = Self::EMPTY;
        for point in points {
            bounds = bounds.including(point.as_dvec3());
        }
        bounds
    }

    /// Returns this box enlarged to contain `point`.
    #[must_use]
    pub fn including(self, point: DVec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// Returns the smallest box that contains both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns true if the box contains no point. A box of a single point is not empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Returns the center of the box in meters; the origin for an empty box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        if self.is_empty() {
            return DVec3::ZERO;
        }
        (self.min + self.max) * 0.5
    }

    /// Returns half the edge lengths in meters; zero for an empty box.
    #[must_use]
    pub fn half_extent(&self) -> DVec3 {
        if self.is_empty() {
            return DVec3::ZERO;
        }
        (self.max - self.min) * 0.5
    }

    /// Returns the radius in meters of the sphere around [`center`](Self::center) through the corners.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.half_extent().length()
    }

    /// Returns the eight corners, x varying fastest. Meaningless for an empty box.
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

    /// Returns the bounding box of this box after an affine transform. The center is transformed; the half extent is
    /// multiplied by the absolute values of the linear part. Conservative, and tight for axis-aligned transforms (Arvo,
    /// "Transforming axis-aligned bounding boxes", Graphics Gems 1990).
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

    /// The transformed box contains every transformed corner, also under mirroring and shear. For a rotation by 90° it
    /// is exact.
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
