//! Overlap of boxes in the image: depth layers, counted from the nearest.

use glam::{DVec2, DVec3, DVec4};

use super::bounds::Aabb;
use super::camera::Camera;

/// Returns the depth layer of each box, for boxes sorted front to back. Layer 0 has nothing in front. A box is one
/// layer behind the deepest preceding box whose image rectangle intersects its own. Boxes side by side share a layer,
/// and the number of layers is the maximum overlap.
#[must_use]
pub fn layers_from_front(bounds: &[Aabb], camera: &Camera, width_over_height: f64) -> Vec<u8> {
    let rectangles: Vec<Rectangle> = bounds.iter().map(|own| Rectangle::of(own, camera, width_over_height)).collect();
    let mut layers: Vec<u8> = Vec::with_capacity(bounds.len());
    for own in &rectangles {
        let before = rectangles.iter().zip(&layers).filter(|(other, _)| other.meets(own));
        layers.push(before.map(|(_, layer)| layer.saturating_add(1)).max().unwrap_or(0));
    }
    layers
}

/// Number of sample points along each axis of the image in [`shaded_at_points`].
pub const SHADED_POINTS: u32 = 32;

/// Estimates overdraw on a grid of [`SHADED_POINTS`]² image points, the centers of equal cells. Returns the number of
/// points covered by a box. Also returns the total number of times that boxes, drawn in this order, pass the depth test
/// there. The content of a box is assumed at the depth where the ray enters the box, or leaves it if the eye is inside.
#[must_use]
pub fn shaded_at_points<'a>(
    order: impl IntoIterator<Item = &'a Aabb>,
    camera: &Camera,
    width_over_height: f64,
) -> [u32; 2] {
    let side = SHADED_POINTS as usize;
    let view_from_clip = camera.clip_from_view(width_over_height).inverse();
    let ray = |at: usize| {
        let ndc = [at % side, at / side].map(|i| (2 * i + 1) as f64 / side as f64 - 1.0);
        // Depth is reversed: 1 is near.
        let [from, to] = [1.0, 0.5].map(|z| {
            let point = view_from_clip * DVec4::new(ndc[0], ndc[1], z, 1.0);
            camera.world_from_view * (point.truncate() / point.w)
        });
        (camera.eye + from, to - from)
    };
    let rays: Vec<_> = (0..side * side).map(ray).collect();
    let mut nearest = vec![f64::INFINITY; rays.len()];
    let mut shaded = 0;
    // Range of points within the edges of the rectangle.
    let point = |ndc: f64| (ndc * 0.5 + 0.5) * f64::from(SHADED_POINTS) - 0.5;
    let within = |min: f64, max: f64| {
        let first = point(min).ceil().clamp(0.0, side as f64) as usize;
        first..((point(max).floor() + 1.0).clamp(0.0, side as f64) as usize).max(first)
    };
    for bounds in order {
        let own = Rectangle::of(bounds, camera, width_over_height);
        for row in within(own.min.y, own.max.y) {
            for at in within(own.min.x, own.max.x).map(|column| row * side + column) {
                let (from, along) = rays[at];
                let away = away(bounds, from, along).unwrap_or(f64::INFINITY);
                if away < nearest[at] {
                    (nearest[at], shaded) = (away, shaded + 1);
                }
            }
        }
    }
    [nearest.iter().filter(|away| away.is_finite()).count() as u32, shaded]
}

/// Returns the distance along a ray, in lengths of `along`, at which it enters a box, or leaves it if the ray starts
/// inside.
fn away(bounds: &Aabb, from: DVec3, along: DVec3) -> Option<f64> {
    let [a, b] = [bounds.min, bounds.max].map(|side| (side - from) / along);
    let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
    let at = if near > 0.0 { near } else { far };
    (near <= far && at > 0.0).then_some(at)
}

/// Bounding rectangle of a box in the image, in normalized device coordinates.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    min: DVec2,
    max: DVec2,
}

impl Rectangle {
    /// The entire image, for a box around the eye or one that is not finite.
    const ALL: Self = Self { min: DVec2::NEG_INFINITY, max: DVec2::INFINITY };

