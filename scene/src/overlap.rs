//! What lies over what in a picture: layers of boxes, from the nearest.

use glam::DVec2;

use super::bounds::Aabb;
use super::camera::Camera;

/// For boxes sorted nearest first: in which layer each is, 0 for what nothing lies before. A box is one layer behind the last
/// of those before it whose rectangle in the picture meets its own; so boxes side by side share a layer, and as many layers
/// are needed as lie over one another in one place.
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

/// What a box covers of the picture at most, in normalized device coordinates.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    min: DVec2,
    max: DVec2,
}

impl Rectangle {
    /// All of the picture, for what has no rectangle: a box about the eye, or one that is not finite.
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

    fn layers(centers: &[[f64; 3]]) -> Vec<u8> {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, Projection::perspective(1.0, 0.1));
        layers_from_front(&boxes(centers), &camera.expect("a camera"), 1.5)
    }

    #[test]
    fn what_lies_over_something_is_in_a_layer_before_it() {
        assert_eq!(layers(&[[0.0, 0.0, -2.0], [0.0, 0.0, -3.0], [0.0, 0.0, -4.0]]), [0, 1, 2]);
        assert_eq!(layers(&[[-1.0, 0.0, -2.0], [1.0, 0.0, -3.0], [0.0, 1.0, -4.0]]), [0; 3], "side by side");
        // The third is behind the second alone, and the last behind all of them.
        let around = [[-0.6, 0.0, -2.0], [0.6, 0.0, -3.0], [0.9, 0.0, -4.0], [0.0, 0.0, -60.0]];
        assert_eq!(layers(&around), [0, 0, 1, 0], "a far one between the near ones is behind none");
        assert_eq!(layers(&[]), [0; 0]);
    }

    /// What the eye is in covers everything; what is not finite, too.
    #[test]
    fn what_has_no_rectangle_lies_over_everything() {
        assert_eq!(layers(&[[0.1, 0.0, -0.1], [3.0, 0.0, -6.0], [-3.0, 0.0, -6.0]]), [0, 1, 1]);
        assert_eq!(layers(&[[f64::NAN, 0.0, -1.0], [0.0, 0.0, -3.0]]), [0, 1]);
    }
}
