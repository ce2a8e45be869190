//! The sun's maps: one for each range of distances from the camera, fitted to what receives shadows there.
//!
//! Receivers are what the cameras see, cut to where something casts. Casters are whatever lies between those and the sun,
//! before the cameras' near planes and beside their pictures too; the depth range reaches to the nearest of them. Everything
//! is in world coordinates and double precision.

use super::atlas::Place;
use super::fitted::Fitted;
use super::settings::{Fit, ShadowSettings};
use super::splits::far_ends;
use super::volume::{FitCamera, clip_box, intersect};
use super::warp::{Warp, WarpRange};
use framegraph_scene::{Aabb, DrawLists, Renderables};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// The smallest extent of a map in meters: an empty or flat scene still gives a finite matrix.
const MIN_EXTENT_M: f64 = 1e-3;
/// Boxes that are cut one by one; of more, the box around them is.
const MAX_BOXES: usize = 256;

/// Unit axes of the light: across the map, up it, toward the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightAxes(pub [DVec3; 3]);

impl LightAxes {
    /// With `along` pointing up the map where it is not parallel to the light; else by an axis of the world.
    pub fn new(toward: DVec3, along: Option<DVec3>) -> Self {
        let across =
            |v: DVec3| (v - toward * toward.dot(v)).try_normalize().filter(|_| toward.cross(v).length() > 0.02);
        // Any axis that is not parallel to the light does; the choice only turns the map (hard case 40).
        let world = if toward.y.abs() > 0.99 { DVec3::Z } else { DVec3::Y };
        let up = along.and_then(across).or_else(|| across(world)).unwrap_or(DVec3::Y);
        Self([up.cross(toward).normalize(), up, toward])
    }

    fn of(&self, point: DVec3) -> DVec3 {
        DVec3::from_array(self.0.map(|axis| axis.dot(point)))
    }

    pub fn bounds(&self, points: impl IntoIterator<Item = DVec3>) -> Aabb {
        points.into_iter().fold(Aabb::EMPTY, |all, point| all.including(self.of(point)))
    }

    /// What a box takes along each axis: its middle, and its half sizes as far as they lie along it.
    fn of_box(&self, bounds: &Aabb) -> Aabb {
        if bounds.is_empty() {
            return Aabb::EMPTY;
        }
        let (middle, half) = (self.of(bounds.center()), bounds.half_extent());
        let half = DVec3::from_array(self.0.map(|axis| axis.abs().dot(half)));
        Aabb { min: middle - half, max: middle + half }
    }

    /// Planes around a rectangle of the map, without ends.
    fn prism(&self, bounds: &Aabb) -> [DVec4; 4] {
        let [right, up, _] = self.0;
        [
            right.extend(-bounds.min.x),
            (-right).extend(bounds.max.x),
            up.extend(-bounds.min.y),
            (-up).extend(bounds.max.y),
        ]
    }
}

/// What the sun's maps are fitted to.
pub(crate) struct SunScene<'a> {
    scene: &'a Renderables,
    cameras: &'a [FitCamera<'a>],
    /// Toward the sun.
    toward: DVec3,
    settings: &'a ShadowSettings,
    /// Instances that cast nothing although they leave depth, by number.
    left_out: Vec<u32>,
    bounds: Aabb,
}

/// The fitted maps, and where each ends.
pub(crate) struct SunMaps {
    pub maps: Vec<Fitted>,
    /// Far ends of the cascades, in meters ahead of the eye.
    pub far_ends: Vec<f64>,
    /// Within so many meters the cascades' receivers lie.
    pub far_m: f64,
}

