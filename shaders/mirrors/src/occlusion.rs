//! Mirror of `wgsl/lib/occlusion.wgsl`.

use glam::DVec3;

use super::math::{mix, saturate, smoothstep};

/// Returns ambient visibility with interreflection.
pub fn gtao_multi_bounce(visibility: f64, albedo: DVec3) -> DVec3 {
    let v = saturate(visibility);
    let bounced = |p: f64| {
        let p = saturate(p);
        let (a, b, c) = (2.0404 * p - 0.3324, 0.6417 - 4.7951 * p, 2.7552 * p + 0.6903);
        (a * v * v * v + b * v * v + c * v).max(v).min(1.0)
    };
    DVec3::from_array(albedo.to_array().map(bounced))
}

/// Returns specular occlusion from ambient occlusion alone.
pub fn specular_occlusion(nov: f64, visibility: f64, alpha: f64) -> f64 {
    let open = (nov + visibility).max(0.0);
    saturate(open.powf((-16.0 * alpha - 1.0).exp2()) - 1.0 + visibility)
}

/// Returns the solid angle of the intersection of two spherical caps, divided by 2π.
pub fn spherical_caps_overlap(cos_cap1: f64, cos_cap2: f64, cos_distance: f64) -> f64 {
    let angle = |c: f64| c.clamp(-1.0, 1.0).acos();
    let (r1, r2, d) = (angle(cos_cap1), angle(cos_cap2), angle(cos_distance));
    let contained = (r1 - r2).abs();
    let x = 1.0 - saturate((d - contained) / (r1 + r2 - contained).max(1e-4));
    (1.0 - cos_cap1.max(cos_cap2)) * x * x * (3.0 - 2.0 * x)
}

/// Returns specular occlusion from a bent normal.
pub fn specular_occlusion_cones(bent_normal: DVec3, r: DVec3, visibility: f64, alpha: f64) -> f64 {
    let cos_open = (1.0 - saturate(visibility)).sqrt();
    let cos_lobe = 10.0_f64.powf(-alpha * alpha);
    let overlap = spherical_caps_overlap(cos_open, cos_lobe, bent_normal.dot(r));
    let occlusion = saturate(overlap / (1.0 - cos_lobe).max(1e-6));
    mix(1.0, occlusion, smoothstep(0.01, 0.09, alpha))
}

/// Returns the share of a reflection that remains below the horizon.
pub fn horizon_occlusion(r: DVec3, normal: DVec3) -> f64 {
    saturate(1.0 + r.dot(normal)).powi(2)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn bounces_brighten_and_stay_in_bounds() {
        for albedo in [-0.5, 0.0, 0.5, 1.0, 2.0, 4.0] {
            for i in 0..=100 {
                let v = f64::from(i) / 100.0;
                let b = gtao_multi_bounce(v, DVec3::splat(albedo)).x;
                assert!(b >= v && b <= 1.0, "{albedo} {v}: {b}");
            }
        }
    }

    #[test]
    fn bounces_are_within_the_known_error_of_a_spherical_cavity() {
        // V/(1 - ρ(1 - V)); accuracy 1.6: RMS 0.077, or 0.211 without bounces.
        let (mut ours, mut ignored, mut n) = (0.0, 0.0, 0);
        for i in 1..=100 {
            for j in 0..100 {
                let (v, p) = (f64::from(i) / 100.0, (f64::from(j) + 0.5) / 100.0);
                let truth = v / (1.0 - p * (1.0 - v));
                ours += (gtao_multi_bounce(v, DVec3::splat(p)).x - truth).powi(2);
                ignored += (v - truth).powi(2);
                n += 1;
            }
        }
        let rms = |sum: f64| (sum / f64::from(n)).sqrt();
        assert!((rms(ours) - 0.077).abs() < 0.01, "{}", rms(ours));
        assert!((rms(ignored) - 0.211).abs() < 0.01, "{}", rms(ignored));
    }

    #[test]
    fn open_points_are_not_occluded_and_closed_ones_are() {
        for alpha in [0.002, 0.1, 1.0] {
            assert_eq!(specular_occlusion(0.5, 1.0, alpha), 1.0);
            assert_eq!(specular_occlusion(0.5, 0.0, alpha), 0.0);
        }
        // For partial occlusion, rough lobes follow the occlusion and smooth lobes ignore it.
        assert!((specular_occlusion(0.5, 0.5, 1.0) - 0.5).abs() < 1e-3);
        assert!((specular_occlusion(0.8, 0.5, 0.002) - 0.637).abs() < 5e-3);
    }

    #[test]
    fn caps_share_nothing_apart_and_the_smaller_when_inside() {
        let (small, large) = (0.3_f64.cos(), 0.8_f64.cos());
        assert_eq!(spherical_caps_overlap(small, large, 2.0_f64.cos()), 0.0);
        let inside = spherical_caps_overlap(small, large, 1.0);
        assert!((inside - (1.0 - small)).abs() < 1e-12);
        // Intermediate overlap against counted points: the smoothstep has an error of about 6 %.
        for d in [0.5_f64, 0.7, 0.9, 1.1] {
            let axis = DVec3::new(d.sin(), 0.0, d.cos());
            let (mut hits, rings, columns) = (0.0, 400, 400);
            for i in 0..rings {
                let z = 1.0 - (1.0 - large) * (f64::from(i) + 0.5) / f64::from(rings);
                let s = (1.0 - z * z).sqrt();
                for j in 0..columns {
                    let (sin, cos) = ((f64::from(j) + 0.5) / f64::from(columns) * 2.0 * PI).sin_cos();
                    hits += f64::from(u8::from(DVec3::new(s * cos, s * sin, z).dot(axis) >= small));
                }
            }
            let truth = hits / f64::from(rings * columns) * (1.0 - large);
            let ours = spherical_caps_overlap(small, large, d.cos());
            assert!((ours - truth).abs() < 0.08 * (1.0 - small), "{d}: {ours} for {truth}");
        }
    }

    #[test]
    fn mirrors_ignore_bent_normals_and_reflections_below_the_horizon_fade() {
        assert_eq!(specular_occlusion_cones(DVec3::Z, DVec3::X, 0.2, 0.005), 1.0);
        let open = specular_occlusion_cones(DVec3::Z, DVec3::Z, 1.0, 0.5);
        assert!((open - 1.0).abs() < 1e-12, "{open}");
        assert_eq!(specular_occlusion_cones(DVec3::Z, DVec3::NEG_Z, 0.1, 0.2), 0.0);
        assert_eq!(horizon_occlusion(DVec3::Z, DVec3::Z), 1.0);
        assert_eq!(horizon_occlusion(DVec3::X, DVec3::Z), 1.0);
        assert_eq!(horizon_occlusion(DVec3::NEG_Z, DVec3::Z), 0.0);
    }
}
