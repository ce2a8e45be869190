//! Range of distances of a view's blended surfaces.

use framegraph_scene::{Camera, Renderables};
use glam::Vec4;

/// Returns the scale and offset that map log2 of a distance ahead of the eye in m to −1…1, over the boxes of these
/// instances. The range has a margin, so that no surface lies at its ends.
pub(super) fn blended_range(renderables: &Renderables, blended: &[u32], camera: &Camera) -> Vec4 {
    let forward = camera.forward();
    let nearest = camera.projection.near_m().max(1e-4);
    let (mut near, mut far) = (f64::INFINITY, nearest);
    for number in blended {
        let bounds = renderables.bounds()[*number as usize];
        let middle = (bounds.center() - camera.eye).dot(forward);
        let reach = bounds.half_extent().dot(forward.abs());
        near = near.min((middle - reach) / 1.02);
        far = far.max((middle + reach) * 1.02);
    }
    let near = near.clamp(nearest, far.min(1e6)).log2();
    let length = (far.min(1e6).log2() - near).max(1e-3);
    Vec4::new((2.0 / length) as f32, (-1.0 - 2.0 * near / length) as f32, 0.0, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_scene::{Projection, Scene};
    use glam::DVec3;

    /// The range is finite without blended surfaces, and with one behind the eye.
    #[test]
    fn a_range_of_nothing_is_finite() {
        let projection = Projection::perspective(0.6, 0.1);
        let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, projection).expect("it looks somewhere");
        let range = blended_range(&Renderables::new(&Scene::default()), &[], &camera);
        assert!(range.is_finite() && range.x > 0.0, "{range}");
    }
}
