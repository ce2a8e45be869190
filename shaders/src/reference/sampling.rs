//! Mirror of `wgsl/lib/sampling.wgsl`.

use glam::{DVec2, DVec3};

use super::math::PI;

/// Returns the base-two radical inverse of i.
pub fn radical_inverse(i: u32) -> f64 {
    f64::from(i.reverse_bits()) / 4_294_967_296.0
}

/// Returns point i of `count` of the Hammersley set.
pub fn hammersley(i: u32, count: u32) -> DVec2 {
    DVec2::new((f64::from(i) + 0.5) / f64::from(count), radical_inverse(i))
}

/// Returns a direction in the upper hemisphere with y ≥ 0, uniform in solid angle.
pub fn sample_half_hemisphere(u: DVec2) -> DVec3 {
    let (sin, cos) = (PI * u.y).sin_cos();
    let s = (1.0 - u.x * u.x).max(0.0).sqrt();
    DVec3::new(s * cos, s * sin, u.x)
}

/// Evaluates Smith masking of one direction, G1.
pub fn g1_smith_ggx(nov: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    2.0 * nov / (nov + (a2 + (1.0 - a2) * nov * nov).sqrt()).max(1e-10)
}

/// Samples a half vector from the distribution of normals visible from v.
pub fn sample_visible_normal(v: DVec3, alpha: f64, u: DVec2) -> DVec3 {
    let stretched = DVec3::new(alpha * v.x, alpha * v.y, v.z).normalize();
    let planar2 = stretched.x * stretched.x + stretched.y * stretched.y;
    let t1 = if planar2 > 1e-14 { DVec3::new(-stretched.y, stretched.x, 0.0) / planar2.sqrt() } else { DVec3::X };
    let t2 = stretched.cross(t1);
    let radius = u.x.sqrt();
    let (sin, cos) = (2.0 * PI * u.y).sin_cos();
    let p1 = radius * cos;
    let s = 0.5 * (1.0 + stretched.z);
    let p2 = (1.0 - s) * (1.0 - p1 * p1).sqrt() + s * radius * sin;
    let p3 = (1.0 - p1 * p1 - p2 * p2).max(0.0).sqrt();
    let h = p1 * t1 + p2 * t2 + p3 * stretched;
    DVec3::new(alpha * h.x, alpha * h.y, h.z.max(0.0)).normalize()
}

#[cfg(test)]
mod tests {
    use super::super::ggx::d_ggx;
    use super::*;

    #[test]
    fn points_are_spread_evenly() {
        assert_eq!([0, 1, 2, 3].map(radical_inverse), [0.0, 0.5, 0.25, 0.75]);
        let count = 256;
        let points = (0..count).map(|i| hammersley(i, count));
        // Every dyadic box of area 1/256 contains exactly one point.
        let mut boxes = vec![0; 256];
        for p in points {
            boxes[(p.x * 16.0) as usize * 16 + (p.y * 16.0) as usize] += 1;
        }
        assert!(boxes.iter().all(|n| *n == 1));
    }

    #[test]
    fn sampled_normals_are_visible_unit_vectors() {
        for v in [DVec3::Z, DVec3::new(0.999_999, 0.0, 1e-3), DVec3::new(0.6, -0.5, 0.62)] {
            for i in 0..64 {
                let u = DVec2::new(f64::from(i % 8) / 8.0, f64::from(i / 8) / 8.0);
                let h = sample_visible_normal(v.normalize(), 0.3, u);
                assert!((h.length() - 1.0).abs() < 1e-12 && h.z >= 0.0);
                assert!(v.dot(h) >= -1e-9, "facets that face away are never sampled");
            }
        }
    }

    #[test]
    fn half_of_the_hemisphere_integrates_symmetric_functions() {
        let count = 4096;
        let mean: f64 =
            (0..count).map(|i| sample_half_hemisphere(hammersley(i, count)).x.powi(2)).sum::<f64>() / f64::from(count);
        // The mean of x² over the hemisphere is one third.
        assert!((mean - 1.0 / 3.0).abs() < 1e-3, "{mean}");
    }

    #[test]
    fn visible_normals_have_the_stated_density() {
        // The mean of 1/(G1·D·max(v·h, 0)/nov) over samples with h in a patch is the patch's area.
        let (alpha, v) = (0.4, DVec3::new(0.8, 0.0, 0.6));
        let (mut area, count) = (0.0, 1 << 16);
        for i in 0..count {
            let h = sample_visible_normal(v, alpha, hammersley(i, count));
            if h.z > 0.9 {
                area += v.z / (g1_smith_ggx(v.z, alpha) * d_ggx(h.z, alpha) * v.dot(h));
            }
        }
        area /= f64::from(count);
        assert!((area / (2.0 * PI * 0.1) - 1.0).abs() < 5e-3, "{area}");
    }
}
