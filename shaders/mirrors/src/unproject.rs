//! Mirror of `wgsl/lib/unproject.wgsl`.

use glam::{DVec2, DVec3, DVec4};

/// Coefficients of a projection from view space (x, y, z) to clip space: x' = scale.x·x + slide.x·z + offset.x, z' =
/// depth.x·z + depth.y, w' = depth.z·z + depth.w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Coefficients of z and w in clip space.
    pub depth: DVec4,
    /// Coefficients of view-space x and y in clip-space x and y.
    pub scale: DVec2,
    /// Coefficients of view-space z in clip-space x and y.
    pub slide: DVec2,
    /// Constant terms of clip-space x and y.
    pub offset: DVec2,
}

/// Returns z in view space of a depth.
pub fn view_z(depth: f64, row: DVec4) -> f64 {
    (row.y - depth * row.w) / (depth * row.z - row.x)
}

/// Returns the view-space position of a depth at normalized device coordinates.
pub fn view_position(ndc: DVec2, depth: f64, p: Projection) -> DVec3 {
    let z = view_z(depth, p.depth);
    let w = p.depth.z * z + p.depth.w;
    ((ndc * w - p.slide * z - p.offset) / p.scale).extend(z)
}

/// Returns the normalized device coordinates and depth of a view-space position.
pub fn ndc_from_view(position: DVec3, p: Projection) -> DVec3 {
    let (xy, z) = (position.truncate(), position.z);
    let w = (p.depth.z * z + p.depth.w).max(1e-6);
    (p.scale * xy + p.slide * z + p.offset).extend(p.depth.x * z + p.depth.y) / w
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat4, DVec4};

    /// Verifies the round trip for perspective, orthographic and off-center projections.
    #[test]
    fn positions_come_back() {
        // Reversed depth; rows of z and w as (factor of z, constant).
        let matrix = |scale: [f64; 2], slide: [f64; 2], offset: [f64; 2], depth: [f64; 4]| {
            DMat4::from_cols(
                DVec4::new(scale[0], 0.0, 0.0, 0.0),
                DVec4::new(0.0, scale[1], 0.0, 0.0),
                DVec4::new(slide[0], slide[1], depth[0], depth[2]),
                DVec4::new(offset[0], offset[1], depth[1], depth[3]),
            )
        };
        let none = [0.0; 2];
        let (near, far) = (0.1, 100.0);
        let finite = [near / (far - near), near * far / (far - near), -1.0, 0.0];
        let central = matrix([1.2, 1.8], none, none, finite);
        let infinite = matrix([1.2, 1.8], none, none, [0.0, near, -1.0, 0.0]);
        let aside = matrix([1.2, 1.8], [0.1, -0.2], none, [0.0, near, -1.0, 0.0]);
        let parallel = matrix([0.4, 1.0], none, [-0.2, 0.1], [1.0 / (far - near), far / (far - near), 0.0, 1.0]);
        for m in [central, infinite, parallel, aside] {
            let p = Projection {
                depth: DVec4::new(m.z_axis.z, m.w_axis.z, m.z_axis.w, m.w_axis.w),
                scale: DVec2::new(m.x_axis.x, m.y_axis.y),
                slide: m.z_axis.truncate().truncate(),
                offset: m.w_axis.truncate().truncate(),
            };
            for at in [DVec3::new(0.3, -0.2, -1.0), DVec3::new(-5.0, 7.0, -40.0)] {
                let clip = m * at.extend(1.0);
                let ndc = clip.truncate() / clip.w;
                assert!((ndc_from_view(at, p) - ndc).length() < 1e-12, "{m:?}");
                let back = view_position(ndc.truncate(), ndc.z, p);
                assert!((back - at).length() < 1e-9, "{m:?}: {back} for {at}");
            }
        }
    }
}
