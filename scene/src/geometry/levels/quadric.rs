//! Quadrics: sums of squared distances of positions from planes, and of attributes from their interpolation.

use glam::{DMat3, DVec3};

/// Sum of squared distances from planes: p·Ap + 2 b·p + c (M. Garland, P. Heckbert, "Surface Simplification Using
/// Quadric Error Metrics", SIGGRAPH 1997).
#[derive(Clone, Copy)]
pub(super) struct Quadric {
    a: DMat3,
    b: DVec3,
    c: f64,
}

impl Quadric {
    /// Quadric of no planes.
    pub const NONE: Self = Self { a: DMat3::ZERO, b: DVec3::ZERO, c: 0.0 };

    /// Returns the quadric of the plane through `point` with the unit normal `normal`.
    pub fn of_plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let (n, d) = (normal * weight, -normal.dot(point));
        Self { a: DMat3::from_cols(n * normal.x, n * normal.y, n * normal.z), b: n * d, c: weight * d * d }
    }

    pub fn plus(self, other: Self) -> Self {
        Self { a: self.a + other.a, b: self.b + other.b, c: self.c + other.c }
    }

    /// Returns the sum at `p`; rounding may make it negative.
    pub fn at(&self, p: DVec3) -> f64 {
        p.dot(self.a * p) + 2.0 * self.b.dot(p) + self.c
    }
}

/// Quadric of an attribute that varies linearly over triangles: squared distances by which a value is displaced from
/// its interpolated place.
#[derive(Clone, Copy)]
pub(super) struct Shift {
    /// Sum of weighted gradients; sums of values at the origin and of weights follow.
    gradient: DVec3,
    zero: f64,
    weight: f64,
}

impl Shift {
    /// Quadric of no triangles.
    pub const NONE: Self = Self { gradient: DVec3::ZERO, zero: 0.0, weight: 0.0 };

    /// Returns the quadric of a triangle, and its contribution to the quadric of positions. Gradients below `least` per
    /// meter count as `least`.
    pub fn of_triangle(corners: [DVec3; 3], values: [f64; 3], least: f64) -> (Self, Quadric) {
        let [a, b, c] = corners;
        let (normal, [second, third]) = ((b - a).cross(c - a), [values[1] - values[0], values[2] - values[0]]);
        let scale = 1.0 / normal.length_squared().max(f64::MIN_POSITIVE);
        let gradient = scale * (second * (c - a).cross(normal) + third * normal.cross(b - a));
        let zero = values[0] - gradient.dot(a);
        let weight = 0.5 * normal.length() / (gradient.length_squared() + least * least);
        let g = weight * gradient;
        let quadric = Quadric {
            a: DMat3::from_cols(g * gradient.x, g * gradient.y, g * gradient.z),
            b: g * zero,
            c: weight * zero * zero,
        };
        (Self { gradient: g, zero: weight * zero, weight }, quadric)
    }

    pub fn plus(self, other: Self) -> Self {
        let weight = self.weight + other.weight;
        Self { gradient: self.gradient + other.gradient, zero: self.zero + other.zero, weight }
    }

    /// Returns the sum for `value` at `p`, without the share in the quadric of positions.
    pub fn at(&self, p: DVec3, value: f64) -> f64 {
        value * (self.weight * value - 2.0 * (self.gradient.dot(p) + self.zero))
    }
}
