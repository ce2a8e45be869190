//! The part of a box that a camera sees: points on the convex hull of their intersection, in f64.

use framegraph_scene::{Aabb, Camera, Projection};
use glam::{DVec3, DVec4};

/// What a camera sees between two distances: a truncated pyramid, or a box of a parallel projection.
#[derive(Clone, Debug)]
pub(crate) struct Slice {
    /// Near then far; x varies fastest.
    pub corners: [DVec3; 8],
    /// (normal, offset) in world space, at least 0 inside.
    pub planes: [DVec4; 6],
}

/// Corners of a box in the order of [`Aabb::corners`], a face each, around.
const FACES: [[usize; 4]; 6] = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];

/// A camera for a picture of a shape.
#[derive(Clone, Debug)]
pub(crate) struct FitCamera<'a> {
    pub camera: &'a Camera,
    pub width_over_height: f64,
}

impl FitCamera<'_> {
    /// Half the width and height of what is seen: at a distance of 1 m in perspective, anywhere in parallel.
    pub fn half_extent(&self) -> [f64; 2] {
        match self.camera.projection {
            Projection::Perspective { fov_y_rad, .. } => {
                let height = (0.5 * fov_y_rad).tan();
                [height * self.width_over_height, height]
            }
            Projection::Orthographic { half_width_m, half_height_m, .. } => {
                [half_width_m.unwrap_or(half_height_m * self.width_over_height), half_height_m]
            }
        }
    }

    /// Distances of the near plane and, if there is one, the far plane.
    pub fn range_m(&self) -> (f64, Option<f64>) {
        match self.camera.projection {
            Projection::Perspective { near_m, far_m, .. } => (near_m, far_m),
            Projection::Orthographic { near_m, far_m, .. } => (near_m, Some(far_m)),
        }
    }

    pub fn is_perspective(&self) -> bool {
        matches!(self.camera.projection, Projection::Perspective { .. })
    }

    /// Distance ahead of the eye.
    pub fn ahead_m(&self, point: DVec3) -> f64 {
        (point - self.camera.eye).dot(self.camera.forward())
    }

    /// What is seen between two distances.
    pub(crate) fn slice(&self, near_m: f64, far_m: f64) -> Slice {
        let (half, eye, turn) = (self.half_extent(), self.camera.eye, self.camera.world_from_view);
        let corner = |i: usize| {
            let ahead = if i < 4 { near_m } else { far_m };
            let scale = if self.is_perspective() { ahead } else { 1.0 };
            let side = |bit: usize, half: f64| if i & bit == 0 { -half * scale } else { half * scale };
            eye + turn * DVec3::new(side(1, half[0]), side(2, half[1]), -ahead)
        };
        let forward = self.camera.forward();
        let mut planes = [DVec4::ZERO; 6];
        let sides = self.camera.projection.planes(self.width_over_height);
        for (own, plane) in planes.iter_mut().zip(sides.iter().take(4)) {
            let normal = turn * plane.truncate();
            *own = normal.extend(plane.w - normal.dot(eye));
        }
        planes[4] = forward.extend(-forward.dot(eye) - near_m);
        planes[5] = (-forward).extend(forward.dot(eye) + far_m);
        Slice { corners: std::array::from_fn(corner), planes }
    }
}

/// The six planes of a box, at least 0 inside.
fn box_planes(bounds: &Aabb) -> [DVec4; 6] {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    std::array::from_fn(|i| {
        let axis = axes[i / 2];
        if i % 2 == 0 { axis.extend(-bounds.min.dot(axis)) } else { (-axis).extend(bounds.max.dot(axis)) }
    })
}

/// Appends points whose convex hull is the part of `bounds` in `slice` and within `more`; nothing where they do not meet.
/// No two of `more` and a third may meet in a point, as is so for planes along one direction.
pub(crate) fn intersect(bounds: &Aabb, slice: &Slice, more: &[DVec4], points: &mut Vec<DVec3>) {
    if bounds.is_empty() {
        return;
    }
    let of_slice: Vec<DVec4> = slice.planes.iter().chain(more).copied().collect();
    clipped_faces(&bounds.corners(), &of_slice, points);
    let of_box: Vec<DVec4> = box_planes(bounds).iter().chain(more).copied().collect();
    clipped_faces(&slice.corners, &of_box, points);
}

