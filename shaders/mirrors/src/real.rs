//! Mirror of `wgsl/lib/real.wgsl`.

use glam::DVec3;

/// Converts a color to the library's number type, clamped to the range of half floats.
pub fn to_real3(color: DVec3) -> DVec3 {
    color
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_stay_what_they_are() {
        let color = DVec3::new(0.0, -0.5, 65504.0);
        assert_eq!(to_real3(color), color);
    }
}
