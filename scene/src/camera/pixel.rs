//! World-space size of a pixel.

use super::definition::Camera;
use super::projection::Projection;
use crate::bounds::Aabb;
use glam::{DVec2, DVec3};

/// World-space size of a pixel in a camera's image.
#[derive(Clone, Copy, Debug)]
pub struct PixelSize {
    eye: DVec3,
    forward: DVec3,
    near_m: f64,
    /// Minimum pixel size in meters: for a perspective, at a distance of one meter in the most stretched corner; for a
    /// parallel projection, anywhere.
    least_m: f64,
    is_parallel: bool,
}

impl PixelSize {
    /// Computes the pixel size of an image of `size_px`.
    #[must_use]
    pub fn new(camera: &Camera, size_px: [u32; 2]) -> Self {
        let [width, height] = size_px.map(|side| f64::from(side.max(1)));
        let clip = camera.clip_from_view(width / height);
        // Half the image in world units: at a distance of one meter, or anywhere for a parallel projection.
        let half = DVec2::new(1.0 / clip.x_axis.x, 1.0 / clip.y_axis.y);
        let at_one = 2.0 * (half / DVec2::new(width, height)).min_element();
        let is_parallel = matches!(camera.projection, Projection::Orthographic { .. });
        // Perspective stretches radial lengths in the corners of the image.
        let stretched = if is_parallel { 1.0 } else { (1.0 + half.length_squared()).sqrt() };
        let (forward, near_m) = (camera.forward(), camera.projection.near_m());
        Self { eye: camera.eye, forward, near_m, least_m: at_one / stretched, is_parallel }
    }

    /// Returns a length in meters that covers at most one pixel anywhere in `bounds`, in any direction.
    #[must_use]
    pub fn least_m(&self, bounds: &Aabb) -> f64 {
        if self.is_parallel {
            return self.least_m;
        }
        let to_center = self.forward.dot(bounds.center() - self.eye);
        let nearest = to_center - self.forward.abs().dot(bounds.half_extent());
        self.least_m * nearest.max(self.near_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat4;

    /// Compares with short segments at many positions of a box, projected to the image.
    #[test]
    fn nothing_of_that_length_is_longer_than_a_pixel() {
        let size_px = [320, 180];
        let bounds = Aabb { min: DVec3::new(-2.0, -0.5, -6.0), max: DVec3::new(3.0, 1.0, -3.0) };
        let perspective = Projection::perspective(1.2, 0.1);
        let parallel = Projection::Orthographic { half_width_m: None, half_height_m: 3.0, near_m: 0.1, far_m: 50.0 };
        for projection in [perspective, parallel] {
            let camera =
                Camera::look_at(DVec3::new(0.3, 0.2, 1.0), DVec3::NEG_Z, DVec3::Y, projection).expect("a camera");
            let length = PixelSize::new(&camera, size_px).least_m(&bounds);
            let clip: DMat4 = camera.clip_from_view(320.0 / 180.0) * camera.view_from_world();
            let px = |p: DVec3| clip.project_point3(p).truncate() * DVec2::new(160.0, 90.0);
            let seen = |p: DVec3| clip.project_point3(p).truncate().abs().max_element() <= 1.0;
            let mut longest = 0.0_f64;
            for i in 0..4096_u32 {
                let share = |shift: u32| f64::from(i >> shift & 15) / 15.0;
                let p = bounds.min + (bounds.max - bounds.min) * DVec3::new(share(0), share(4), share(8));
                for way in
                    [DVec3::X, DVec3::Y, DVec3::Z, (p - camera.eye).normalize(), DVec3::new(1.0, 1.0, -1.0).normalize()]
                {
                    let short = 1e-3 * length * way;
                    longest = longest.max(if seen(p) { 1e3 * (px(p + short) - px(p)).length() } else { 0.0 });
                }
            }
            assert!(longest <= 1.001 && longest > 0.6, "{longest}");
        }
    }
}
