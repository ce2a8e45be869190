//! Mirror of `wgsl/lib/gamut.wgsl`.

use super::primaries::{oklab_from_rec709, rec709_from_oklab};
use glam::DVec3;

/// Tolerance by which a channel may exceed 0…1 before gamut mapping applies.
pub const GAMUT_SLACK: f64 = 0.03;

/// Maps linear Rec.709 into 0…1 within the tolerance. Colors outside move toward a gray at constant OkLab hue.
pub fn map_into_gamut(color: DVec3) -> DVec3 {
    if color.min_element() >= -GAMUT_SLACK && color.max_element() <= 1.0 + GAMUT_SLACK {
        return color;
    }
    let lab = oklab_from_rec709(color);
    let from_middle = lab.x - 0.5;
    let e = 0.5 + from_middle.abs() + 0.05 * lab.y.hypot(lab.z);
    let reach = e - (e * e - 2.0 * from_middle.abs()).max(0.0).sqrt();
    let side = if from_middle == 0.0 { 0.0 } else { from_middle.signum() };
    let grey = DVec3::new(0.5 * (1.0 + side * reach), 0.0, 0.0);
    let (mut inside, mut outside) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (inside + outside);
        let c = rec709_from_oklab(grey.lerp(lab, middle));
        if c.min_element() >= 0.0 && c.max_element() <= 1.0 { inside = middle } else { outside = middle }
    }
    rec709_from_oklab(grey.lerp(lab, inside))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fits_stays_and_what_does_not_keeps_its_hue() {
        for inside in [DVec3::ZERO, DVec3::new(1.02, -0.02, 0.5), DVec3::ONE] {
            assert_eq!(map_into_gamut(inside), inside);
        }
        for outside in
            [DVec3::new(1.6, -0.3, 0.1), DVec3::new(-0.2, 0.7, 0.1), DVec3::new(3.0, 2.0, 1.0), DVec3::splat(7.0)]
        {
            let mapped = map_into_gamut(outside);
            assert!(mapped.min_element() > -1e-6 && mapped.max_element() < 1.0 + 1e-6, "{outside}: {mapped}");
            let (before, after) = (oklab_from_rec709(outside), oklab_from_rec709(mapped));
            let across = before.y * after.z - before.z * after.y;
            assert!(across.abs() < 1e-6, "the hue of {outside} turned: {before} {after}");
            assert!(after.y.hypot(after.z) <= before.y.hypot(before.z) + 1e-9);
        }
    }
}
