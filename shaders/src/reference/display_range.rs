//! Mirror of `wgsl/lib/display_range.wgsl`.

use super::primaries::LUMINANCE_REC2020;
use glam::DVec3;

/// Colors of the stops, starting 5 stops below 18 % gray.
const COLORS: [[f64; 3]; 16] = [
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.1647],
    [0.0, 0.0, 0.3647],
    [0.0, 0.0, 0.6647],
    [0.0, 0.0, 0.9647],
    [0.0, 0.9255, 0.9255],
    [0.0, 0.5647, 0.0],
    [0.0, 0.7843, 0.0],
    [1.0, 1.0, 0.0],
    [0.905_88, 0.752_94, 0.0],
    [1.0, 0.5647, 0.0],
    [1.0, 0.0, 0.0],
    [0.8392, 0.0, 0.0],
    [1.0, 0.0, 1.0],
    [0.6, 0.3333, 0.7882],
    [1.0, 1.0, 1.0],
];

/// Returns the color of a stop; later stops have the last color.
pub fn display_range_color(index: u32) -> DVec3 {
    DVec3::from_array(COLORS[(index as usize).min(15)])
}

/// Returns the false color for the stop of a Rec.2020 color.
pub fn tone_display_range(color: DVec3) -> DVec3 {
    let y = color.dot(LUMINANCE_REC2020).clamp(1e-10, 65504.0);
    let stop = ((y / 0.18).log2() + 5.0).clamp(0.0, 15.0);
    let index = stop.floor();
    display_range_color(index as u32).lerp(display_range_color(index as u32 + 1), stop - index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_is_cyan_and_each_stop_is_a_color() {
        let at = |stops: f64| tone_display_range(DVec3::splat(0.18 * stops.exp2() * (1.0 + 1e-6)));
        assert!((at(0.0) - DVec3::new(0.0, 0.9255, 0.9255)).length() < 1e-4);
        assert!((at(3.0) - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-4);
        assert!((at(-5.0) - DVec3::ZERO).length() < 1e-4 && (at(-30.0)).length() == 0.0);
        assert_eq!(at(12.0), DVec3::ONE);
    }
}
