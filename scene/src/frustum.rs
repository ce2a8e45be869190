//! View frustum culling. Conservative: no visible instance is ever culled.

use glam::{DVec3, DVec4};

use super::bounds::Aabb;
use super::camera::Camera;

/// View frustum as planes in world axes *relative to the eye*, so that coordinates stay small.
#[derive(Clone, Debug)]
pub struct Frustum {
    eye: DVec3,
    planes: Vec<DVec4>,
}

impl Frustum {
    /// Returns the frustum of `camera` for an image of aspect ratio `width_over_height`.
    #[must_use]
    pub fn of_camera(camera: &Camera, width_over_height: f64) -> Self {
        let planes = camera
            .projection
            .planes(width_over_height)
            .into_iter()
            .map(|plane| (camera.world_from_view * plane.truncate()).extend(plane.w))
            .collect();
        Self { eye: camera.eye, planes }
    }

    /// Returns the planes relative to the eye, in world axes: left, right, bottom, top, near, and far if it is finite.
    /// Normals have unit length and point inward.
    #[must_use]
    pub fn planes(&self) -> &[DVec4] {
        &self.planes
    }

    /// Returns true if any part of the box may be visible. `false` is exact: the box lies outside of one plane. `true`
    /// may be wrong for boxes beyond an edge of the frustum. Empty boxes are invisible; boxes with a non-finite side
    /// count as visible.
    #[must_use]
    pub fn may_see(&self, bounds: &Aabb) -> bool {
        if bounds.is_empty() {
            return false;
        }
        let center = bounds.center() - self.eye;
        let half = bounds.half_extent();
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            let nearest = normal.dot(center) + plane.w + normal.abs().dot(half);
            // NaN keeps the box; the tolerance covers rounding of the sums above.
            let slack = 1e-12 * (center.abs().max_element() + half.max_element());
            nearest >= -slack || nearest.is_nan()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;

    fn camera(projection: Projection) -> Camera {
        Camera::look_at(DVec3::new(2.0, 3.0, 4.0), DVec3::new(-1.0, 0.0, 1.0), DVec3::Y, projection)
            .expect("a plain camera")
    }

    /// Brute force: a box is kept if any of its samples projects into the image. Some boxes must be culled, so a test
    /// that keeps everything fails.
    #[test]
    fn nothing_visible_is_culled() {
        let projections = [
            Projection::perspective(0.8, 0.1),
            Projection::Perspective { fov_y_rad: 0.8, near_m: 1.0, far_m: Some(9.0) },
            Projection::Orthographic { half_width_m: None, half_height_m: 1.5, near_m: 0.5, far_m: 6.0 },
        ];
        for projection in projections {
            let camera = camera(projection);
            let frustum = Frustum::of_camera(&camera, 1.5);
            let clip_from_world = camera.clip_from_view(1.5) * camera.view_from_world();
            let (mut culled, mut kept) = (0, 0);
            let mut state = 7_u64;
            let mut random = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 40) as f64 / (1_u64 << 24) as f64
            };
            let mut triple = || DVec3::new(random(), random(), random());
            for _ in 0..4000 {
                let center = (triple() - 0.5) * 30.0 + camera.eye;
                let half = triple();
                let bounds = Aabb { min: center - half, max: center + half };
                let seen = bounds.corners().into_iter().chain([center]).any(|p| {
                    let clip = clip_from_world * p.extend(1.0);
                    clip.w > 0.0
                        && clip.x.abs() <= clip.w
                        && clip.y.abs() <= clip.w
                        && clip.z >= 0.0
                        && clip.z <= clip.w
                });
                let may_see = frustum.may_see(&bounds);
                assert!(may_see || !seen, "{bounds:?} was culled");
                if may_see { kept += 1 } else { culled += 1 }
            }
            assert!(culled > 1000 && kept > 20, "{culled} culled, {kept} kept");
        }
    }

    #[test]
    fn empty_is_unseen_and_unbounded_is_kept() {
        let frustum = Frustum::of_camera(&camera(Projection::perspective(0.8, 0.1)), 1.5);
        assert!(!frustum.may_see(&Aabb::EMPTY));
        let endless = Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        assert!(frustum.may_see(&endless));
    }
}
