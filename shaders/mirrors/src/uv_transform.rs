//! Mirror of `wgsl/lib/uv_transform.wgsl`.

use glam::DVec2;

/// Returns offset + (x_axis y_axis) · uv.
pub fn transform_uv(uv: DVec2, x_axis: DVec2, y_axis: DVec2, offset: DVec2) -> DVec2 {
    offset + x_axis * uv.x + y_axis * uv.y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identity_and_offset() {
        let uv = DVec2::new(0.25, 0.75);
        assert_eq!(transform_uv(uv, DVec2::X, DVec2::Y, DVec2::ZERO), uv);
        let swapped = transform_uv(uv, DVec2::Y, DVec2::X, DVec2::ONE);
        assert_eq!(swapped, DVec2::new(1.75, 1.25));
    }
}
