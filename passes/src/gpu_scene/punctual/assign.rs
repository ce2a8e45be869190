//! Froxels within reach of a light: a sphere is clipped slice by slice, row by row, and four columns at a time.
//!
//! A plane at distance d from the center of a ball of radius r cuts off a cap. The cap lies within a ball of squared
//! radius r² - d² around the projection of the center onto the plane. Clipping by a slice and a row, and comparing
//! with the sides of columns, therefore misses no froxel (Persson, "Practical Clustered Shading", 2013).

use super::grid::FroxelGrid;
use super::reach::Reach;
use glam::{DQuat, Vec3, Vec4};

/// [`Reach`] in view coordinates: right, up, ahead.
#[derive(Clone, Copy, Debug)]
struct Volume {
    center: Vec3,
    radius_m: f32,
    cone: Option<ConeInView>,
}

#[derive(Clone, Copy, Debug)]
struct ConeInView {
    apex: Vec3,
    axis: Vec3,
    sin: f32,
    cos: f32,
}

impl Volume {
    fn new(reach: &Reach, view_from_world: DQuat) -> Self {
        let turned = |v: glam::DVec3| {
            let v = view_from_world * v;
            Vec3::new(v.x as f32, v.y as f32, -v.z as f32)
        };
        let cone = reach.cone.map(|cone| {
            let (sin, cos) = cone.half_rad.sin_cos();
            ConeInView { apex: turned(cone.apex), axis: turned(cone.axis), sin: sin as f32, cos: cos as f32 }
        });
        Self { center: turned(reach.center), radius_m: reach.radius_m as f32, cone }
    }
}

impl ConeInView {
    /// Returns true if a ball is outside the cone. The distance of its center from the cone's side never exceeds the
    /// distance from the cone.
    fn misses(&self, center: Vec3, radius: f32) -> bool {
        let to = center - self.apex;
        let along = to.dot(self.axis);
        let aside = (to.length_squared() - along * along).max(0.0).sqrt();
        aside * self.cos - along * self.sin > radius
    }
}

/// Returns the squared radius of the part of a ball inside a plane, if any. `outside` is the distance of the center
/// outside the plane.
fn cut(radius2: f32, outside: f32) -> Option<f32> {
    let rest = radius2 - outside * outside;
    (rest >= 0.0).then_some(rest)
}

/// Calls `hit` with the index of every froxel that the light may reach, in increasing order.
pub(super) fn froxels_of(grid: &FroxelGrid, reach: &Reach, view_from_world: DQuat, mut hit: impl FnMut(u32)) {
    let volume = Volume::new(reach, view_from_world);
    let Volume { center, radius_m, .. } = volume;
    let [across, down, _] = grid.counts;
    for (slice, [begin, end]) in (0..).zip(&grid.slices) {
        let ahead = center.z.clamp(*begin, *end);
        let Some(in_slice) = cut(radius_m * radius_m, ahead - center.z) else { continue };
        for (row, between) in (0..).zip(&grid.rows) {
            let [low, high] = between.inside(center.y, ahead);
            // The center is outside of at most one of the two planes, unless it is behind the eye; the farther plane
            // then cuts more.
            let (outside, plane) = if low < high { (low, between.planes[0]) } else { (high, between.planes[1]) };
            let outside = outside.min(0.0);
            let Some(in_row) = cut(in_slice, outside) else { continue };
            let foot = ahead - outside * plane.y;
            let first = (slice * down + row) * across;
            let reach = Vec4::splat(-in_row.sqrt());
            for (group, columns) in (0..).step_by(4).zip(&grid.columns) {
                let mut touched = columns.inside(center.x, foot).cmpge(reach).bitmask();
                while touched != 0 {
                    let column = group + touched.trailing_zeros();
                    touched &= touched - 1;
                    let missed = |cone: ConeInView| {
                        let [from, to] = [begin.max(center.z - radius_m), end.min(center.z + radius_m)];
                        let (center, radius) = ball_around(grid, [column, row], [from, to]);
                        cone.misses(center, radius)
                    };
                    if !volume.cone.is_some_and(missed) {
                        hit(first + column);
                    }
                }
            }
        }
    }
}

/// Returns a ball around the part of a tile between two distances.
fn ball_around(grid: &FroxelGrid, [column, row]: [u32; 2], ahead: [f32; 2]) -> (Vec3, f32) {
    let sides = [grid.across[column as usize], grid.rows[row as usize].sides];
    let corner = |i: usize| {
        let z = ahead[i >> 2];
        let scale = if grid.is_perspective { z } else { 1.0 };
        Vec3::new(sides[0][i & 1] * scale, sides[1][(i >> 1) & 1] * scale, z)
    };
    let corners: [Vec3; 8] = std::array::from_fn(corner);
    let center = corners.iter().sum::<Vec3>() / 8.0;
    (center, corners.iter().map(|corner| center.distance_squared(*corner)).fold(0.0, f32::max).sqrt())
}
