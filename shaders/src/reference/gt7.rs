//! Mirror of `wgsl/lib/gt7.wgsl`, computed from the curve's original parameters.

use super::primaries::rows;
use glam::{DMat3, DVec3};

fn each(color: DVec3, f: impl Fn(f64) -> f64) -> DVec3 {
    DVec3::from_array(color.to_array().map(f))
}

/// Constants of ST 2084.
const M1: f64 = 2610.0 / 16384.0;
const M2: f64 = 2523.0 / 32.0;
const C1: f64 = 3424.0 / 4096.0;
const C2: f64 = 2413.0 / 128.0;
const C3: f64 = 2392.0 / 128.0;

/// ICtCp cone responses from linear Rec.2020 (ITU-R BT.2100), in 4096ths.
const CONES: DMat3 = rows([1688.0, 2146.0, 262.0], [683.0, 2951.0, 462.0], [99.0, 309.0, 3688.0]);
/// ICtCp from encoded cone responses, in 4096ths.
const ICTCP: DMat3 = rows([2048.0, 2048.0, 0.0], [6610.0, -13613.0, 7003.0], [17933.0, -17390.0, -543.0]);

/// Encodes nits with PQ.
pub fn pq_from_nits(nits: DVec3) -> DVec3 {
    each(nits, |x| {
        let y = (x / 10000.0).max(1e-20).powf(M1);
        ((C1 + C2 * y) / (1.0 + C3 * y)).powf(M2)
    })
}

/// Decodes PQ to nits.
pub fn nits_from_pq(code: DVec3) -> DVec3 {
    each(code, |e| {
        let x = e.max(1e-20).powf(1.0 / M2).min(1.0);
        10000.0 * ((x - C1).max(0.0) / (C2 - C3 * x)).max(1e-20).powf(1.0 / M1)
    })
}

/// Converts Rec.2020 in nits to ICtCp.
pub fn ictcp_from_rec2020(nits: DVec3) -> DVec3 {
    ICTCP / 4096.0 * pq_from_nits(CONES / 4096.0 * nits)
}

/// Converts ICtCp to Rec.2020 in nits.
pub fn rec2020_from_ictcp(ictcp: DVec3) -> DVec3 {
    (CONES / 4096.0).inverse() * nits_from_pq((ICTCP / 4096.0).inverse() * ictcp)
}

/// Peak luminance of the display, in hundreds of nits.
const PEAK: f64 = 2.5;

fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Evaluates the curve of one channel: alpha 0.25, middle 0.538, linear up to 0.444 of the peak, toe strength 1.28.
pub fn gt7_curve(x: f64) -> f64 {
    let (alpha, middle, linear, toe) = (0.25, 0.538, 0.444, 1.28);
    let k = (linear - 1.0) / (alpha - 1.0);
    if x >= linear * PEAK {
        return PEAK * (linear + k) - PEAK * k * f64::exp(linear / k) * f64::exp(-x / (k * PEAK));
    }
    let share = smoothstep(0.0, middle, x);
    (1.0 - share) * middle * (x.max(1e-10) / middle).powf(toe) + share * x
}

/// Tone maps scene light to display light, both in Rec.2020.
pub fn tone_gt7(color: DVec3) -> DVec3 {
    let c = color.clamp(DVec3::ZERO, DVec3::splat(100.0));
    let skewed = each(c, gt7_curve);
    let (before, after) = (ictcp_from_rec2020(c * 100.0), ictcp_from_rec2020(skewed * 100.0));
    let white = ictcp_from_rec2020(DVec3::splat(PEAK * 100.0)).x;
    let chroma = 1.0 - smoothstep(0.98, 1.16, before.x / white);
    let kept = rec2020_from_ictcp(DVec3::new(after.x, before.y * chroma, before.z * chroma)) / 100.0;
    skewed.lerp(kept, 0.6).min(DVec3::splat(PEAK)) / PEAK
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standards_known_values() {
        // ST 2084: 100 nits have the code value 0.508, 10000 nits have 1.
        assert!((pq_from_nits(DVec3::splat(100.0)).x - 0.508_078).abs() < 1e-6);
        assert!((pq_from_nits(DVec3::splat(10000.0)).x - 1.0).abs() < 1e-12);
        for nits in [DVec3::new(1.0, 50.0, 200.0), DVec3::splat(250.0)] {
            assert!((nits_from_pq(pq_from_nits(nits)) - nits).length() < 1e-9);
            assert!((rec2020_from_ictcp(ictcp_from_rec2020(nits)) - nits).length() < 1e-6);
        }
    }

    #[test]
    fn the_curve_has_no_step_and_ends_at_white() {
        let (below, above) = (gt7_curve(1.11 - 1e-9), gt7_curve(1.11));
        assert!((below - above).abs() < 1e-6 && (above - 1.11).abs() < 1e-6, "{below} {above}");
        assert!((tone_gt7(DVec3::splat(50.0)) - 1.0).abs().max_element() < 1e-3);
        let grey = tone_gt7(DVec3::splat(0.5));
        assert!(grey.max_element() - grey.min_element() < 1e-4, "{grey}");
    }
}