    fn of(bounds: &Aabb, camera: &Camera, width_over_height: f64) -> Self {
        let clip_from_view = camera.clip_from_view(width_over_height);
        let view_from_world = camera.world_from_view.inverse();
        let mut own = Self { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };
        for corner in bounds.corners() {
            let at = corner - camera.eye;
            let clip = clip_from_view * (view_from_world * at).extend(1.0);
            let ndc = clip.truncate().truncate() / clip.w;
            if !(clip.w > 0.0 && ndc.is_finite()) {
                return Self::ALL;
            }
            own = Self { min: own.min.min(ndc), max: own.max.max(ndc) };
        }
        own
    }

    fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use glam::DVec3;

    fn boxes(centers: &[[f64; 3]]) -> Vec<Aabb> {
        let half = DVec3::splat(0.25);
        centers.iter().map(|c| DVec3::from_array(*c)).map(|c| Aabb { min: c - half, max: c + half }).collect()
    }

    #[test]
    fn what_is_nearer_than_what_was_drawn_before_is_shaded_again() {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, Projection::perspective(1.0, 0.1));
        let camera = camera.expect("a camera");
        let shaded = |centers: &[[f64; 3]]| shaded_at_points(&boxes(centers), &camera, 1.5);
        // The near face, at 1.75, spans 0.25 / 0.956 of half the image height on either side, and two thirds of that
        // horizontally. Cell centers are at odd multiples of 1/32.
        let half = 0.25 / (1.75 * 0.5_f64.tan());
        let within = |half: f64| (0..32).filter(|i| (f64::from(2 * i + 1) / 32.0 - 1.0).abs() <= half).count() as u32;
        let near = within(half) * within(half / 1.5);
        let far = within(0.25 / (2.75 * 0.5_f64.tan())) * within(0.25 / (2.75 * 0.5_f64.tan()) / 1.5);
        let (front, back) = ([0.0, 0.0, -2.0], [0.0, 0.0, -3.0]);
        assert_eq!(shaded(&[front]), [near; 2]);
        assert_eq!(shaded(&[front, back]), [near; 2], "nearest first");
        assert_eq!(shaded(&[back, front]), [near, near + far], "farthest first");
        assert_eq!(
            shaded(&[front, front, [9.0, 0.0, -2.0]]),
            [near; 2],
            "what is as near or outside is not shaded again"
        );
        // A room around the eye is as far away as its walls.
        let all = SHADED_POINTS * SHADED_POINTS;
        let room = Aabb { min: DVec3::splat(-5.0), max: DVec3::splat(5.0) };
        let inner = boxes(&[front])[0];
        assert_eq!(shaded_at_points([&room, &inner], &camera, 1.5), [all, all + near]);
        assert_eq!(shaded_at_points([&inner, &room], &camera, 1.5), [all; 2]);
        // A floor without thickness, seen from above.
        let floor = Aabb { min: DVec3::new(-9.0, -1.0, -9.0), max: DVec3::new(9.0, -1.0, 9.0) };
        let [seen, again] = shaded_at_points([&floor, &inner], &camera, 1.5);
        assert!(seen > all / 4 && again > seen, "{seen} {again}");
    }

    fn layers(centers: &[[f64; 3]]) -> Vec<u8> {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, Projection::perspective(1.0, 0.1));
        layers_from_front(&boxes(centers), &camera.expect("a camera"), 1.5)
    }

    #[test]
    fn what_lies_over_something_is_in_a_layer_before_it() {
        assert_eq!(layers(&[[0.0, 0.0, -2.0], [0.0, 0.0, -3.0], [0.0, 0.0, -4.0]]), [0, 1, 2]);
        assert_eq!(layers(&[[-1.0, 0.0, -2.0], [1.0, 0.0, -3.0], [0.0, 1.0, -4.0]]), [0; 3], "side by side");
        // The third is behind the second only, and the last behind all others.
        let around = [[-0.6, 0.0, -2.0], [0.6, 0.0, -3.0], [0.9, 0.0, -4.0], [0.0, 0.0, -60.0]];
        assert_eq!(layers(&around), [0, 0, 1, 0], "a far one between the near ones is behind none");
        assert_eq!(layers(&[]), [0; 0]);
    }

    /// A box around the eye covers everything, as does one that is not finite.
    #[test]
    fn what_has_no_rectangle_lies_over_everything() {
        assert_eq!(layers(&[[0.1, 0.0, -0.1], [3.0, 0.0, -6.0], [-3.0, 0.0, -6.0]]), [0, 1, 1]);
        assert_eq!(layers(&[[f64::NAN, 0.0, -1.0], [0.0, 0.0, -3.0]]), [0, 1]);
    }
}
