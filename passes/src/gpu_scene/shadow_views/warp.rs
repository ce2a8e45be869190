//! Light-space perspective: a warp of the sun's map that gives near receivers more texels than far ones.
//!
//! Wimmer, Scherzer and Purgathofer, "Light Space Perspective Shadow Maps", 2004, with Filament's choice of the distance of
//! the point of projection. The warp looks up the map (along the part of the camera's direction that is across the light), so
//! a ray of light keeps one w, and depth along it stays linear.

use glam::{DVec2, DVec3, DVec4};

/// Receivers nearer than this to the eye are not worth texels, in meters: Filament's hint.
const NEAR_HINT_M: f64 = 1.0;
/// Nor those farther.
const FAR_HINT_M: f64 = 100.0;
/// Sine of the angle between light and view below which the warp is of no use: a degree.
const LEAST_SINE: f64 = 0.02;

/// What decides whether and how much to warp.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WarpRange {
    /// Of the angle between view and light.
    pub sine: f64,
    /// Distances of the nearest and farthest receiver from the eye's plane.
    pub seen_m: (f64, f64),
    /// Distances between which receivers count.
    pub slice_m: (f64, f64),
    /// The receivers' range up the map.
    pub up_m: (f64, f64),
    /// Where the eye is, across the map.
    pub eye_right_m: f64,
}

/// A perspective that looks up the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Warp {
    /// Distance of the receivers' near end from the point of projection, in meters.
    pub near: f64,
    far: f64,
    right: f64,
    up: f64,
}

impl Warp {
    /// The warp; none where it would not help.
    pub fn new(range: &WarpRange) -> Option<Self> {
        let WarpRange { sine, seen_m: (zn, zf), slice_m: (from, to), up_m: (low, high), eye_right_m } = *range;
        let (depth, seen) = (high - low, zf - zn);
        let hidden = (NEAR_HINT_M - from).max(0.0);
        if !(depth > 0.0 && sine > LEAST_SINE && seen > 0.0 && 3.0 * hidden / seen < 2.0) {
            return None;
        }
        let beyond = (to - FAR_HINT_M).max(0.0);
        let (z0, z1) = (zn, zn + depth * sine);
        let virtual_near = zn.max(from + hidden).max(z0).max(0.0);
        let virtual_far = zf.min(to - beyond).min(z1).max(0.0);
        let general = (z0 + (virtual_near * virtual_far).sqrt()) / sine;
        let near = general.max(hidden / (2.0 - 3.0 * hidden / seen));
        // Near nothing the warp would be singular.
        let usable = near.is_finite() && near > 1e-4 * depth;
        usable.then_some(Self { near, far: near + depth, right: eye_right_m, up: low - near })
    }

    /// A and B of y' = A + B / w.
    fn terms(&self) -> (f64, f64) {
        let depth = self.far - self.near;
        ((self.far + self.near) / depth, -2.0 * self.near * self.far / depth)
    }

    /// Where a point of the light's coordinates comes to.
    pub fn apply(&self, right: f64, up: f64) -> DVec2 {
        let (a, b) = self.terms();
        let w = up - self.up;
        DVec2::new(self.near * (right - self.right) / w, a + b / w)
    }

    /// Rows of x, y and w from the light's axes.
    pub fn rows(&self, right: DVec3, up: DVec3) -> [DVec4; 3] {
        let (a, b) = self.terms();
        let w = up.extend(-self.up);
        [right.extend(-self.right) * self.near, w * a + DVec4::W * b, w]
    }

    /// World size of a texel for w = 1, from the size of a texel in warped coordinates.
    pub fn texel_m(&self, [right, up]: [f64; 2]) -> [f64; 2] {
        let (_, b) = self.terms();
        [right / self.near, up / -b]
    }
}
