//! Construction of a tangent from a normal.

use glam::Vec3;

/// Returns a unit vector perpendicular to the unit vector `n`, continuous except at n = −z.
///
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017; the sign avoids a division by zero.
#[must_use]
pub fn tangent_of_normal(n: Vec3) -> Vec3 {
    let sign = 1.0_f32.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tangent_is_a_unit_vector_across_the_normal() {
        for i in 0..2000_u16 {
            let z = f32::from(i) / 999.5 - 1.0;
            let angle = f32::from(i) * 2.4;
            let ring = (1.0 - z * z).max(0.0).sqrt();
            let n = Vec3::new(ring * angle.cos(), ring * angle.sin(), z).normalize();
            let t = tangent_of_normal(n);
            assert!((t.length() - 1.0).abs() < 1e-6, "{n}");
            // Rounding of three products of numbers below 1.
            assert!(t.dot(n).abs() < 1e-6, "{n} {t}");
        }
        for n in [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_Y] {
            assert!(tangent_of_normal(n).dot(n).abs() < 1e-6);
        }
    }
}