impl<'a> SunScene<'a> {
    pub fn new(
        scene: &'a Renderables,
        cameras: &'a [FitCamera<'a>],
        toward: DVec3,
        settings: &'a ShadowSettings,
    ) -> Self {
        let toward = toward.try_normalize().unwrap_or(DVec3::Y);
        let left_out: Vec<u32> =
            scene.flat().iter().filter(|flat| !has_behind(scene, toward, **flat)).map(|f| f.0).collect();
        let flat =
            scene.flat().iter().map(|(number, _)| *number).filter(|number| left_out.binary_search(number).is_err());
        let cast = flat.fold(scene.solid_casters(), |all, number| all.union(scene.bounds()[number as usize]));
        let bounds = shadowed(scene.whole(), cast, toward);
        Self { scene, cameras, toward, settings, left_out, bounds }
    }

    /// Whether an instance can shadow another or itself.
    fn casts(&self, number: u32) -> bool {
        self.scene.casts()[number as usize]
            && (self.left_out.is_empty() || self.left_out.binary_search(&number).is_err())
    }

    /// What all that casts takes along the light's axes.
    pub(crate) fn cast(&self, axes: &LightAxes) -> Aabb {
        let mut all = Aabb::EMPTY;
        for (first, row, around) in self.scene.rows() {
            // Rows that change nothing are most.
            if all.union(axes.of_box(around)) != all {
                let casting = (first..).zip(row).filter(|(number, _)| self.casts(*number));
                all = casting.fold(all, |all, (_, bounds)| all.union(axes.of_box(bounds)));
            }
        }
        all
    }

    /// Instances that reach into half spaces of the world.
    fn reaching(&self, planes: &[DVec4]) -> Vec<u32> {
        let mut found = Vec::new();
        self.scene.boxes().reaching(DVec3::ZERO, planes, None, &mut found);
        found
    }

    /// Fits as many maps as the settings have cascades.
    pub fn fit(&self) -> SunMaps {
        let stable = self.settings.fit == Fit::Stable;
        let along = if stable { None } else { self.cameras.first().map(|c| c.camera.forward()) };
        let axes = LightAxes::new(self.toward, along);
        let cast = self.cast(&axes);
        let (near_m, far_m) = if stable { self.whole_range() } else { self.seen_range(&axes, &cast) };
        let far_ends = far_ends(self.settings.splits, self.settings.cascades.into(), near_m, far_m);
        let mut from = near_m;
        let mut maps = Vec::with_capacity(far_ends.len());
        for &to in &far_ends {
            let map = if stable { self.stable(&axes, from, to) } else { self.tight(&axes, &cast, from, to) };
            let place = Place::whole(maps.len() as u16, self.settings.map_texels);
            maps.push(Fitted { place, ..map.unwrap_or_else(Fitted::empty) });
            from = to;
        }
        SunMaps { maps, far_ends, far_m }
    }

    /// How many instances may cast upon what the cameras see, and the distances of the nearest and the farthest place that
    /// they may cast upon.
    pub fn need(&self) -> (usize, Option<(f64, f64)>) {
        let axes = LightAxes::new(self.toward, None);
        let cast = self.cast(&axes);
        let (from, to) = self.whole_range();
        let receivers = |camera| self.receivers(camera, &axes, &cast, from, to);
        let received = axes.bounds(self.cameras.iter().flat_map(receivers));
        if received.is_empty() {
            return (0, None);
        }
        (self.casting(&axes, &received).len(), Some(self.seen_range(&axes, &cast)))
    }

    /// Distances of the nearest and farthest receiver that something can cast upon.
    fn seen_range(&self, axes: &LightAxes, cast: &Aabb) -> (f64, f64) {
        let (mut near, mut far) = (f64::INFINITY, f64::NEG_INFINITY);
        let (from, to) = self.whole_range();
        for camera in self.cameras {
            for point in self.receivers(camera, axes, cast, from, to) {
                let ahead = camera.ahead_m(point);
                (near, far) = (near.min(ahead), far.max(ahead));
            }
        }
        if near <= far { (near.max(from), far.min(to)) } else { (from, to) }
    }

    /// From the near plane to the far plane, to the limit of the settings, or to a distance past the whole scene that the
    /// cameras' turning does not change, nor their moving by a little.
    fn whole_range(&self) -> (f64, f64) {
        let (mut near, mut far) = (f64::INFINITY, 0.0_f64);
        for camera in self.cameras {
            let (own_near, own_far) = camera.range_m();
            let scene_m = (self.bounds.center() - camera.camera.eye).length() + self.bounds.radius();
            // In steps of a fifth of an octave.
            let step = (5.0 * scene_m.max(MIN_EXTENT_M).log2()).ceil() / 5.0;
            let own_far = own_far.unwrap_or(f64::INFINITY).min(step.exp2());
            let own_far = self.settings.far_m.map_or(own_far, |limit| own_far.min(limit));
            (near, far) = (near.min(own_near), far.max(own_far));
        }
        if near.is_finite() { (near, far.max(near + MIN_EXTENT_M)) } else { (0.0, 1.0) }
    }

    /// Points around what `camera` sees between two distances and something can cast upon.
    fn receivers(&self, camera: &FitCamera<'_>, axes: &LightAxes, cast: &Aabb, from: f64, to: f64) -> Vec<DVec3> {
        let mut points = Vec::new();
        if cast.is_empty() {
            return points;
        }
        let (slice, prism) = (camera.slice(from, to), axes.prism(cast));
        let seen = |b: &Aabb| {
            let (center, half) = (b.center(), b.half_extent());
            let inside = |p: &DVec4| p.truncate().dot(center) + p.w + p.truncate().abs().dot(half) >= 0.0;
            slice.planes.iter().all(inside)
        };
        for bounds in self.scene.boxes_reaching(&slice.planes, MAX_BOXES).into_iter().filter(seen) {
            intersect(&bounds, &slice, &prism, &mut points);
        }
        points
    }

    /// As many texels as possible over the receivers.
    fn tight(&self, axes: &LightAxes, cast: &Aabb, from: f64, to: f64) -> Option<Fitted> {
        let mut points = Vec::new();
        let (mut near_m, mut far_m) = (f64::INFINITY, f64::NEG_INFINITY);
        for camera in self.cameras {
            let seen = self.receivers(camera, axes, cast, from, to);
            for ahead in seen.iter().map(|p| camera.ahead_m(*p)) {
                (near_m, far_m) = (near_m.min(ahead), far_m.max(ahead));
            }
            points.extend(seen);
        }
        let received = axes.bounds(points.iter().copied());
        if received.is_empty() {
            return None;
        }
        let casters = self.casting(axes, &received);
        let deep = self.depth_range(axes, &received, &casters);
        let warp = match (self.settings.fit, self.cameras) {
            (Fit::Tight { lispsm: true }, [camera]) if camera.is_perspective() => Warp::new(&WarpRange {
                sine: axes.0[2].cross(camera.camera.forward()).length(),
                seen_m: (near_m.max(from), far_m.min(to)),
                slice_m: (from, to),
                up_m: (received.min.y, received.max.y),
                eye_right_m: axes.of(camera.camera.eye).x,
            }),
            _ => None,
        };
        // The map's rectangle: of the warped points, where there is a warp.
        let flat = points.iter().map(|point| {
            let p = axes.of(*point);
            warp.map_or(DVec2::new(p.x, p.y), |warp| warp.apply(p.x, p.y))
        });
        let (low, high) = flat.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        Some(self.fitted(axes, warp, (low, high), deep, casters))
    }

    /// A sphere around the cascade, or around the scene if that is smaller, moved in whole texels.
    fn stable(&self, axes: &LightAxes, from: f64, to: f64) -> Option<Fitted> {
        let camera = self.cameras.first()?;
        // Around the slice of a camera, whatever it is turned to: from half extents and distances alone.
        let [x, y] = camera.half_extent();
        let across2 = x * x + y * y;
        let (ahead, radius) = if camera.is_perspective() {
            let ahead = (0.5 * (from + to) * (1.0 + across2)).min(to);
            (ahead, ((to - ahead) * (to - ahead) + to * to * across2).sqrt())
        } else {
            (0.5 * (from + to), (0.25 * (to - from) * (to - from) + across2).sqrt())
        };
        let mut center = camera.camera.eye + camera.camera.forward() * ahead;
        // Other cameras beside the first look at spheres of their own.
        let others = self.cameras[1..].iter().map(|c| c.camera.eye + c.camera.forward() * ahead);
        let mut radius = radius + others.fold(0.0, |most: f64, other| most.max((other - center).length()));
        if self.bounds.radius() <= radius {
            (center, radius) = (self.bounds.center(), self.bounds.radius().max(MIN_EXTENT_M));
        }
        // A texel more on each side, since the middle moves by up to a texel.
        let texel = 2.0 * radius / (f64::from(self.settings.map_texels) - 4.0).max(1.0);
        let at = axes.of(center);
        let middle = (DVec2::new(at.x, at.y) / texel).round() * texel;
        let half = DVec2::splat(radius + texel);
        let sphere = Aabb { min: at - radius - texel, max: at + radius + texel };
        let casters = self.casting(axes, &sphere);
        let whole = axes.bounds(self.bounds.corners());
        let deep = (whole.min.z, whole.max.z.max(whole.min.z + MIN_EXTENT_M));
        (!self.bounds.is_empty()).then(|| self.fitted(axes, None, (middle - half, middle + half), deep, casters))
    }

    /// Casters over a rectangle of the map that are not all behind it.
    fn casting(&self, axes: &LightAxes, received: &Aabb) -> Vec<u32> {
        let [right_from, right_to, up_from, up_to] = axes.prism(received);
        let before = axes.0[2].extend(-received.min.z);
        let mut casters = self.reaching(&[right_from, right_to, up_from, up_to, before]);
        if !(self.scene.all_cast() && self.left_out.is_empty()) {
            casters.retain(|number| self.casts(*number));
        }
        casters
    }

    /// The boxes of these instances, or the box around them if they are many.
    fn boxes(&self, numbers: &[u32]) -> Vec<Aabb> {
        if numbers.len() > MAX_BOXES {
            return vec![self.scene.around(numbers)];
        }
        numbers.iter().map(|number| self.scene.bounds()[*number as usize]).collect()
    }

    /// From the farthest receiver to the nearest caster over the receivers, along the axis toward the sun.
    fn depth_range(&self, axes: &LightAxes, received: &Aabb, casters: &[u32]) -> (f64, f64) {
        let prism = axes.prism(received);
        let mut points = Vec::new();
        for bounds in self.boxes(casters) {
            clip_box(&bounds, &prism, &mut points);
        }
        let nearest = points.iter().fold(received.max.z, |most, p| most.max(axes.0[2].dot(*p)));
        let margin = 1e-3 * (nearest - received.min.z) + MIN_EXTENT_M;
        (received.min.z - margin, nearest + margin)
    }

    fn fitted(
        &self,
        axes: &LightAxes,
        warp: Option<Warp>,
        (low, high): (DVec2, DVec2),
        (far, near): (f64, f64),
        casters: Vec<u32>,
    ) -> Fitted {
        let [right, up, toward] = axes.0;
        let texels = f64::from(self.settings.map_texels.max(4));
        // One texel of border on each side stays empty, for taps beyond the edge.
        let inner = (texels - 2.0) / texels;
        let extent = (high - low).max(DVec2::splat(MIN_EXTENT_M));
        let (scale, middle) = (DVec2::splat(2.0 * inner) / extent, 0.5 * (low + high));
        let range = near - far;
        let linear_depth = (-toward / range).extend(near / range);
        // Rows of x, y and w before the map's rectangle is brought to -1…1.
        let (x, y, w, depth) = match warp {
            Some(warp) => {
                let [x, y, w] = warp.rows(right, up);
                (x, y, w, warp.near)
            }
            None => (right.extend(0.0), up.extend(0.0), DVec4::W, 1.0),
        };
        let row = |row: DVec4, scale: f64, middle: f64| (row - w * middle) * scale;
        let z = toward.extend(-far) * (depth / range);
        let clip = DMat4::from_cols(row(x, scale.x, middle.x), row(y, scale.y, middle.y), z, w).transpose();
        let per_texel = [2.0 / (texels * scale.x), 2.0 / (texels * scale.y)];
        let texel_m = warp.map_or(per_texel, |warp| warp.texel_m(per_texel));
        Fitted {
            clip_from_world: clip,
            linear_depth,
            axes: axes.0,
            texel_m,
            depth_m: range / depth,
            near_over_range: 0.0,
            casters: DrawLists::of_kinds(self.scene, casters),
            place: Place::default(),
        }
    }
}

/// A box around all that casts and the shadows of it, as far as the scene goes: wide ground does not count where no shadow
/// falls.
fn shadowed(whole: Aabb, cast: Aabb, toward: DVec3) -> Aabb {
    if cast.is_empty() || toward.y <= 0.0 {
        return whole;
    }
    let landed = |corner: DVec3| corner - toward * ((corner.y - whole.min.y) / toward.y);
    let reach =
        cast.corners().into_iter().map(landed).fold(cast, |all, point| all.union(Aabb { min: point, max: point }));
    Aabb { min: reach.min.max(whole.min), max: reach.max.min(whole.max) }
}

/// Whether anything is behind a flat instance, which then can shadow it; ground with everything on it casts nothing.
fn has_behind(scene: &Renderables, toward: DVec3, (number, axis): (u32, usize)) -> bool {
    let (bounds, whole, toward) = (&scene.bounds()[number as usize], scene.whole(), toward[axis]);
    // The plane's far side, with room for what stands on it to be rounded.
    let slack = 1e-4 * bounds.half_extent().max_element().min(1.0);
    if toward > 0.0 {
        whole.min[axis] < bounds.min[axis] - slack
    } else {
        toward == 0.0 || whole.max[axis] > bounds.max[axis] + slack
    }
}