/// Appends points whose convex hull is the part of `bounds` within planes along one direction.
pub(crate) fn clip_box(bounds: &Aabb, planes: &[DVec4], points: &mut Vec<DVec3>) {
    if !bounds.is_empty() {
        clipped_faces(&bounds.corners(), planes, points);
    }
}

fn clipped_faces(corners: &[DVec3; 8], planes: &[DVec4], points: &mut Vec<DVec3>) {
    // Coordinates are rounded: what touches a plane is kept.
    let largest = corners.iter().fold(1.0_f64, |most, c| most.max(c.abs().max_element()));
    let slack = 1e-12 * largest;
    let (mut polygon, mut clipped) = (Vec::with_capacity(16), Vec::with_capacity(16));
    for face in FACES {
        polygon.clear();
        polygon.extend(face.map(|corner| corners[corner]));
        for plane in planes {
            clip_polygon(&polygon, *plane, slack, &mut clipped);
            std::mem::swap(&mut polygon, &mut clipped);
        }
        points.extend(&polygon);
    }
}

/// Sutherland and Hodgman, "Reentrant polygon clipping", 1974, for one plane.
fn clip_polygon(polygon: &[DVec3], plane: DVec4, slack: f64, clipped: &mut Vec<DVec3>) {
    clipped.clear();
    let inside = |p: DVec3| plane.truncate().dot(p) + plane.w + slack;
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (at_a, at_b) = (inside(a), inside(b));
        if at_a >= 0.0 {
            clipped.push(a);
        }
        if (at_a >= 0.0) != (at_b >= 0.0) {
            clipped.push(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of the intersection by brute force: samples of the box that are in the slice lie in the bounds of what is found,
    /// and what is found lies in both.
    #[test]
    fn the_intersection_holds_what_is_in_both() -> Result<(), Box<dyn std::error::Error>> {
        let mut state = 3_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        let mut met = 0;
        for projection in [
            Projection::perspective(0.9, 0.1),
            Projection::Orthographic { half_width_m: None, half_height_m: 2.0, near_m: 0.5, far_m: 9.0 },
        ] {
            let camera = Camera::look_at(DVec3::new(2.0, 3.0, 4.0), DVec3::ZERO, DVec3::Y, projection)?;
            let camera = FitCamera { camera: &camera, width_over_height: 1.5 };
            let slice = camera.slice(1.0, 7.0);
            for _ in 0..60 {
                let center = DVec3::new(random(), random(), random()) * 12.0 - 6.0;
                let half = DVec3::new(random(), random() * random(), random()) * 6.0;
                let bounds = Aabb { min: center - half, max: center + half };
                let mut points = Vec::new();
                intersect(&bounds, &slice, &[], &mut points);
                let found = points.iter().fold(Aabb::EMPTY, |all, p| all.including(*p));
                for point in &points {
                    assert!(slice.planes.iter().all(|p| p.truncate().dot(*point) + p.w > -1e-6), "{point} is not seen");
                    assert!(point.cmpge(bounds.min - 1e-6).all() && point.cmple(bounds.max + 1e-6).all());
                }
                for _ in 0..300 {
                    let p = bounds.min + DVec3::new(random(), random(), random()) * (bounds.max - bounds.min);
                    if slice.planes.iter().all(|plane| plane.truncate().dot(p) + plane.w >= 0.0) {
                        met += 1;
                        let within = p.cmpge(found.min - 1e-6).all() && p.cmple(found.max + 1e-6).all();
                        assert!(within, "{p} is outside of {found:?}");
                    }
                }
            }
        }
        assert!(met > 500, "{met} samples were in both");
        Ok(())
    }
}
